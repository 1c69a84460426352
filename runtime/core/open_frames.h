// SPDX-License-Identifier: MIT
// The visits that a thread has open, found by reading back each chunk that is full. Only a ring
// needs them: what a chunk's events leave may have been entered in one that is gone.
//
// The rules are those of the reader (analysis/trace/call_stack.h): a leave that is not that of the
// innermost frame ends those above its own, a leave of what is not open means nothing. A slot that
// an interrupted event has not written yet is left out; the next leave further out mends that.
#ifndef STIPPLE_RUNTIME_CORE_OPEN_FRAMES_H
#define STIPPLE_RUNTIME_CORE_OPEN_FRAMES_H

#include <cstdint>

#include "stipple/format.h"

namespace stipple {

/// Items in mapped memory that a forked child finds zeroed. All zero is empty.
template <class Item>
struct Growing {
  Item* items;
  std::uint32_t count;
  std::uint32_t room;
};

/// All zero is a thread that has not recorded.
struct FrameStack {
  Growing<OpenFrame> frames;  // outermost first
  Growing<OpenPoint> points;  // in the order of their depth, none deeper than the frames
  std::uint32_t unknown;      // stacks were switched, or memory ran out
};

/// What a chunk held.
struct FoldedChunk {
  std::uint64_t events;
  bool complete;  // no slot was reserved and not yet written
};

/// Follows the events of a chunk that began at `ticks`.
FoldedChunk FoldChunk(FrameStack& stack, const EventWord* word, const EventWord* end,
                      std::uint64_t ticks);

/// Writes an OpenFrames record of at most `most` bytes; returns its bytes.
std::uint64_t WriteFrames(const FrameStack& stack, char* place, std::uint64_t most,
                          std::uint64_t ticks);

}  // namespace stipple

#endif
