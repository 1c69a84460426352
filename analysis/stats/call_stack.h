// SPDX-License-Identifier: MIT
// The regions that are open on a location. Leaves that never came (longjmp, a lost event) are made
// up for at the next leave of a region below; a leave whose region is not open is refused.
#ifndef STIPPLE_ANALYSIS_STATS_CALL_STACK_H
#define STIPPLE_ANALYSIS_STATS_CALL_STACK_H

#include <cstdint>
#include <vector>

namespace stipple {

class CallStack {
 public:
  explicit CallStack(std::uint32_t region_count) : open_(region_count) {}

  void Enter(std::uint32_t region) {
    stack_.push_back(region);
    ++open_[region];
  }
  /// Calls `closed(region)` for each frame that ends, innermost first; false: not open.
  template <class Closed>
  bool Leave(std::uint32_t region, Closed&& closed) {
    if (open_[region] == 0) return false;
    for (;;) {
      const std::uint32_t top = stack_.back();
      stack_.pop_back();
      --open_[top];
      closed(top);
      if (top == region) return true;
    }
  }
  bool empty() const { return stack_.empty(); }
  std::uint32_t top() const { return stack_.back(); }
  std::uint32_t OpenCount(std::uint32_t region) const { return open_[region]; }
  std::size_t depth() const { return stack_.size(); }

 private:
  std::vector<std::uint32_t> stack_;
  std::vector<std::uint32_t> open_;  // by region: how often it is on the stack
};

}  // namespace stipple

#endif
