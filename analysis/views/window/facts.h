// SPDX-License-Identifier: MIT
// What a click tells about a visit, a call or a message: as lines for the window, and as one line
// of plain text for its title.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_FACTS_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_FACTS_H

#include <string>
#include <vector>

#include "analysis/stats/window_source.h"
#include "analysis/views/window/view_state.h"

namespace stipple {

struct Fact {
  std::string label;
  std::string value;
};

/// The picked thing's own span: what zooming to it shows.
TimeSpan SpanOf(const Picked& picked);

std::vector<Fact> FactsOf(const Picked& picked, const WindowSource& source, const Timeline& whole);
/// "rank 3, MPI_Recv, 0.123456789 s to 0.123460000 s, message from rank 0 ..."; ASCII.
std::string FactsLine(const Picked& picked, const WindowSource& source);

/// "0.123456789 s": to the nanosecond, as events are recorded.
std::string ExactTime(double time_s);

/// The window's title: program, visible span, cursor, facts. ASCII, for window managers and tests.
std::string TitleOf(const ViewState& state, const WindowSource& source);

}  // namespace stipple

#endif
