// SPDX-License-Identifier: MIT
// Filled contours of a value over ranks and time.
//
// Between the middles of two neighbouring rows the value is taken to change evenly, as it does in
// time. On a line of one moment between two rows, all that is at least a level is then one stretch:
// it begins at a row or ends at one, or is everything or nothing. Such stretches, connected from
// moment to moment, are the polygons of that level; levels are painted one over the other, the
// lowest first. There are no saddles to decide about, as marching squares have, and no polygon has
// holes, which OpenGL and SVG would fill differently. Edges between rows lie on whole pixels, so
// that no seams show.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/series.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/value_axis.h"

namespace stipple {
namespace {

constexpr std::size_t kMostRows = 64;        // beyond that neighbouring ranks share one
constexpr std::size_t kMostSamples = 16000;  // moments times rows
constexpr double kLeastHeight = 120, kMostHeight = 640;

struct Field {
  TimeAxis time;
  ValueAxis axis;
  std::vector<std::vector<double>> rows;  // share of the axis at each moment; 0 where not known
  RowGrid grid;

  double XOf(std::size_t i) const {
    return time.left +
           time.width() * static_cast<double>(i) / static_cast<double>(rows[0].size() - 1);
  }
};

/// From `begin` to `end` of the way from the upper row to the lower one.
struct Stretch {
  double begin = 0, end = 0;
  bool empty() const { return !(end > begin); }
};

Stretch AtLeast(double level, double upper, double lower) {
  if (upper >= level && lower >= level) return {0, 1};
  if (upper < level && lower < level) return {};
  const double cross = (upper - level) / (upper - lower);
  return upper >= level ? Stretch{0, cross} : Stretch{cross, 1};
}

/// A run of stretches as one polygon; points on a straight edge are left out.
void AddRun(const Field& field, std::size_t first, const std::vector<Stretch>& run, double top,
            double height, Colour fill, Layer& layer) {
  PolygonShape shape{{}, fill};
  const auto side = [&](bool upper) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double share = upper ? run[i].begin : run[i].end;
      const Point point{field.XOf(first + i), std::round((top + share * height) * 10) / 10};
      const std::size_t n = points.size();
      if (n >= 2 && points[n - 1].y == point.y && points[n - 2].y == point.y)
        points[n - 1].x = point.x;
      else
        points.push_back(point);
    }
    return points;
  };
  shape.points = side(true);
  const std::vector<Point> back = side(false);
  shape.points.insert(shape.points.end(), back.rbegin(), back.rend());
  if (shape.points.size() > 2) layer.shapes.emplace_back(std::move(shape));
}

void AddLevel(const Field& field, double level, Colour fill, Layer& layer) {
  const std::size_t count = field.rows[0].size();
  for (std::size_t r = 0; r + 1 < field.rows.size(); ++r) {
    const double top = std::round(field.grid.middle(r));
    const double height = std::round(field.grid.middle(r + 1)) - top;
    std::vector<Stretch> run;
    std::size_t first = 0;
    for (std::size_t i = 0; i <= count; ++i) {
      const Stretch next =
          i < count ? AtLeast(level, field.rows[r][i], field.rows[r + 1][i]) : Stretch{};
      const bool goes_on = !next.empty() && !run.empty() && next.begin < run.back().end &&
                           run.back().begin < next.end;
      if (!run.empty() && !goes_on) {
        if (run.size() > 1) AddRun(field, first, run, top, height, fill, layer);
        run.clear();
      }
      if (next.empty()) continue;
      if (run.empty()) first = i;
      run.push_back(next);
    }
  }
}

Layer Levels(const Field& field, const std::vector<double>& levels) {
  Layer layer{"cells", {}};
  const double top = std::round(field.grid.middle(0));
  const double bottom = std::round(field.grid.middle(field.rows.size() - 1));
  layer.shapes.emplace_back(
      RectShape{field.time.left, top, field.time.width(), bottom - top, kEmptyCell, {}});
  for (std::size_t k = 1; k + 1 < levels.size(); ++k) {
    const int step = static_cast<int>(k * kRampSteps / (levels.size() - 2));
    AddLevel(field, field.axis.ShareOf(levels[k]), RampColour(step), layer);
  }
  return layer;
}

/// Means of drawn rows over parts; the first and the last row twice, so that they have their
/// height.
Field FieldOf(const ViewInput& input, const SeriesColumn& column) {
  Field field;
  const std::size_t ranks = column.ranks.size();
  RowGridLimits limits;
  limits.top = 4;
  limits.max_rows = kMostRows;
  limits.max_height = kMostHeight;
  limits.max_pitch = std::max(28.0, std::floor(kLeastHeight / static_cast<double>(ranks)));
  limits.fill = 1;
  field.grid = MakeRowGrid(column.ranks, CulpritOf(input), limits);
  field.time = AxisOf(input, {column});
  field.time.left = AxisLeft(field.grid);
  field.time.right = kMainWidth;
  const std::size_t parts = std::clamp<std::size_t>(kMostSamples / field.grid.rows.size(), 60, 360);
  std::vector<std::vector<double>> means;
  ValueRange range;
  for (const GridRow& row : field.grid.rows) {
    std::vector<double>& mean = means.emplace_back(parts, 0);
    for (std::size_t k = 0; k < row.count; ++k) {
      const std::vector<double> one = MeansOf(column.lines[row.first + k], field.time, parts);
      for (std::size_t i = 0; i < parts; ++i)
        mean[i] += (std::isnan(one[i]) ? 0 : one[i]) / static_cast<double>(row.count);
    }
    for (const double value : mean) range.Add(value);
  }
  field.axis = AxisFor(range, column.quantity, 6);
  for (std::vector<double>& row : means) {
    for (double& value : row) value = field.axis.ShareOf(value);
    field.rows.push_back(std::move(row));
  }
  return field;
}

/// Half a row above the first middle and below the last one, where there is nothing to blend with.
void Widen(Field& field) {
  GridRow above = field.grid.rows.front(), below = field.grid.rows.back();
  above.y -= above.height / 2, above.height = 0, above.label.clear();
  below.y += below.height / 2 + below.height / 2, below.height = 0, below.label.clear();
  above.y = field.grid.rows.front().y;
  field.grid.rows.insert(field.grid.rows.begin(), above);
  field.grid.rows.push_back(below);
  field.rows.insert(field.rows.begin(), field.rows.front());
  field.rows.push_back(field.rows.back());
}

/// "20\u201340%": as the axis's ticks are written.
std::string LevelText(const ValueAxis& axis, double from, double to) {
  std::string text;
  for (const double value : {from, to}) {
    std::string number = axis.NumberAt(value);
    if (!text.empty()) text += "\u2013";
    text += number;
  }
  return text + (axis.scale.unit == "%" || axis.scale.unit.empty() ? "" : " ") + axis.scale.unit;
}

SeriesColumn FirstByRank(const ViewInput& input) {
  for (SeriesColumn& column : SeriesOf(input))
    if (!column.ranks.empty()) return column;
  return {};
}

}  // namespace

Scene ContourView(const ViewInput& input) {
  Scene scene{.name = "contour", .width = kMainWidth};
  const SeriesColumn column = FirstByRank(input);
  if (column.ranks.empty()) return scene;
  Field field = FieldOf(input, column);
  Widen(field);
  std::vector<double> levels;
  for (const ValueTick& tick : field.axis.Ticks()) levels.push_back(tick.value);
  if (levels.size() < 3)
    levels = {field.axis.least, (field.axis.least + field.axis.most) / 2, field.axis.most};
  const double bottom = field.grid.rows.back().y + 6;
  Layer time{"axis", {}};
  AddTimeAxis(time, field.time, bottom);
  scene.height = std::ceil(bottom + kAxisHeight);
  const std::string noun = HasHost(column.ranks) ? "node" : "rank";
  scene.title =
      fmt::format("{}: {} by {} and time", WordsFor(column.table), WordsFor(column.column), noun);
  scene.description = fmt::format("Contours of {} over {}s and time; rank 0 on top.",
                                  WordsFor(column.column), noun);
  if (field.grid.ranks_per_row > 1)
    scene.note = fmt::format("a row: mean of {} ranks", field.grid.ranks_per_row);
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const int step = k == 0 ? 0 : static_cast<int>(k * kRampSteps / (levels.size() - 2));
    scene.key.push_back({LevelText(field.axis, levels[k], levels[k + 1]),
                         step == 0 ? kEmptyCell : RampColour(step)});
  }
  scene.layers = {Levels(field, levels), RowLabels(field.grid, field.time.left - 10),
                  std::move(time)};
  return scene;
}

}  // namespace stipple
