// SPDX-License-Identifier: MIT
// One row per rank over the whole run, with marks and a frame around the detail's period.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/mark_names.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr std::size_t kMostMarks = 60;  // lines beyond that would hide the states

/// Dotted lines through all rows, one per pixel; those with a name rise to it.
Layer Marks(const Timeline& timeline, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"marks", {}};
  const double top = grid.rows.front().y, bottom = top + grid.height + 4;
  const std::vector<MarkName> names = NameMarks(timeline, axis);
  std::map<double, double> begin_by_x;
  for (const MarkName& name : names) {
    double& begin = begin_by_x.try_emplace(name.x, top).first->second;
    begin = std::min(begin, MarkNameY(name, top) - 5);
  }
  for (const TimelineMark& mark : timeline.marks) {
    if (begin_by_x.size() >= kMostMarks) break;
    begin_by_x.try_emplace(std::floor(axis.XOf(mark.time_s)) + 0.5, top - 3);
  }
  for (const auto& [x, begin] : begin_by_x)
    layer.shapes.emplace_back(LineShape{{{x, begin}, {x, bottom}}, kInk, 1, true, 0.8});
  for (const MarkName& name : names) {
    const TextStyle style{.size = kMarkNameSize,
                          .colour = kInk,
                          .anchor = name.to_left ? Anchor::kEnd : Anchor::kStart};
    const double aside = name.to_left ? -kMarkNameAside : kMarkNameAside;
    layer.shapes.emplace_back(TextShape{name.x + aside, MarkNameY(name, top), name.text, style});
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

Scene TimelineOrDetailView(const ViewInput& input) {
  Scene scene = HasRows(input.detail) ? DetailScene(input, kMainWidth) : TimelineView(input);
  scene.name = "timeline";
  for (std::size_t s = 0; s < kStateCount; ++s)
    scene.key.push_back({kStateNames[s], kStateColours[s]});
  return scene;
}

}  // namespace stipple
