// SPDX-License-Identifier: MIT
// Which tables fit which views; together with FitsTime and FitsRanks.
#ifndef STIPPLE_ANALYSIS_VIEWS_FITS_H
#define STIPPLE_ANALYSIS_VIEWS_FITS_H

#include "analysis/stats/table.h"

namespace stipple {

bool FitsBars(const Table& table);       // values by rank or by name
bool FitsFlame(const Table& table);      // a tree with inclusive times
bool FitsGraph(const Table& table);      // numbers
bool FitsHistogram(const Table& table);  // classes, or kinds that are counted
bool FitsMatrix(const Table& table);
bool FitsStatus(const Table& table);  // states of ranks

}  // namespace stipple

#endif
