// SPDX-License-Identifier: MIT
// A short period: states, each message as a line from its send to its receive, `s` and `r` where
// they happened, and numerals where marks would overlap.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/mark_groups.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"
#include "analysis/views/visit_layer.h"

namespace stipple {
namespace {

constexpr std::size_t kMostLines = 400;  // beyond that lines hide the states
constexpr double kLeastPitchForMarks = 24;
constexpr double kTop = 18;
constexpr double kStripHeight = 40;  // of the message load, where there are too many for lines

RowGridLimits DetailLimits(std::size_t rows) {
  RowGridLimits limits{
      .top = kTop, .max_pitch = 36, .max_height = 430, .fill = 0.56, .max_rows = 160};
  if (limits.max_height / static_cast<double>(std::max<std::size_t>(rows, 1)) < kLeastPitchForMarks)
    limits.fill = 0.74;  // no room is kept for marks
  return limits;
}

/// Marks per drawn row, in the order of time.
std::vector<std::vector<EventMark>> MarksByRow(const Timeline& detail, const RowGrid& grid,
                                               const TimeAxis& axis) {
  std::vector<std::vector<EventMark>> marks(grid.rows.size());
  const auto add = [&](std::size_t row, double time_s, char letter) {
    if (time_s < detail.begin_s || time_s > detail.end_s) return;
    marks[grid.RowOf(row)].push_back({axis.XOf(time_s), letter});
  };
  for (const TimelineMessage& message : detail.messages) {
    add(message.sender_row, message.send_s, 's');
    add(message.receiver_row, message.receive_s, 'r');
  }
  for (std::vector<EventMark>& of_row : marks) std::ranges::stable_sort(of_row, {}, &EventMark::x);
  return marks;
}

/// Lines arrive from the left and leave to the right: letters stand beside them.
double Aside(char letter) { return letter == 'r' ? 3 : -2; }

void AddMarks(Layer& layer, const std::vector<EventMark>& marks, double y) {
  for (const MarkGroup& group : GroupMarks(marks)) {
    const double x = group.x + (group.count == 1 ? Aside(marks[group.first].letter) : 0);
    layer.shapes.emplace_back(
        TextShape{x,
                  y,
                  group.text,
                  {.size = kMarkSize, .colour = kInk, .bold = true, .anchor = Anchor::kMiddle}});
  }
}

/// From the facing edges of the rows, so that a line crosses no state of its own ends.
Layer MessageLines(const ViewInput& input, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"messages", {}};
  const Timeline& detail = *input.detail;
  if (detail.messages.size() > kMostLines) return layer;
  for (const bool of_culprit : {false, true})
    for (const TimelineMessage& message : detail.messages) {
      const bool culprit = detail.rows[message.sender_row].rank == CulpritOf(input);
      const GridRow& from = grid.rows[grid.RowOf(message.sender_row)];
      const GridRow& to = grid.rows[grid.RowOf(message.receiver_row)];
      if (culprit != of_culprit || from.y == to.y) continue;
      const bool down = to.y > from.y;
      const Point begin{axis.XOf(message.send_s), down ? from.y + from.height : from.y};
      const Point end{axis.XOf(message.receive_s), down ? to.y : to.y + to.height};
      layer.shapes.emplace_back(LineShape{{begin, end},
                                          culprit ? kInk : kSecondary,
                                          culprit ? 1.0 : 0.9,
                                          false,
                                          culprit ? 0.9 : 0.55});
    }
  return layer;
}

std::string NoteFor(const Timeline& detail, bool marks) {
  const bool lines = detail.messages.size() <= kMostLines;
  std::string note =
      marks ? "s send \u00b7 r receive \u00b7 numeral: that many too close to draw apart" : "";
  if (detail.messages.size() < detail.message_count || !lines) {
    const std::string count = FormatCount(static_cast<std::int64_t>(detail.message_count));
    const std::string shown = FormatCount(static_cast<std::int64_t>(detail.messages.size()));
    if (!note.empty()) note += " \u00b7 ";
    note += lines ? fmt::format("{} of {} messages", shown, count)
                  : fmt::format("{} messages, too many for lines", count);
  }
  return note;
}

/// With visits each row has room for them below its states, and for marks above the next one.
RowGrid GridOf(const ViewInput& input, const VisitDepths& depths) {
  const Timeline& detail = *input.detail;
  RowGridLimits limits = DetailLimits(detail.rows.size());
  if (depths.count == 0) return MakeRowGrid(detail.rows, CulpritOf(input), limits);
  constexpr double kStates = 20, kBetween = 26;
  limits.max_pitch = kStates + kBetween;
  limits.max_height = 1e5;
  limits.fill = kStates / limits.max_pitch;
  RowGrid grid = MakeRowGrid(detail.rows, CulpritOf(input), limits);
  double y = limits.top;
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    grid.rows[i].y = y;
    y += kStates + depths.HeightOf(i) + kBetween;
  }
  grid.height = grid.rows.back().y + kStates - limits.top;
  return grid;
}

void AddVisitLayers(Scene& scene, const ViewInput& input, const RowGrid& grid, const TimeAxis& axis,
                    const VisitDepths& depths) {
  Layer bars{"bars", {}}, names{"labels", {}};
  for (std::size_t i = 0; i < grid.rows.size(); ++i)
    AddVisits(*input.visits, i, depths, axis, grid.rows[i].y + grid.rows[i].height + 3, bars,
              names);
  scene.layers.push_back(std::move(bars));
  scene.layers.push_back(std::move(names));
}

/// Too many messages for lines: how much was sent stands in a strip below the rows.
bool HasLoadStrip(const Timeline& detail) {
  return detail.message_count > 0 && !detail.sent_bytes.empty() &&
         (detail.messages.size() > kMostLines || detail.messages.size() < detail.message_count);
}

Layer LoadStrip(const Timeline& detail, const TimeAxis& axis, double top) {
  Layer layer{"band", {}};
  double largest = 0;
  for (const double bytes : detail.sent_bytes) largest = std::max(largest, bytes);
  const auto count = static_cast<double>(detail.sent_bytes.size());
  const double bottom = top + kStripHeight, step = axis.width() / count;
  PolygonShape area{{{axis.left, bottom}}, kLoadFill};
  double x = axis.left;
  for (const double bytes : detail.sent_bytes) {
    const double y = bottom - (largest > 0 ? bytes / largest : 0) * (kStripHeight - 6);
    if (area.points.back().y != y)
      area.points.insert(area.points.end(), {{x, area.points.back().y}, {x, y}});
    x += step;
  }
  area.points.insert(area.points.end(), {{axis.right, area.points.back().y}, {axis.right, bottom}});
  layer.shapes.emplace_back(std::move(area));
  const double seconds = (detail.end_s - detail.begin_s) / count;
  const double y = bottom - kStripHeight / 2;
  const TextStyle style{.size = 11, .colour = kSecondary, .anchor = Anchor::kEnd};
  layer.shapes.emplace_back(TextShape{axis.left - 10, y - 7, "load, most", style});
  layer.shapes.emplace_back(
      TextShape{axis.left - 10, y + 7, FormatBytes(largest / seconds) + "/s", style});
  return layer;
}

}  // namespace

Scene DetailScene(const ViewInput& input, double width) {
  Scene scene{.name = "detail", .width = width};
  if (!HasRows(input.detail) || !(input.detail->end_s > input.detail->begin_s)) return scene;
  const Timeline& detail = *input.detail;
  const VisitDepths depths = VisitDepthsOf(input);
  const RowGrid grid = GridOf(input, depths);
  const TimeAxis axis{detail.begin_s, detail.end_s, AxisLeft(grid), width};
  const bool marks = grid.pitch >= kLeastPitchForMarks && !detail.messages.empty();
  double bottom =
      grid.rows.back().y + grid.rows.back().height + 6 + depths.HeightOf(grid.rows.size() - 1);
  scene.title = "Detail " + FormatSpan(detail.begin_s, detail.end_s);
  scene.description =
      fmt::format("States of each {} with {} messages as lines from sender to receiver.",
                  NounFor(detail), FormatCount(static_cast<std::int64_t>(detail.message_count)));
  scene.note = NoteFor(detail, marks);
  if (const std::string left_out = LeftOutText(depths); !left_out.empty())
    scene.note += (scene.note.empty() ? "" : " \u00b7 ") + left_out;
  scene.layers.push_back(
      StateLayer(MakeStateRuns(detail, grid, axis.width(), kQuadBudget), grid, axis));
  if (depths.count > 0) AddVisitLayers(scene, input, grid, axis, depths);
  scene.layers.push_back(RowLabels(grid, axis.left - 10));
  if (HasLoadStrip(detail)) {
    scene.layers.push_back(LoadStrip(detail, axis, bottom));
    bottom += kStripHeight + 6;
  }
  Layer time{"axis", {}};
  AddTimeAxis(time, axis, bottom);
  scene.height = std::ceil(bottom + kAxisHeight);
  scene.layers.push_back(std::move(time));
  scene.layers.push_back(MessageLines(input, grid, axis));
  if (!marks) return scene;
  Layer letters{"letters", {}};
  const std::vector<std::vector<EventMark>> by_row = MarksByRow(detail, grid, axis);
  for (std::size_t i = 0; i < by_row.size(); ++i) AddMarks(letters, by_row[i], grid.rows[i].y - 8);
  scene.layers.push_back(std::move(letters));
  return scene;
}

Scene DetailView(const ViewInput& input) { return DetailScene(input, kDetailWidth); }

}  // namespace stipple
