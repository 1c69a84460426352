// SPDX-License-Identifier: MIT
// Events as lines of text, for people and (canonical: no times, no ids) for comparing.
#ifndef STIPPLE_ANALYSIS_REPORT_EVENT_TEXT_H
#define STIPPLE_ANALYSIS_REPORT_EVENT_TEXT_H

#include <string>

#include "analysis/trace/trace.h"

namespace stipple {

/// "send 8 to 1 tag 3", "enter main"; empty for what a canonical text leaves out (posts, ends of
/// requests, probes: they depend on timing).
std::string CanonicalText(const Trace& trace, const Location& location, const Event& event);

/// The same and more, with where a region is defined.
std::string EventText(const Trace& trace, const Location& location, const Event& event);

}  // namespace stipple

#endif
