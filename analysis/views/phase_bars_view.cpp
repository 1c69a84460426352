// SPDX-License-Identifier: MIT
// The bars of the whole run again, for each of its phases: side by side on one scale, rank by rank
// in the same rows, so that one sees which rank does what in which phase.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr std::size_t kAcross = 4;  // phases side by side
constexpr double kGap = 36;         // between them
constexpr double kPercent = 40;     // for the share beside each bar
constexpr double kHeading = 24, kFoot = 40;

struct PhaseSpan {
  double begin_s = 0, end_s = 0, max_over_mean = 1;
};

/// Shares of the phase, mean of the ranks in a drawn row; below 1 where they had not begun.
StateShares SharesIn(const Timeline& timeline, const GridRow& row, const PhaseSpan& phase) {
  const double span = timeline.end_s - timeline.begin_s;
  std::array<double, kStateCount> sums{};
  for (std::size_t r = row.first; r < row.first + row.count; ++r) {
    const std::vector<StateShares>& columns = timeline.rows[r].columns;
    const double scale = static_cast<double>(columns.size()) / span;
    const double from = (phase.begin_s - timeline.begin_s) * scale;
    const double to = (phase.end_s - timeline.begin_s) * scale;
    for (auto c = static_cast<std::size_t>(std::max(0.0, from));
         c < columns.size() && static_cast<double>(c) < to; ++c) {
      const auto column = static_cast<double>(c);
      const double part = (std::min(to, column + 1) - std::max(from, column)) /
                          ((to - from) * static_cast<double>(row.count));
      for (std::size_t s = 0; s < kStateCount; ++s)
        sums[s] += part * static_cast<double>(columns[c][s]);
    }
  }
  StateShares shares{};
  for (std::size_t s = 0; s < kStateCount; ++s) shares[s] = static_cast<float>(sums[s]);
  return shares;
}

struct Drawing {
  const Timeline& timeline;
  const RowGrid& grid;
  double width = 0;  // of a whole bar
  Layer bars{"bars", {}}, labels{"labels", {}}, mean{"mean", {}};

  void Add(const PhaseSpan& phase, double left, double top) {
    labels.shapes.emplace_back(TextShape{left,
                                         top + 8,
                                         FormatSpan(phase.begin_s, phase.end_s),
                                         {.size = 13, .colour = kInk, .bold = true}});
    std::vector<StateShares> shares;
    for (const GridRow& row : grid.rows) shares.push_back(SharesIn(timeline, row, phase));
    AddBars(shares, left, top + kHeading);
    AddMean(phase, shares, left, top + kHeading);
  }

  // State by state, so that bars of one colour become one element.
  void AddBars(const std::vector<StateShares>& shares, double left, double top) {
    std::vector<double> ends(shares.size(), 0);
    for (std::size_t s = 0; s < kStateCount; ++s)
      for (std::size_t i = 0; i < shares.size(); ++i) {
        const double begin = ends[i];
        ends[i] = std::min(width, begin + static_cast<double>(shares[i][s]) * width);
        if (ends[i] - begin >= 0.05)
          bars.shapes.emplace_back(RectShape{left + begin,
                                             top + grid.rows[i].y,
                                             ends[i] - begin,
                                             grid.rows[i].height,
                                             kStateColours[s],
                                             {}});
      }
    for (std::size_t i = 0; i < shares.size(); ++i)
      if (!grid.rows[i].label.empty())
        labels.shapes.emplace_back(
            TextShape{left + width + kPercent,
                      top + grid.middle(i),
                      FormatPercent(shares[i][0]),
                      {.size = grid.label_size, .colour = kInk, .anchor = Anchor::kEnd}});
  }

  void AddMean(const PhaseSpan& phase, const std::vector<StateShares>& shares, double left,
               double top) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const GridRow& row = grid.rows[i];
      if (timeline.rows[row.first].is_host && timeline.rows.size() > 1) continue;
      sum += static_cast<double>(shares[i][0]) * static_cast<double>(row.count);
      count += static_cast<double>(row.count);
    }
    const double share = count > 0 ? sum / count : 0;
    const double x = left + std::floor(share * width) + 0.5;
    mean.shapes.emplace_back(
        LineShape{{{x, top - 3}, {x, top + grid.height + 5}}, kInk, 1, true, 1});
    const std::string text = fmt::format("mean {} \u00b7 busiest {:.2f} \u00d7 mean",
                                         FormatPercent(share), phase.max_over_mean);
    labels.shapes.emplace_back(
        TextShape{left, top + grid.height + 16, text, {.size = 12, .colour = kSecondary}});
  }

  void AddNames(double right, double top) {
    for (std::size_t i = 0; i < grid.rows.size(); ++i)
      if (!grid.rows[i].label.empty())
        labels.shapes.emplace_back(TextShape{right,
                                             top + kHeading + grid.middle(i),
                                             grid.rows[i].label,
                                             {.size = grid.label_size,
                                              .colour = kInk,
                                              .bold = grid.rows[i].emphasised,
                                              .anchor = Anchor::kEnd}});
  }
};

std::vector<PhaseSpan> PhasesIn(const Table& table) {
  std::vector<PhaseSpan> phases;
  for (const std::vector<Cell>& row : table.rows) {
    const PhaseSpan phase{CellNumber(CellOf(table, row, "begin_s")),
                          CellNumber(CellOf(table, row, "end_s")),
                          CellNumber(CellOf(table, row, "max_over_mean"))};
    if (phase.end_s > phase.begin_s) phases.push_back(phase);
  }
  return phases;
}

}  // namespace

Scene PhaseBarsView(const ViewInput& input) {
  Scene scene{.name = "phase-bars", .width = kMainWidth};
  if (!HasRows(input.timeline) || input.tables.empty()) return scene;
  const std::vector<PhaseSpan> phases = PhasesIn(*input.tables.front());
  if (phases.empty()) return scene;
  const RowGrid grid = MakeRowGrid(input.timeline->rows, CulpritOf(input),
                                   {.max_pitch = 26, .max_height = 320, .max_rows = 64});
  const double left = AxisLeft(grid);
  const double step = (kMainWidth - left + kGap) / static_cast<double>(kAcross);
  Drawing drawing{*input.timeline, grid, step - kGap - kPercent};
  double top = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (i > 0 && i % kAcross == 0) top += kHeading + grid.height + kFoot;
    if (i % kAcross == 0) drawing.AddNames(left - 10, top);
    drawing.Add(phases[i], left + step * static_cast<double>(i % kAcross), top);
  }
  const std::string_view noun = NounFor(*input.timeline);
  scene.height = std::ceil(top + kHeading + grid.height + 26);
  scene.title = fmt::format("States of each phase by {}", noun);
  scene.description = fmt::format(
      "For each phase one bar per {}: shares of user computation, system, message and idle time.",
      noun);
  scene.note = "share computing in each phase";
  if (grid.ranks_per_row > 1)
    scene.note += fmt::format(" \u00b7 a row: mean of {} ranks", grid.ranks_per_row);
  scene.layers = {std::move(drawing.bars), std::move(drawing.labels), std::move(drawing.mean)};
  return scene;
}

}  // namespace stipple
