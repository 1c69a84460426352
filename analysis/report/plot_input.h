// SPDX-License-Identifier: MIT
// What `stipple plot` draws: computed by the program, drawn by the library, which also knows what
// displays there are.
#ifndef STIPPLE_ANALYSIS_REPORT_PLOT_INPUT_H
#define STIPPLE_ANALYSIS_REPORT_PLOT_INPUT_H

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/finding.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
#include "analysis/stats/visit_bars.h"

namespace stipple {

struct PlotInput {
  std::string view;
  std::vector<Table> tables{};
  Timeline timeline{};  // of the span; without rows: the display shows tables
  bool zoomed = false;  // the timeline is a short period, with messages and visits
  VisitBars visits{};
  Finding finding{};
  double at_s = std::numeric_limits<double>::infinity();
  std::vector<std::string> columns{};  // values to show; none: as the display finds best
  std::string x{};                     // column along the x axis of a graph
  bool mono = false;
};

/// A display, as far as one must know it before anything is computed.
struct PlotChoice {
  std::string_view name;
  std::string_view tables;  // shown unless asked otherwise, with commas between; none: the timeline
  bool by_rank = false;     // tables are made by rank where they can be
  bool (*fits)(const Table& table) = nullptr;
  std::string_view description;
};

}  // namespace stipple

extern "C" {

/// All displays; exported by libstipple-views.so.
std::size_t stipple_plot_choices(const stipple::PlotChoice** first);

/// Draws into a file whose name ends in .svg, .png or .pdf. Returns 0, or 1 with the reason in
/// `error`.
int stipple_draw_plot(const stipple::PlotInput* input, const char* path, char* error,
                      std::size_t error_bytes);
}

#endif
