// SPDX-License-Identifier: MIT
#include "analysis/views/mark_groups.h"

#include <algorithm>

#include "analysis/stats/number.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr double kMarkSpacing = 12;  // marks nearer than this become one numeral

}  // namespace

std::vector<MarkGroup> GroupMarks(std::span<const EventMark> marks) {
  std::vector<MarkGroup> groups;
  for (std::size_t i = 0; i < marks.size();) {
    MarkGroup group{i, 1, marks[i].x, std::string(1, marks[i].letter)};
    double reach = group.x + kMarkSpacing;
    while (i + group.count < marks.size() && marks[i + group.count].x < reach) {
      ++group.count;
      group.text = FormatShort(static_cast<double>(group.count));
      group.x = (marks[i].x + marks[i + group.count - 1].x) / 2;
      reach = std::max(reach, group.x + TextWidth(group.text, kMarkSize, true) / 2 + kMarkSpacing);
    }
    i += group.count;
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace stipple
