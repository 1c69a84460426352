// SPDX-License-Identifier: MIT
// One row per rank over the whole run, with marks and a frame around the detail's period.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/layout.h"
#include "analysis/views/number.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr double kMarkSize = 12;
constexpr std::size_t kMostMarks = 60;  // lines beyond that would hide the states

/// Dotted lines through all rows; names above them as long as they do not meet.
Layer Marks(const Timeline& timeline, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"marks", {}};
  double free_from = axis.left;
  std::size_t drawn = 0;
  for (const TimelineMark& mark : timeline.marks) {
    if (++drawn > kMostMarks) break;
    const double x = std::floor(axis.XOf(mark.time_s)) + 0.5, top = grid.rows.front().y;
    layer.shapes.emplace_back(
        LineShape{{{x, top - 3}, {x, top + grid.height + 4}}, kInk, 1, true, 0.8});
    const std::string label = FormatSeconds(mark.time_s) + ": " + CleanUtf8(mark.label);
    const double width = TextWidth(label, kMarkSize);
    const bool to_left = x + width > axis.right;
    const double begin = to_left ? x - width : x;
    if (begin < free_from) continue;
    free_from = begin + width + 12;
    const TextStyle style{
        .size = kMarkSize, .colour = kInk, .anchor = to_left ? Anchor::kEnd : Anchor::kStart};
    layer.shapes.emplace_back(TextShape{x, top - 12, label, style});
  }
  return layer;
}

/// A frame around the period that the detail shows.
Layer DetailFrame(const ViewInput& input, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"frame", {}};
  if (!HasRows(input.detail) || input.detail->message_count == 0) return layer;
  const double left = std::floor(axis.XOf(input.detail->begin_s)) + 0.5;
  const double right = std::max(left + 3, std::floor(axis.XOf(input.detail->end_s)) + 0.5);
  if (right - left > axis.width() * 0.95) return layer;
  const double top = grid.rows.front().y - 3.5, bottom = top + grid.height + 7;
  layer.shapes.emplace_back(
      LineShape{{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}},
                kInk,
                1.5,
                false,
                1});
  return layer;
}

}  // namespace

Scene TimelineView(const ViewInput& input) {
  Scene scene{.name = "timeline", .width = kMainWidth};
  if (!HasRows(input.timeline)) return scene;
  const Timeline& timeline = *input.timeline;
  const RowGrid grid = MainGrid(input);
  const TimeAxis axis = MainAxis(input);
  const double bottom = grid.rows.front().y + grid.height + 6;
  scene.height = std::ceil(bottom + kAxisHeight);
  scene.title = fmt::format("State of each {} over {}", NounFor(timeline),
                            FormatSeconds(timeline.end_s - timeline.begin_s));
  scene.description =
      "One row per rank, time from left to right; in each column the share of user computation, "
      "system, message transmission and idle time.";
  scene.note = grid.ranks_per_row == 1
                   ? "column height = share of the column's time"
                   : fmt::format("each row is the mean of {} ranks", grid.ranks_per_row);
  scene.layers.push_back(StateLayer(
      MakeStateRuns(timeline, grid, axis.width(), QuadBudgetFor(grid.rows.size())), grid, axis));
  scene.layers.push_back(RowLabels(grid, axis.left - 10));
  Layer time{"axis", {}};
  AddTimeAxis(time, axis, bottom);
  scene.layers.push_back(std::move(time));
  scene.layers.push_back(Marks(timeline, grid, axis));
  scene.layers.push_back(DetailFrame(input, grid, axis));
  return scene;
}

}  // namespace stipple
