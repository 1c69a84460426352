// SPDX-License-Identifier: MIT
// Tables and events as text, CSV and JSON; numbers with their units.
#ifndef STIPPLE_ANALYSIS_REPORT_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_TEXT_H

#include <cstdint>
#include <string>
#include <string_view>

#include "analysis/stats/table.h"
#include "analysis/trace/health.h"

namespace stipple {

/// Aligned columns under their names; what was not recorded is "-".
std::string TableText(const Table& table);
/// RFC 4180; what was not recorded is an empty field.
std::string TableCsv(const Table& table);
/// An array of objects, an object, or {"rows","columns","values"} for a matrix, and a newline.
std::string TableJson(const Table& table);

/// "1 204"
std::string CountText(std::uint64_t count);
/// "1 event", "2 events"
std::string CountText(std::uint64_t count, std::string_view noun);
/// "no event lost", "3 events lost", "an unknown number of events lost"
std::string LossText(const TraceHealth& health);
/// "12.4 MB"
std::string BytesText(std::uint64_t bytes);
/// "12.3 ms"
std::string SecondsText(double seconds);

}  // namespace stipple

#endif
