// SPDX-License-Identifier: MIT
#include "analysis/stats/selection.h"

#include <fnmatch.h>

#include <charconv>
#include <set>
#include <string>

#include "analysis/stats/near_names.h"
#include "analysis/trace/demangle.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

/// Items between commas that stand in no brackets: names of functions hold commas, too.
std::vector<std::string> ItemsOf(std::string_view text) {
  std::vector<std::string> items(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '<' || c == '[') ++depth;
    if (c == ')' || c == '>' || c == ']') --depth;
    if (c == ',' && depth <= 0)
      items.emplace_back();
    else if (c != ' ' || !items.back().empty())
      items.back() += c;
  }
  std::erase(items, std::string());
  return items;
}

/// First and last number of "3" or "3-7"; none if it is neither.
std::optional<TagRange> RangeOf(std::string_view item) {
  const auto number = [](std::string_view text) -> std::optional<std::int32_t> {
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) return std::nullopt;
    return value;
  };
  const std::size_t dash = item.find('-');
  const auto first = number(item.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : number(item.substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return TagRange{*first, *last};
}

/// "64k" in bytes.
std::uint64_t BytesOf(std::string_view text, std::string_view whole) {
  const auto wrong = [whole] {
    return InputError("--sizes", "'" + std::string(whole) + "' is no range like 1k-64k, -100 or 8");
  };
  std::uint64_t bytes = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, bytes);
  if (error != std::errc()) throw wrong();
  const std::string_view unit(end, static_cast<std::size_t>(last - end));
  const std::size_t power = unit.empty() ? 0 : std::string_view("kMG").find(unit) + 1;
  if (unit.size() > 1 || (!unit.empty() && power == 0) || bytes >> (63 - 10 * power) != 0)
    throw wrong();
  return bytes << (10 * power);
}

bool Matches(const std::string& pattern, const std::string& name) {
  const auto fits = [&pattern](const std::string& text) {
    return text == pattern || fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
  };
  const std::string plain = ShortName(name);
  return fits(name) || fits(plain) || fits(std::string(WithoutScope(plain)));
}

/// What is said of a name that nothing has.
std::string UnknownText(const Trace& trace, const std::string& pattern) {
  std::vector<std::string> names;
  for (std::size_t r = 1; r < trace.regions().size(); ++r)
    names.push_back(ShortName(trace.regions()[r].name));
  std::string near;
  for (const std::string& name : NearNames(names, pattern))
    near += (near.empty() ? "; near it: " : ", ") + name;
  return "no region is called '" + pattern + "'" + near;
}

}  // namespace

bool RegionFilter::HasName(const std::string& name) const {
  return std::ranges::any_of(patterns, [&name](const std::string& p) { return Matches(p, name); });
}

std::vector<int> ParseRanks(const Trace& trace, std::string_view text) {
  std::set<int> ranks;
  for (const std::string& item : ItemsOf(text)) {
    if (item == "host") {
      if (!trace.HasHost()) throw InputError("--ranks", "this archive has no host");
      for (const Process& p : trace.processes())
        if (p.is_host) ranks.insert(p.rank);
      continue;
    }
    const std::optional<TagRange> range = RangeOf(item);
    if (!range)
      throw InputError("--ranks", "'" + std::string(text) + "' is not a list like 0-3,7,host");
    if (range->last >= trace.RankCount())
      throw InputError("--ranks", "'" + item + "': the archive has " +
                                      (trace.RankCount() == 0
                                           ? std::string("none")
                                           : "ranks 0-" + std::to_string(trace.RankCount() - 1)));
    for (int rank = range->first; rank <= range->last; ++rank) ranks.insert(rank);
  }
  if (ranks.empty()) throw InputError("--ranks", "names no rank");
  return {ranks.begin(), ranks.end()};
}

RegionFilter ParseRegions(const Trace& trace, std::string_view text) {
  RegionFilter filter{ItemsOf(text), {}};
  if (filter.patterns.empty()) throw InputError("--regions", "names no region");
  std::set<std::uint32_t> found;
  for (const std::string& pattern : filter.patterns) {
    const std::size_t before = found.size();
    bool any = false;
    for (std::uint32_t r = 1; r < trace.regions().size(); ++r) {
      if (!Matches(pattern, trace.regions()[r].name)) continue;
      any = true;
      found.insert(r);
    }
    if (!any && before == found.size() && trace.regions().size() > 1)
      throw InputError("--regions", UnknownText(trace, pattern));
  }
  filter.regions.assign(found.begin(), found.end());
  return filter;
}

std::pair<std::uint64_t, std::uint64_t> ParseSizes(std::string_view text) {
  const std::size_t dash = text.find('-');
  const std::string_view low = text.substr(0, dash);
  const std::string_view high = dash == std::string_view::npos ? low : text.substr(dash + 1);
  if (low.empty() && high.empty()) BytesOf("", text);
  const std::uint64_t least = low.empty() ? 0 : BytesOf(low, text);
  const std::uint64_t most =
      high.empty() ? std::numeric_limits<std::uint64_t>::max() : BytesOf(high, text);
  if (most < least)
    throw InputError("--sizes", "'" + std::string(text) + "' ends before it begins");
  return {least, most};
}

std::vector<TagRange> ParseTags(std::string_view text) {
  std::vector<TagRange> tags;
  for (const std::string& item : ItemsOf(text)) {
    const std::optional<TagRange> range = RangeOf(item);
    if (!range) throw InputError("--tags", "'" + std::string(text) + "' is not a list like 3,7-9");
    tags.push_back(*range);
  }
  if (tags.empty()) throw InputError("--tags", "names no tag");
  return tags;
}

}  // namespace stipple
