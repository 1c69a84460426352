// SPDX-License-Identifier: MIT
// A figure of an experiment: panels side by side, and the table of what they show.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_FIGURE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_FIGURE_H

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "analysis/stats/table.h"
#include "analysis/views/line_chart.h"
#include "analysis/views/stacked_bars.h"

namespace stipple {

struct Figure {
  std::string name;  // of its files, behind the experiment's: "F8-time"
  std::string title;
  std::string note;  // what bars or lines are, beside the title
  std::vector<std::variant<StackedBars, LineChart>> panels{};
  std::size_t columns = 2;
  Table table{};
};

}  // namespace stipple

#endif
