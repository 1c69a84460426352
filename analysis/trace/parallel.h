// SPDX-License-Identifier: MIT
// Work on several cores. What is done does not depend on their number: each index is done once, and
// results are kept by index.
#ifndef STIPPLE_ANALYSIS_TRACE_PARALLEL_H
#define STIPPLE_ANALYSIS_TRACE_PARALLEL_H

#include <cstddef>
#include <functional>

namespace stipple {

/// Calls body(0) ... body(count - 1), in that order of beginning, and returns when all are done.
/// The first exception is passed on.
void ForEachIndex(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace stipple

#endif
