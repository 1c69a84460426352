// SPDX-License-Identifier: MIT
// Whether a process can still write a stream file.
#ifndef STIPPLE_ANALYSIS_TRACE_WRITER_H
#define STIPPLE_ANALYSIS_TRACE_WRITER_H

#include <string>

namespace stipple {

enum class Writer {
  kGone,
  kThere,
  kUnknown,  // the file lies on another computer's disk, and nobody here can say
};

/// Of the file at `path`; a forked child that holds its parent's stream is a writer, too.
Writer WriterOf(const std::string& path);

}  // namespace stipple

#endif
