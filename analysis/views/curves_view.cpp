// SPDX-License-Identifier: MIT
// Series over time as lines above one another on one time axis: a panel for each table and kind of
// number. "least" and "most" are a band behind the lines, "since_start" is dashed; of many ranks
// the mean is drawn, with a band from the least to the most.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/views/label_room.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/series.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"

namespace stipple {
namespace {

constexpr double kPanelHeight = 150, kPanelGap = 46, kHeading = 24;
constexpr std::size_t kMostRankLines = 5;  // of a table by rank; of more the mean and a band
constexpr std::size_t kMostPanels = 12;
constexpr std::size_t kColumns = 500;  // points a line has at most

/// Means over equal parts of the axis; not a number where there is nothing.
using Curve = std::vector<double>;

struct Line {
  std::string label{};
  Curve curve{};
  Colour colour{};
  bool dashed = false;
};

struct Panel {
  std::string heading{};
  Quantity quantity = Quantity::kCount;
  std::vector<Line> lines{};
  Curve least{}, most{};  // empty: no band
  std::string band{};
};

/// Parts of the axis: no more than the longest line has points, so that what is not known is not
/// made up.
std::size_t PartsFor(const std::vector<SeriesColumn>& columns) {
  std::size_t most = 1;
  for (const SeriesColumn& column : columns)
    for (const TimeSeries& line : column.lines) most = std::max(most, line.points.size());
  return std::min(kColumns, std::max<std::size_t>(most * 2, 100));
}

/// Mean, least and most of curves at each place.
struct Spread {
  Curve mean, least, most;
  explicit Spread(const std::vector<Curve>& curves) {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const std::size_t count = curves.front().size();
    mean.assign(count, nothing), least = mean, most = mean;
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0, number = 0;
      for (const Curve& curve : curves) {
        if (std::isnan(curve[i])) continue;
        ++number;
        sum += (curve[i] - sum) / number;
        least[i] = std::isnan(least[i]) ? curve[i] : std::min(least[i], curve[i]);
        most[i] = std::isnan(most[i]) ? curve[i] : std::max(most[i], curve[i]);
      }
      if (number > 0) mean[i] = sum;
    }
  }
};

void AddRanks(Panel& panel, const SeriesColumn& column, const std::vector<Curve>& curves) {
  const bool host = HasHost(column.ranks);
  if (curves.size() <= kMostRankLines) {
    // A rank has one colour; of several columns the later ones say which they are.
    const bool dashed = column.column.starts_with("since_start"), first = panel.lines.empty();
    for (std::size_t i = 0; i < curves.size(); ++i) {
      std::string label = RowLabel(column.ranks[i], host);
      if (!first) label += ", " + WordsFor(column.column);
      panel.lines.push_back({label, curves[i], ColoursOf("", i).line, dashed});
    }
    return;
  }
  const Spread spread(curves);
  const bool dashed = column.column.starts_with("since_start");
  panel.lines.push_back({"mean " + WordsFor(column.column), spread.mean,
                         dashed ? kInk : ColoursOf(column.column, panel.lines.size()).line,
                         dashed});
  if (!panel.least.empty()) return;
  panel.least = spread.least;
  panel.most = spread.most;
  panel.band = fmt::format("{} ranks, least to most", curves.size());
}

void AddColumn(Panel& panel, const SeriesColumn& column, const TimeAxis& axis, std::size_t parts) {
  std::vector<Curve> curves;
  for (const TimeSeries& line : column.lines) curves.push_back(MeansOf(line, axis, parts));
  if (curves.empty()) return;
  if (!column.ranks.empty()) return AddRanks(panel, column, curves);
  if (column.column == "least" || column.column == "most") {
    (column.column == "least" ? panel.least : panel.most) = curves.front();
    panel.band = "least to most";
    return;
  }
  const bool dashed = column.column.starts_with("since_start");
  panel.lines.push_back({WordsFor(column.column), curves.front(),
                         dashed ? kInk : ColoursOf(column.column, panel.lines.size()).line,
                         dashed});
}

/// Columns of several tables that count the same have a panel together if each table has one of
/// them alone; else each table has its own.
std::vector<Panel> PanelsOf(const std::vector<SeriesColumn>& columns, const TimeAxis& axis) {
  std::vector<Panel> panels;
  std::vector<std::pair<std::string, Quantity>> keys;
  const std::size_t parts = PartsFor(columns);
  for (const SeriesColumn& column : columns) {
    const std::pair key(column.table, column.quantity);
    auto found = std::ranges::find(keys, key);
    if (found == keys.end()) {
      if (panels.size() == kMostPanels) continue;
      keys.push_back(key);
      found = std::prev(keys.end());
      panels.push_back({});
      panels.back().quantity = column.quantity;
      panels.back().heading = WordsFor(column.table);
    }
    AddColumn(panels[static_cast<std::size_t>(found - keys.begin())], column, axis, parts);
  }
  std::erase_if(panels,
                [](const Panel& panel) { return panel.lines.empty() && panel.least.empty(); });
  for (Panel& panel : panels) {
    if (panel.least.size() != panel.most.size()) panel.least.clear(), panel.most.clear();
    if (panel.least.empty()) panel.band.clear();
  }
  return panels;
}

ValueAxis AxisOf(const Panel& panel) {
  ValueRange range;
  for (const Line& line : panel.lines)
    for (const double value : line.curve) range.Add(value);
  for (const double value : panel.least) range.Add(value);
  for (const double value : panel.most) range.Add(value);
  return AxisFor(range, panel.quantity, 4);
}

/// Where a panel's values lie.
struct PanelPlace {
  TimeAxis time;
  ValueAxis axis;
  double top = 0;

  double Bottom() const { return top + kPanelHeight; }
  double YOf(double value) const { return Bottom() - axis.ShareOf(value) * kPanelHeight; }
  double XOf(std::size_t i, std::size_t count) const {
    return time.left + time.width() * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  }
  /// Pieces between gaps; level stretches have their ends only, and outer pieces reach the edges.
  std::vector<std::vector<Point>> Pieces(const Curve& curve) const {
    std::vector<std::vector<Point>> pieces;
    bool open = false;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (std::isnan(curve[i])) {
        open = false;
        continue;
      }
      const Point point{XOf(i, curve.size()), std::round(YOf(curve[i]) * 10) / 10};
      if (!open) pieces.push_back({Point{i == 0 ? time.left : point.x, point.y}});
      open = true;
      std::vector<Point>& piece = pieces.back();
      const std::size_t n = piece.size();
      if (n >= 2 && piece[n - 1].y == point.y && piece[n - 2].y == point.y)
        piece[n - 1].x = point.x;
      else
        piece.push_back(point);
      if (i + 1 == curve.size()) piece.push_back({time.right, point.y});
    }
    return pieces;
  }
};

void AddGrid(const PanelPlace& place, Layer& grid) {
  double last = 1e9;
  for (const ValueTick& tick : place.axis.Ticks()) {
    const double y = std::floor(place.YOf(tick.value)) + 0.5;
    grid.shapes.emplace_back(LineShape{{{place.time.left, y}, {place.time.right, y}},
                                       tick.value == 0 && place.axis.least < 0 ? kHairline : kGrid,
                                       1,
                                       false,
                                       1});
    if (last - y < 15) continue;
    last = y;
    grid.shapes.emplace_back(TextShape{place.time.left - 10,
                                       y,
                                       tick.label,
                                       {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd}});
  }
}

void AddBand(const PanelPlace& place, const Panel& panel, Layer& band) {
  const auto tops = place.Pieces(panel.most), bottoms = place.Pieces(panel.least);
  for (std::size_t i = 0; i < std::min(tops.size(), bottoms.size()); ++i) {
    PolygonShape area{tops[i], kBand};
    area.points.insert(area.points.end(), bottoms[i].rbegin(), bottoms[i].rend());
    band.shapes.emplace_back(std::move(area));
  }
}

/// Heading at the left, and what the lines are, in their colours, after it.
void AddHeading(const PanelPlace& place, const Panel& panel, Layer& layer) {
  const double y = place.top - 14;
  double x = place.time.left;
  const auto add = [&](const std::string& text, Colour colour, bool bold) {
    const double width = TextWidth(text, bold ? 13 : 12, bold);
    if (x + width > place.time.right) return;
    layer.shapes.emplace_back(
        TextShape{x, y, text, {.size = bold ? 13.0 : 12.0, .colour = colour, .bold = bold}});
    x += width + 18;
  };
  add(panel.heading, kInk, true);
  for (const Line& line : panel.lines) {
    constexpr double kStroke = 18;
    if (x + kStroke + 6 + TextWidth(line.label, 12) > place.time.right) break;
    layer.shapes.emplace_back(
        LineShape{{{x, y}, {x + kStroke, y}}, line.colour, line.dashed ? 1 : 2.0, line.dashed, 1});
    x += kStroke + 6;
    add(line.label, line.colour, false);
  }
  if (panel.band.empty() || x + 24 + TextWidth(panel.band, 12) > place.time.right) return;
  layer.shapes.emplace_back(RectShape{x, y - 6, 18, 12, kBand, {}});
  x += 24;
  add(panel.band, kSecondary, false);
}

double LeftOf(const std::vector<Panel>& panels) {
  double widest = 0;
  for (const Panel& panel : panels)
    for (const ValueTick& tick : AxisOf(panel).Ticks())
      widest = std::max(widest, TextWidth(tick.label, 12));
  return std::max(56.0, std::ceil(widest + 12));
}

}  // namespace

Scene XyView(const ViewInput& input) {
  Scene scene{.name = "xy", .width = kMainWidth};
  const std::vector<SeriesColumn> columns = SeriesOf(input);
  TimeAxis time = AxisOf(input, columns);
  const std::vector<Panel> panels = PanelsOf(columns, time);
  if (panels.empty()) return scene;
  time.left = LeftOf(panels);
  time.right = kMainWidth;
  Layer grid{"grid", {}}, bands{"band", {}}, curves{"curves", {}}, words{"labels", {}},
      axis{"axis", {}};
  double top = kHeading;
  for (const Panel& panel : panels) {
    const PanelPlace place{time, AxisOf(panel), top};
    AddGrid(place, grid);
    AddBand(place, panel, bands);
    for (const Line& line : panel.lines)
      for (std::vector<Point>& piece : place.Pieces(line.curve))
        curves.shapes.emplace_back(
            LineShape{std::move(piece), line.colour, line.dashed ? 1 : 1.75, line.dashed, 1});
    AddHeading(place, panel, words);
    scene.description += (scene.description.empty() ? "" : ", ") + panel.heading;
    top += kPanelHeight + kPanelGap;
  }
  const double bottom = top - kPanelGap;
  AddTimeAxis(axis, time, bottom);
  scene.height = std::ceil(bottom + kAxisHeight);
  scene.title = panels.size() == 1 ? panels.front().heading + " over time" : "Over time";
  scene.description = "Lines over time: " + scene.description + ".";
  scene.layers = {std::move(grid), std::move(bands), std::move(curves), std::move(words),
                  std::move(axis)};
  return scene;
}

}  // namespace stipple
