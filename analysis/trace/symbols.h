// SPDX-License-Identifier: MIT
// Names for functions that were recorded by address: those of the symbols in the files that were
// mapped, if these are still the same files.
#ifndef STIPPLE_ANALYSIS_TRACE_SYMBOLS_H
#define STIPPLE_ANALYSIS_TRACE_SYMBOLS_H

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/health.h"
#include "analysis/trace/stream.h"

namespace stipple {

/// Gives regions that stand for code their linkage names and, where the file has debug information,
/// source file and line. What has no symbol, or whose file is gone or has another build-id, stays
/// "module+0xoffset" and is counted in `health`, by file.
void NameCode(std::span<const std::unique_ptr<Stream>> streams, TraceHealth& health);

/// A function of a native stack.
struct FrameName {
  std::string name;  // demangled; of unknown code the file's name, or "(no file)"
  std::string file;  // empty: not known
  std::uint32_t line = 0;
  bool known = false;
  std::string module;  // the file's name without directories; empty: none
};

class SymbolCache;

/// Names for the words of native stacks (format.h), each looked up once.
class FrameNames {
 public:
  FrameNames();
  ~FrameNames();
  FrameNames(const FrameNames&) = delete;
  FrameNames& operator=(const FrameNames&) = delete;
  /// The functions at a frame, innermost first: those that were inlined there, where the file has
  /// debug information, then the one whose code it is. Never empty.
  const std::vector<FrameName>& Of(const Stream& stream, std::uint64_t frame, bool is_return);

 private:
  std::unique_ptr<SymbolCache> cache_;
  std::map<std::pair<const Stream*, std::uint64_t>, std::vector<FrameName>> names_;
};

}  // namespace stipple

#endif
