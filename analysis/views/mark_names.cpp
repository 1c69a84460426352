// SPDX-License-Identifier: MIT
#include "analysis/views/mark_names.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostLevels = 5;
constexpr double kLevelHeight = 16;
constexpr double kNameGap = 12;
constexpr double kWidestName = 320;

/// The first of each group: ranks that run the same code set the same mark, each for the n-th time.
std::vector<const TimelineMark*> FirstOfEach(const Timeline& timeline) {
  std::vector<const TimelineMark*> in_time, first;
  for (const TimelineMark& mark : timeline.marks) in_time.push_back(&mark);
  std::ranges::stable_sort(in_time, {}, &TimelineMark::time_s);
  std::map<std::pair<std::string, int>, int> set_by_rank;
  std::set<std::pair<std::string, int>> named;
  for (const TimelineMark* mark : in_time)
    if (named.emplace(mark->label, ++set_by_rank[{mark->label, mark->rank}]).second)
      first.push_back(mark);
  return first;
}

}  // namespace

std::vector<MarkName> NameMarks(const Timeline& timeline, const TimeAxis& axis) {
  const std::vector<const TimelineMark*> marks = FirstOfEach(timeline);
  std::vector<MarkName> names;
  std::vector<double> free_until(kMostLevels, axis.right + kNameGap);
  // From the right: the line up to a higher name then passes left of the names below it.
  for (auto mark = marks.rbegin(); mark != marks.rend(); ++mark) {
    MarkName name{std::floor(axis.XOf((*mark)->time_s)) + 0.5,
                  ShortenEnd(FormatSeconds((*mark)->time_s) + ": " + (*mark)->label, kWidestName,
                             kMarkNameSize)};
    const double width = TextWidth(name.text, kMarkNameSize) + kMarkNameAside;
    name.to_left = name.x + width > axis.right;
    const double begin = name.to_left ? name.x - width : name.x;
    const auto level = std::ranges::find_if(
        free_until, [&](double free) { return begin + width + kNameGap <= free; });
    if (level == free_until.end()) continue;
    *level = begin;
    name.level = static_cast<std::size_t>(level - free_until.begin());
    names.push_back(std::move(name));
  }
  return names;
}

double MarkStrip(const std::vector<MarkName>& names) {
  if (names.empty()) return 0;
  const std::size_t highest = std::ranges::max_element(names, {}, &MarkName::level)->level;
  return 4 + kLevelHeight * static_cast<double>(highest + 1);
}

double MarkNameY(const MarkName& name, double top) {
  return top - 12 - kLevelHeight * static_cast<double>(name.level);
}

}  // namespace stipple
