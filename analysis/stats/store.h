// SPDX-License-Identifier: MIT
// The analysis in the index beside the archive: what the first pass found is saved, and found again
// without it. What is kept, and under which name, is a table in store.cpp.
#ifndef STIPPLE_ANALYSIS_STATS_STORE_H
#define STIPPLE_ANALYSIS_STATS_STORE_H

namespace stipple {

struct Analysis;

/// Fills `analysis` from its trace's index. False: there is none, or it lacks a part, and
/// `analysis` has to be made anew.
bool LoadAnalysis(Analysis& analysis);

/// Saves it, if the trace is worth it (Trace::SaveIndex).
void SaveAnalysis(const Analysis& analysis);

}  // namespace stipple

#endif
