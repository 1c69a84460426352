// SPDX-License-Identifier: MIT
// A chart as a program measured it: a CSV file whose first lines, after '#', say what it is. The
// file's form is told in docs/stipple-exemplar.md.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_MEASURED_CHART_H
#define STIPPLE_ANALYSIS_EXEMPLAR_MEASURED_CHART_H

#include <string>

#include "analysis/stats/table.h"

namespace stipple {

/// A column of the table and how its axis is called.
struct MeasuredAxis {
  std::string column;
  std::string title;
};

struct MeasuredChart {
  std::string name{};  // of the file, without .csv
  std::string title{};
  std::string sentence{};  // the answer
  std::string effort{};    // how it was measured, and on what
  std::string kind{};      // "xy" or "map"
  std::string quiet{};     // a series that is there for comparison
  MeasuredAxis x{}, y{}, value{};
  Table table{};
};

/// Errors: InputError, `file:line: problem`.
MeasuredChart ReadMeasuredChart(const std::string& path);

}  // namespace stipple

#endif
