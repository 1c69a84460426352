// SPDX-License-Identifier: MIT
// Native stacks as they stand in the stream, and the crashes among them.
#ifndef STIPPLE_ANALYSIS_TRACE_NATIVE_STACK_H
#define STIPPLE_ANALYSIS_TRACE_NATIVE_STACK_H

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "stipple/format.h"

namespace stipple {

/// Whether a record of this kind ends with a native stack.
constexpr bool HasFrames(RecordKind kind) {
  return kind == RecordKind::kSample || kind == RecordKind::kCallPath || kind == RecordKind::kCrash;
}

/// The words of its stack, innermost first.
struct NativeFrames {
  std::span<const std::uint64_t> words;
  std::uint32_t cut = 0;       // as in Sample
  bool first_is_call = false;  // the first is a return address like the others
};
NativeFrames FramesOf(const EventWord* record);

/// Its functions, outermost first, inlined ones included; "..." where some were left out.
std::vector<std::string> PathOf(const Trace& trace, const Process& process,
                                const NativeFrames& frames);

/// One thread of a process that a signal ended.
struct CrashedThread {
  const Location* location = nullptr;
  Crash crash;                    // its signal is 0 in the threads that were not hit
  std::vector<EventWord> record;  // all of it

  NativeFrames Frames() const { return FramesOf(record.data()); }
};

/// Threads of crashed processes, those that were hit first.
std::vector<CrashedThread> CrashesOf(const Trace& trace);

/// "SIGSEGV"; "signal 99" for others.
std::string SignalName(int signal);

/// "rank 3 crashed: SIGSEGV at 0x10 in solver::step (solver.cpp:120)", one for each thread that was
/// hit and for each process that a signal ended without one.
std::vector<std::string> CrashTexts(const Trace& trace);

/// "f (f.cpp:3)", "g (libg.so+0x12), 3 times", a line for each function, innermost first.
std::vector<std::string> StackLines(const Trace& trace, const Process& process,
                                    const NativeFrames& frames);

}  // namespace stipple

#endif
