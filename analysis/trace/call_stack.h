// SPDX-License-Identifier: MIT
// The functions that a thread is in, event by event: one stack for each context. Frames that a jump
// left end there. A leave that is not that of the innermost frame shows that the frames above its
// own were left unseen (__builtin_longjmp, an exception through C code): they end with it.
#ifndef STIPPLE_ANALYSIS_TRACE_CALL_STACK_H
#define STIPPLE_ANALYSIS_TRACE_CALL_STACK_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "analysis/trace/jump_points.h"
#include "stipple/format.h"

namespace stipple {

class CallStack {
 public:
  /// Regions of the frames that this event ended without being their leave, innermost first; valid
  /// until the next event. A leave without an enter changes nothing.
  std::span<const std::uint32_t> Function(std::uint32_t region, bool leave);
  std::span<const std::uint32_t> Record(const EventWord* record);
  /// Begins with the frames in an OpenFrames record, whose regions are `regions`.
  void Begin(const EventWord* open_frames, std::span<const std::uint32_t> regions);
  /// Begins with these frames.
  void Begin(std::span<const std::uint32_t> regions);

  std::size_t depth() const { return frames_.size(); }
  /// Outermost first.
  std::span<const std::uint32_t> frames() const { return frames_; }
  /// The innermost region; there must be one.
  std::uint32_t top() const { return frames_.back(); }
  std::uint32_t context() const { return points_.context(); }

 private:
  void Push(std::uint32_t region);
  void Pop();

  std::vector<std::uint32_t> frames_;  // outermost first
  std::vector<std::uint32_t> open_;    // by region: how often it is in frames_
  std::vector<std::uint32_t> left_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> waiting_;  // by context
  JumpPoints points_;
};

}  // namespace stipple

#endif
