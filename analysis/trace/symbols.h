// SPDX-License-Identifier: MIT
// Names for functions that were recorded by address: those of the symbols in the files that were
// mapped, if these are still the same files.
#ifndef STIPPLE_ANALYSIS_TRACE_SYMBOLS_H
#define STIPPLE_ANALYSIS_TRACE_SYMBOLS_H

#include <memory>
#include <span>

#include "analysis/trace/health.h"
#include "analysis/trace/stream.h"

namespace stipple {

/// Gives regions that stand for code their linkage names and, where the file has debug information,
/// source file and line. What has no symbol, or whose file is gone or has another build-id, stays
/// "module+0xoffset" and is counted in `health`, by file.
void NameCode(std::span<const std::unique_ptr<Stream>> streams, TraceHealth& health);

}  // namespace stipple

#endif
