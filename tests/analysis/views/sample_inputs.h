// SPDX-License-Identifier: MIT
// Synthetic reports with the shapes that real ones have: for tests of the layout, and to be looked
// at.
#ifndef STIPPLE_TESTS_ANALYSIS_VIEWS_SAMPLE_INPUTS_H
#define STIPPLE_TESTS_ANALYSIS_VIEWS_SAMPLE_INPUTS_H

#include <span>
#include <string_view>

#include "analysis/report/compare_input.h"
#include "analysis/report/report_input.h"
#include "analysis/views/view_list.h"

namespace stipple {

/// `nodes` ranks, of which rank 0 delays all others in the second half; with or without a host.
ReportInput SampleReport(int nodes, bool host);

/// One rank, no messages.
ReportInput SampleSerial();

/// States, messages and names at random: the most that a page may have to hold.
ReportInput SampleNoise(int ranks);

/// A run of one event and no length.
ReportInput SampleEmpty();

/// Two such reports, the second a fifth shorter.
CompareInput SampleCompare(int nodes_a, int nodes_b);

struct SampleEntry {
  std::string_view name;
  ReportInput (*make)();
};
std::span<const SampleEntry> Samples();

ViewInput ViewsOfSample(const ReportInput& report);

}  // namespace stipple

#endif
