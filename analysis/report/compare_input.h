// SPDX-License-Identifier: MIT
// Two runs side by side: what changed, by how much, and the sentence about it. Everything is
// computed here; html_compare.cpp draws it.
#ifndef STIPPLE_ANALYSIS_REPORT_COMPARE_INPUT_H
#define STIPPLE_ANALYSIS_REPORT_COMPARE_INPUT_H

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"

namespace stipple {

/// One of the two runs.
struct ComparedRun {
  std::string name;     // of the archive, told apart from the other's
  std::string program;  // that was traced
  double span_s = 0;    // of the run, or of the part that was asked for
  Timeline timeline;    // both as long as the longer one
  Table messages;
  Table volume;
  std::array<double, kStateCount> state_s{};  // of a rank on average, the host left out
  bool has_system = false;
  std::map<std::string, double> waited_s;  // by culprit ("node 3"): of a rank on average
  std::vector<std::string> facts;
  std::vector<std::string> health;
};

struct CompareInput {
  std::string headline;            // "b is 1.34 times as fast as a: 4.1 s less waiting for rank 0"
  std::vector<std::string> notes;  // what makes the runs hard to compare
  ComparedRun a, b;
  Table functions;  // region, a_s, b_s, change_s, a_calls, b_calls: most change first
  Table pairs;      // sender, receiver, a_messages, b_messages, a_bytes, b_bytes: likewise
  bool mono = false;
};

ComparedRun RunOf(const Analysis& analysis, const Selection& selection, std::string name);

/// `columns`: of each timeline.
CompareInput CompareInputOf(const Analysis& a, const Analysis& b, const Selection& selection_a,
                            const Selection& selection_b, std::size_t columns);

/// What the headline says of two runs of which only spans, states and waits are known.
std::string CompareHeadline(const ComparedRun& a, const ComparedRun& b);

}  // namespace stipple

extern "C" {

/// Draws the comparison as one self-contained HTML file; see stipple_draw_report.
int stipple_draw_compare(const stipple::CompareInput* input, const char* path, char* error,
                         std::size_t error_bytes);
}

#endif
