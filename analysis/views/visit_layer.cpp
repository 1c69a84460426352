// SPDX-License-Identifier: MIT
#include "analysis/views/visit_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostRows = 16;      // ranks; more would make the picture too high
constexpr std::uint32_t kMostDepths = 10;  // for one rank; all ranks share kMostLines
constexpr std::uint32_t kMostLines = 64;
constexpr double kLeastWidth = 0.3;  // pixels; narrower bars are not drawn
constexpr double kTextSize = 11;

/// How many depths, from the outermost on, are one function from end to end.
std::uint32_t UnchangedDepths(const std::vector<VisitBar>& row, const Timeline& period) {
  std::vector<std::uint32_t> counts;
  std::vector<bool> whole;
  for (const VisitBar& visit : row) {
    if (visit.depth >= 1000) continue;
    if (counts.size() <= visit.depth)
      counts.resize(visit.depth + 1, 0), whole.resize(counts.size());
    ++counts[visit.depth];
    whole[visit.depth] = visit.begin_s <= period.begin_s && visit.end_s >= period.end_s;
  }
  std::uint32_t depth = 0;
  while (depth < counts.size() && counts[depth] == 1 && whole[depth]) ++depth;
  return depth;
}

}  // namespace

Colour ColourOfName(std::string_view name) {
  if (name.starts_with("MPI_") || name.starts_with("PMPI_")) return kLoadFill;
  constexpr Colour kQuiet[] = {{0xc9, 0xdc, 0xef}, {0xb7, 0xd0, 0xea}, {0xd6, 0xe3, 0xee},
                               {0xcb, 0xe3, 0xdf}, {0xb9, 0xd9, 0xd4}, {0xd9, 0xe7, 0xd3},
                               {0xd9, 0xd6, 0xea}, {0xe3, 0xdc, 0xe6}};
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
  return kQuiet[(hash >> 8) % std::size(kQuiet)];
}

VisitDepths VisitDepthsOf(const ViewInput& input) {
  if (input.visits == nullptr || !HasRows(input.detail)) return {};
  const std::size_t rows = input.visits->rows.size();
  if (rows != input.detail->rows.size()) return {};
  if (rows > kMostRows) return {.too_many_rows = true};
  std::uint32_t unchanged = std::numeric_limits<std::uint32_t>::max(), deepest = 0;
  bool any = false;
  for (const std::vector<VisitBar>& row : input.visits->rows) {
    if (row.empty()) continue;
    any = true;
    unchanged = std::min(unchanged, UnchangedDepths(row, *input.detail));
    for (const VisitBar& visit : row) deepest = std::max(deepest, visit.depth);
  }
  if (!any) return {};
  const std::uint32_t first = unchanged == 0 ? 0 : unchanged - 1;
  const auto share = static_cast<std::uint32_t>(kMostLines / rows);
  const std::uint32_t most = std::clamp<std::uint32_t>(share, 2, kMostDepths);
  const std::uint32_t all = deepest + 1 - std::min(first, deepest);
  VisitDepths depths{first, std::min(all, most), {}, all - std::min(all, most), false};
  for (const std::vector<VisitBar>& row : input.visits->rows) {
    std::uint32_t lines = 0;
    for (const VisitBar& visit : row)
      if (visit.depth >= first) lines = std::max(lines, visit.depth - first + 1);
    depths.lines.push_back(std::min(lines, depths.count));
  }
  return depths;
}

std::string LeftOutText(const VisitDepths& depths) {
  if (depths.too_many_rows)
    return fmt::format("functions: of at most {} ranks at a time", kMostRows);
  std::string text;
  if (depths.count > 0 && depths.first > 0) text = fmt::format("{} outer", depths.first);
  if (depths.deeper > 0)
    text += fmt::format("{}{} deeper", text.empty() ? "" : " and ", depths.deeper);
  if (text.empty()) return text;
  const bool one = depths.first + depths.deeper == 1;
  return text + (one ? " level" : " levels") + " of functions not shown";
}

void AddVisits(const VisitBars& visits, std::size_t row, const VisitDepths& depths,
               const TimeAxis& axis, double y, Layer& bars, Layer& names) {
  for (const VisitBar& visit : visits.rows[row]) {
    if (visit.depth < depths.first || visit.depth >= depths.first + depths.count) continue;
    const double left = axis.XOf(visit.begin_s), right = axis.XOf(visit.end_s);
    if (right - left < kLeastWidth) continue;
    const std::string& name = visits.names[visit.name];
    const double top = y + (visit.depth - depths.first) * kVisitLine;
    const double gap = right - left > 3 ? 0.7 : 0;
    bars.shapes.emplace_back(
        RectShape{left, top, right - left - gap, kVisitLine - 1, ColourOfName(name),
                  fmt::format("{}: {}", name, FormatSeconds(visit.end_s - visit.begin_s))});
    const std::string text = ShortenName(name, right - left - 8, kTextSize);
    if (!text.empty())
      names.shapes.emplace_back(TextShape{
          left + 4, top + (kVisitLine - 1) / 2, text, {.size = kTextSize, .colour = kOnPale}});
  }
}

}  // namespace stipple
