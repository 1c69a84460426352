// SPDX-License-Identifier: MIT
// Two curves over the whole run, aligned with the timeline: how many ranks compute, and how much is
// being sent.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr double kCurveHeight = 92;
constexpr double kCurveTop = 8;
constexpr std::size_t kCurveColumns = 512;
constexpr double kWindows = 40;  // smoothing windows in the run

using Curve = std::vector<double>;

/// Centred mean over `window` values; at the ends over those that exist.
Curve Smoothed(const Curve& values, std::size_t window) {
  Curve sums(values.size() + 1, 0), smooth(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  const std::size_t half = window / 2;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t begin = i > half ? i - half : 0;
    const std::size_t end = std::min(values.size(), i + half + 1);
    smooth[i] = (sums[end] - sums[begin]) / static_cast<double>(end - begin);
  }
  return smooth;
}

struct Window {
  double seconds = 0;
  std::size_t columns = 1;
};

Window WindowFor(const Timeline& timeline, std::size_t columns) {
  const double span = timeline.end_s - timeline.begin_s;
  if (!(span > 0)) return {};
  const double seconds = RoundStep(span, kWindows);
  return {seconds, std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(
                                                seconds / span * static_cast<double>(columns))))};
}

/// "0.5 s": in the unit of the axis.
std::string WindowText(const Timeline& timeline, const Window& window) {
  const Unit unit = TimeUnitFor(timeline.end_s - timeline.begin_s);
  return fmt::format("{:g} {}", window.seconds / unit.size, unit.name);
}

struct Utilisation {
  Curve mean, least, most, since_start;
};

Utilisation UtilisationOf(const Timeline& timeline, std::size_t columns) {
  Utilisation load{Curve(columns, 0), Curve(columns, 1), Curve(columns, 0), Curve(columns, 0)};
  const std::size_t window = WindowFor(timeline, columns).columns;
  double ranks = 0;
  for (const TimelineRow& row : timeline.rows) {
    if (row.is_host) continue;
    Curve user(columns);
    const std::vector<StateShares> shares = AverageColumns(std::span(&row, 1), columns);
    for (std::size_t i = 0; i < columns; ++i) user[i] = static_cast<double>(shares[i][0]);
    user = Smoothed(user, window);
    for (std::size_t i = 0; i < columns; ++i) {
      load.mean[i] += user[i];
      load.least[i] = std::min(load.least[i], user[i]);
      load.most[i] = std::max(load.most[i], user[i]);
    }
    ++ranks;
  }
  double sum = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    load.mean[i] /= std::max(ranks, 1.0);
    sum += load.mean[i];
    load.since_start[i] = sum / static_cast<double>(i + 1);
  }
  return load;
}

struct CurveFrame {
  TimeAxis axis;
  double largest = 1;

  double YOf(double value) const {
    return kCurveTop + kCurveHeight * (1 - std::clamp(value / largest, 0.0, 1.0));
  }
  std::vector<Point> Line(const Curve& curve) const {
    std::vector<Point> points;
    const double step = axis.width() / static_cast<double>(curve.size());
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Point point{axis.left + (static_cast<double>(i) + 0.5) * step,
                        std::round(YOf(curve[i]) * 10) / 10};
      // Level stretches need their ends only.
      const std::size_t n = points.size();
      if (n >= 2 && points[n - 1].y == point.y && points[n - 2].y == point.y)
        points[n - 1].x = point.x;
      else
        points.push_back(point);
    }
    if (!points.empty()) {
      points.front().x = axis.left;
      points.back().x = axis.right;
    }
    return points;
  }
  PolygonShape Between(const Curve& low, const Curve& high, Colour fill) const {
    PolygonShape area{Line(high), fill};
    const std::vector<Point> back = Line(low);
    area.points.insert(area.points.end(), back.rbegin(), back.rend());
    return area;
  }
  /// Lines at nothing, half and all, with labels at the left.
  Layer Grid(const std::string& half, const std::string& full) const {
    Layer layer{"grid", {}};
    const std::string labels[] = {"0", half, full};
    for (int i = 0; i < 3; ++i) {
      const double y = std::floor(YOf(largest * i / 2)) + 0.5;
      layer.shapes.emplace_back(LineShape{{{axis.left, y}, {axis.right, y}}, kGrid, 1, false, 1});
      const TextStyle style{.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd};
      layer.shapes.emplace_back(TextShape{axis.left - 10, y, labels[i], style});
    }
    return layer;
  }
};

Layer BottomAxis(const TimeAxis& axis) {
  Layer layer{"axis", {}};
  AddTimeAxis(layer, axis, kCurveTop + kCurveHeight);
  return layer;
}

/// Bytes sent per second in each column, each message charged when its send was entered.
Curve BytesPerSecond(const Timeline& timeline, std::size_t columns) {
  Curve bytes(columns, 0);
  const std::size_t given = timeline.sent_bytes.size();
  for (std::size_t i = 0; i < given; ++i) bytes[i * columns / given] += timeline.sent_bytes[i];
  for (double& value : bytes)
    value *= static_cast<double>(columns) / (timeline.end_s - timeline.begin_s);
  return bytes;
}

bool HasMessages(const Timeline* timeline) {
  return HasRows(timeline) && timeline->message_count > 0 && !timeline->sent_bytes.empty() &&
         timeline->end_s > timeline->begin_s;
}

}  // namespace

Scene UtilisationView(const ViewInput& input) {
  Scene scene{.name = "utilisation", .width = kMainWidth};
  if (!HasRows(input.timeline) || input.timeline->rows.size() < 2 ||
      !(input.timeline->end_s > input.timeline->begin_s))
    return scene;
  const Utilisation load = UtilisationOf(*input.timeline, kCurveColumns);
  const CurveFrame frame{MainAxis(input), 1};
  const bool last = !HasMessages(input.timeline);
  scene.height = kCurveTop + kCurveHeight + (last ? kAxisHeight : 8);
  scene.title = "Processor utilisation";
  scene.description = fmt::format(
      "Mean share of computing {}s over time, with the least and the most busy; {} over the whole "
      "run.",
      NounFor(*input.timeline), FormatPercent(load.since_start.back()));
  scene.note = fmt::format(
      "mean of {}s, {} window \u00b7 band: least to most busy \u00b7 dashed: since the start",
      NounFor(*input.timeline),
      WindowText(*input.timeline, WindowFor(*input.timeline, kCurveColumns)));
  scene.layers.push_back(frame.Grid("50%", "100%"));
  scene.layers.push_back(Layer{"band", {frame.Between(load.least, load.most, kBand)}});
  scene.layers.push_back(
      Layer{"curves",
            {LineShape{frame.Line(load.since_start), kInk, 1, true, 1},
             LineShape{frame.Line(load.mean), ColourOf(State::kUser), 1.75, false, 1}}});
  if (last) scene.layers.push_back(BottomAxis(frame.axis));
  return scene;
}

Scene MessageLoadView(const ViewInput& input) {
  Scene scene{.name = "message-load", .width = kMainWidth};
  if (!HasMessages(input.timeline)) return scene;
  const Window window = WindowFor(*input.timeline, kCurveColumns);
  const Curve load = Smoothed(BytesPerSecond(*input.timeline, kCurveColumns), window.columns);
  const double largest = std::max(1.0, *std::ranges::max_element(load));
  CurveFrame frame{MainAxis(input), 0};
  frame.largest = RoundStep(largest, 1);
  const Unit unit = ByteUnitFor(frame.largest);
  scene.height = kCurveTop + kCurveHeight + kAxisHeight;
  scene.title = "Message load";
  scene.description =
      fmt::format("Bytes sent per second over time; at most {} per second.", FormatBytes(largest));
  scene.note = fmt::format("{}/s, {} window", unit.name, WindowText(*input.timeline, window));
  scene.layers.push_back(frame.Grid(FormatShort(frame.largest / 2 / unit.size),
                                    FormatShort(frame.largest / unit.size)));
  const Curve nothing(load.size(), 0);
  scene.layers.push_back(Layer{"band", {frame.Between(nothing, load, kLoadFill)}});
  scene.layers.push_back(Layer{"curves", {LineShape{frame.Line(load), kLoadLine, 1.5, false, 1}}});
  scene.layers.push_back(BottomAxis(frame.axis));
  return scene;
}

}  // namespace stipple
