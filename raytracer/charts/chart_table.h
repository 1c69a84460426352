// SPDX-License-Identifier: MIT
// A chart as it is measured: points that cost something and miss the truth by something, and one
// sentence that says which of them to take. It is written as a CSV file whose first lines, after
// '#', say what a drawing needs to know; nothing here draws.
#ifndef STIPPLE_RAYTRACER_CHARTS_CHART_TABLE_H
#define STIPPLE_RAYTRACER_CHARTS_CHART_TABLE_H

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raytracer/scene/view.h"

namespace stipple::raytracer {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// One row. Texts hold no commas.
struct ChartPoint {
  std::string panel;            // points of one panel are drawn together: a scene
  std::string series;           // a method
  std::string label;            // the setting of the method
  double cpu_s = kNotMeasured;  // thread CPU time
  double error = kNotMeasured;  // of what the axis says
  bool recommended = false;     // to be taken by default; one point in each panel
  std::vector<double> more{};   // one figure for each of ChartTable::more_columns
};

/// A column of the table and how its axis is called, with the unit.
struct ChartAxis {
  std::string_view column;
  std::string_view title;
};

struct ChartTable {
  std::string name{};
  std::string title{};
  std::string sentence{};            // the answer first: what to take, and what it costs and loses
  std::string effort{};              // how it was measured, and on what
  std::optional<ImageSize> image{};  // of its pictures, if not the session's
  std::string_view quiet{};          // the series that is there for comparison only
  std::string_view kind = "xy";  // points on logarithmic axes, or "map": a value for each x and y
  ChartAxis x{"cpu_s", "CPU seconds"};
  ChartAxis y{"error", "error"};
  ChartAxis value{};  // of a map
  std::vector<std::string_view> more_columns{};
  std::vector<ChartPoint> points{};
};

/// Columns panel,series,label,cpu_s,error,recommended and `more_columns`; a figure that was not
/// measured is empty. Numbers other than times have all their digits.
std::string CsvOf(const ChartTable& table);

/// Writes FOLDER/NAME.csv. Errors: InputError.
void WriteCsv(const ChartTable& table, const std::string& folder);

}  // namespace stipple::raytracer

#endif
