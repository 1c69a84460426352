// SPDX-License-Identifier: MIT
#include "analysis/trace/call_stack.h"

#include <utility>

namespace stipple {

std::span<const std::uint32_t> CallStack::Function(std::uint32_t region, bool leave) {
  left_.clear();
  if (!leave) {
    Push(region);
  } else if (region < open_.size() && open_[region] != 0) {
    while (top() != region) {
      left_.push_back(top());
      Pop();
    }
    Pop();
  }
  return left_;
}

std::span<const std::uint32_t> CallStack::Record(const EventWord* record) {
  left_.clear();
  const std::uint32_t before = context();
  const std::optional<StackPlace> place = points_.After(record, depth());
  if (!place) return left_;
  if (place->context != before) {
    waiting_[before] = std::exchange(frames_, {});
    for (const std::uint32_t region : waiting_[before]) --open_[region];
    if (auto frames = waiting_.extract(place->context))
      for (const std::uint32_t region : frames.mapped()) Push(region);
  }
  while (depth() > place->depth) {
    left_.push_back(top());
    Pop();
  }
  return left_;
}

void CallStack::Begin(const EventWord* open_frames, std::span<const std::uint32_t> regions) {
  Begin(regions);
  points_.Begin(open_frames);
}

void CallStack::Begin(std::span<const std::uint32_t> regions) {
  for (const std::uint32_t region : regions) Push(region);
}

void CallStack::Push(std::uint32_t region) {
  if (region >= open_.size()) open_.resize(region + 1);
  frames_.push_back(region);
  ++open_[region];
}

void CallStack::Pop() {
  --open_[top()];
  frames_.pop_back();
}

}  // namespace stipple
