// SPDX-License-Identifier: MIT
#include "analysis/views/window/curves_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/window/shapes.h"

namespace stipple {
namespace {

constexpr double kPixelsPerStep = 3;

using Curve = std::vector<double>;

struct Frame {
  TimeAxis axis;
  Area area;
  double largest = 1;

  double YOf(double value) const {
    return area.bottom() - std::clamp(value / largest, 0.0, 1.0) * (area.height - 4);
  }
  double XOf(std::size_t step, std::size_t steps) const {
    return axis.left + axis.width() * static_cast<double>(step) / static_cast<double>(steps);
  }
  void Grid(Layer& layer, const std::string& half, const std::string& full) const {
    const std::string labels[] = {"0", half, full};
    for (int i = 0; i < 3; ++i) {
      const double y = std::floor(YOf(largest * i / 2)) + 0.5;
      AddLine(layer, {axis.left, y}, {axis.right, y}, kGrid);
      AddText(layer, {axis.left - 10, y}, labels[i],
              {.size = 11, .colour = kSecondary, .anchor = Anchor::kEnd});
    }
  }
  /// Equal neighbours are one rectangle.
  void Between(Layer& layer, const Curve& low, const Curve& high, Colour fill) const {
    for (std::size_t i = 0; i < low.size();) {
      std::size_t end = i + 1;
      while (end < low.size() && low[end] == low[i] && high[end] == high[i]) ++end;
      const double top = YOf(high[i]), bottom = YOf(low[i]);
      const double left = XOf(i, low.size());
      if (bottom > top)
        AddRect(layer, {left, top, XOf(end, low.size()) - left, bottom - top}, fill);
      i = end;
    }
  }
  void Line(Layer& layer, const Curve& curve, Colour stroke, double width, bool dashed) const {
    LineShape line{{}, stroke, width, dashed, 1};
    for (std::size_t i = 0; i < curve.size(); ++i)
      line.points.push_back({(XOf(i, curve.size()) + XOf(i + 1, curve.size())) / 2, YOf(curve[i])});
    if (line.points.empty()) return;
    line.points.front().x = axis.left;
    line.points.back().x = axis.right;
    layer.shapes.emplace_back(std::move(line));
  }
};

std::size_t StepsFor(const TimeAxis& axis, std::size_t columns) {
  const auto steps = static_cast<std::size_t>(std::max(8.0, axis.width() / kPixelsPerStep));
  return std::clamp<std::size_t>(columns, 1, steps);
}

/// Computing share of one row, column by column averaged into `steps`.
Curve UserOf(const TimelineRow& row, std::size_t steps) {
  Curve user(steps);
  const std::size_t columns = row.columns.size();
  for (std::size_t i = 0; i < steps; ++i) {
    const std::size_t begin = i * columns / steps;
    const std::size_t end = std::max(begin + 1, (i + 1) * columns / steps);
    for (std::size_t c = begin; c < std::min(end, columns); ++c)
      user[i] += static_cast<double>(row.columns[c][0]) / static_cast<double>(end - begin);
  }
  return user;
}

struct Utilisation {
  Curve mean, least, most;
};

Utilisation UtilisationOf(const Timeline& timeline, std::size_t steps) {
  Utilisation of{Curve(steps, 0), Curve(steps, 1), Curve(steps, 0)};
  double ranks = 0;
  const bool only_hosts = std::ranges::all_of(timeline.rows, &TimelineRow::is_host);
  for (const TimelineRow& row : timeline.rows) {
    if (row.is_host && !only_hosts) continue;
    const Curve user = UserOf(row, steps);
    for (std::size_t i = 0; i < steps; ++i) {
      of.mean[i] += user[i];
      of.least[i] = std::min(of.least[i], user[i]);
      of.most[i] = std::max(of.most[i], user[i]);
    }
    ++ranks;
  }
  for (double& value : of.mean) value /= std::max(1.0, ranks);
  return of;
}

/// The mean since the start of the run, at each step of the visible span.
Curve SinceStart(const Timeline& whole, const TimeAxis& axis, std::size_t steps) {
  Curve since(steps);
  if (whole.rows.empty() || whole.rows.front().columns.empty()) return since;
  const Curve mean = UtilisationOf(whole, whole.rows.front().columns.size()).mean;
  Curve sums(mean.size() + 1);
  for (std::size_t i = 0; i < mean.size(); ++i) sums[i + 1] = sums[i] + mean[i];
  for (std::size_t i = 0; i < steps; ++i) {
    const double time_s = axis.begin_s + (axis.end_s - axis.begin_s) *
                                             (static_cast<double>(i) + 0.5) /
                                             static_cast<double>(steps);
    const double place = std::clamp(time_s / (whole.end_s - whole.begin_s), 0.0, 1.0) *
                         static_cast<double>(mean.size());
    const auto column = std::min(static_cast<std::size_t>(place), mean.size() - 1);
    const double part = place - static_cast<double>(column);
    since[i] = place > 0 ? (sums[column] + part * mean[column]) / place : mean[0];
  }
  return since;
}

}  // namespace

Layer UtilisationCurve(const Timeline& visible, const Timeline& whole, const TimeAxis& axis,
                       const Area& area) {
  Layer layer{"utilisation", {}};
  const double text =
      AddTitle(layer, {area.left, area.top - kTitleHeight / 2}, "Processor utilisation");
  if (visible.rows.empty() || visible.rows.front().columns.empty()) return layer;
  AddText(layer, {text, area.top - kTitleHeight / 2},
          fmt::format("mean of {}s \u00b7 band: least to most \u00b7 dashed: since the start",
                      NounFor(visible)),
          {.size = 12, .colour = kSecondary});
  const Frame frame{axis, area, 1};
  const std::size_t steps = StepsFor(axis, visible.rows.front().columns.size());
  const Utilisation of = UtilisationOf(visible, steps);
  frame.Grid(layer, "50%", "100%");
  frame.Between(layer, of.least, of.most, kBand);
  frame.Line(layer, SinceStart(whole, axis, steps), kInk, 1, true);
  frame.Line(layer, of.mean, ColourOf(State::kUser), 1.75, false);
  return layer;
}

Layer LoadCurve(const Timeline& visible, const TimeAxis& axis, const Area& area) {
  Layer layer{"load", {}};
  const double text = AddTitle(layer, {area.left, area.top - kTitleHeight / 2}, "Message load");
  const std::size_t columns = visible.sent_bytes.size();
  if (columns == 0) return layer;
  const std::size_t steps = StepsFor(axis, columns);
  Curve load(steps);
  for (std::size_t c = 0; c < columns; ++c)
    load[c * steps / columns] +=
        visible.sent_bytes[c] * static_cast<double>(steps) / (visible.end_s - visible.begin_s);
  const double largest = *std::ranges::max_element(load);
  if (largest <= 0) {
    AddText(layer, {text, area.top - kTitleHeight / 2}, "nothing was sent here",
            {.size = 12, .colour = kSecondary});
    return layer;
  }
  const Frame frame{axis, area, RoundStep(largest, 1)};
  const Unit unit = ByteUnitFor(frame.largest);
  AddText(layer, {text, area.top - kTitleHeight / 2}, fmt::format("{}/s", unit.name),
          {.size = 12, .colour = kSecondary});
  frame.Grid(layer, FormatShort(frame.largest / 2 / unit.size),
             FormatShort(frame.largest / unit.size));
  frame.Between(layer, Curve(steps, 0), load, kLoadFill);
  frame.Line(layer, load, kLoadLine, 1.5, false);
  return layer;
}

}  // namespace stipple
