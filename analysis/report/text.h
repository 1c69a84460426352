// SPDX-License-Identifier: MIT
// Tables as text, CSV and JSON; losses as text.
#ifndef STIPPLE_ANALYSIS_REPORT_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_TEXT_H

#include <string>

#include "analysis/stats/table.h"
#include "analysis/trace/health.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Aligned columns under their names; what was not recorded is "-".
std::string TableText(const Table& table);
/// RFC 4180; what was not recorded is an empty field.
std::string TableCsv(const Table& table);
/// An array of objects, an object, or {"rows","columns","values"} for a matrix, and a newline.
std::string TableJson(const Table& table);

/// "no event lost", "3 events lost", "an unknown number of events lost"
std::string LossText(const TraceHealth& health);

/// ", still running: recorded until 1.23 s"; empty when nothing of it runs any more.
std::string RunningText(const Trace& trace);

}  // namespace stipple

#endif
