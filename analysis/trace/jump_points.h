// SPDX-License-Identifier: MIT
// Where the jumps of one thread lead: setjmp and longjmp, and contexts, each with a call stack of
// its own (getcontext, setcontext, swapcontext).
//
// The stack pointer that a jump goes back to names its jump point. A longjmp to a point on another
// stack is how some coroutines switch: it changes the context, and the frames left behind wait.
#ifndef STIPPLE_ANALYSIS_TRACE_JUMP_POINTS_H
#define STIPPLE_ANALYSIS_TRACE_JUMP_POINTS_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "stipple/format.h"

namespace stipple {

/// A place in a call stack: that of a context (0: the thread's own), with `depth` frames.
struct StackPlace {
  std::uint32_t context = 0;
  std::size_t depth = 0;
};

class JumpPoints {
 public:
  /// Where the thread stands after the record, being at `depth` before: nothing if the record is no
  /// jump. Its depth may be more than its context has frames, in a damaged archive.
  std::optional<StackPlace> After(const EventWord* record, std::size_t depth);
  /// Points that were alive when the rest of a ring began; the record's frames are the stack.
  void Begin(const EventWord* open_frames);
  /// The context that the thread is in.
  std::uint32_t context() const { return context_; }
  /// No jump point and no further context is known.
  bool IsPlain() const { return points_.empty() && context_ == 0; }

 private:
  StackPlace Unwind(std::uint64_t stack) const;
  StackPlace Switch(const StackSwitch& r, std::size_t depth);

  std::unordered_map<std::uint64_t, StackPlace> points_;  // by stack pointer
  std::uint32_t context_ = 0;
  std::uint32_t last_context_ = 0;
};

}  // namespace stipple

#endif
