// SPDX-License-Identifier: MIT
// The open visits of a thread for a visitor that keeps something of its own in each frame and its
// top in a register: as CallStack follows them, with all that is rare out of the way.
#ifndef STIPPLE_ANALYSIS_STATS_FRAME_STACK_H
#define STIPPLE_ANALYSIS_STATS_FRAME_STACK_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "analysis/trace/jump_points.h"

namespace stipple {

/// `Frame` has a member `region`. A frame that is none lies at the bottom, so that there is always
/// a top; no region has its number.
template <class Frame>
class FrameStack {
 public:
  explicit FrameStack(const Frame& none) : frames_(1024, none) {}

  Frame* Bottom() { return frames_.data(); }
  /// Behind this there is no room.
  Frame* Limit() { return frames_.data() + frames_.size() - 1; }
  /// Makes room; returns the top.
  Frame* Grow(Frame* top) {
    const std::ptrdiff_t depth = top - Bottom();
    frames_.resize(2 * frames_.size());
    return Bottom() + depth;
  }
  /// The innermost visit of the region, those above which were left unseen; `top` if there is none.
  Frame* Innermost(Frame* top, std::uint32_t region) {
    for (Frame* at = top; at != Bottom(); --at)
      if (at->region == region) return at;
    return top;
  }
  /// The top after a record: frames that a jump left are gone, those of a context that waits are
  /// off the stack.
  Frame* Record(Frame* top, const EventWord* record) {
    const std::uint32_t before = points_.context();
    const auto place = points_.After(record, static_cast<std::size_t>(top - Bottom()));
    if (!place) return top;
    if (place->context != before) {
      waiting_[before].assign(Bottom() + 1, top + 1);
      top = Bottom();
      if (const auto frames = waiting_.extract(place->context))
        for (const Frame& f : frames.mapped()) {
          if (top == Limit()) top = Grow(top);
          *++top = f;
        }
    }
    return Bottom() + std::min(place->depth, static_cast<std::size_t>(top - Bottom()));
  }
  /// The points of an OpenFrames record whose frames are on the stack.
  void BeginPoints(const EventWord* open_frames) { points_.Begin(open_frames); }

 private:
  std::vector<Frame> frames_;
  std::unordered_map<std::uint32_t, std::vector<Frame>> waiting_;  // by context
  JumpPoints points_;
};

}  // namespace stipple

#endif
