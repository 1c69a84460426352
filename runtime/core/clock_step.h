// SPDX-License-Identifier: MIT
// Whether a clock was set back or ran at another rate: a time-stamp counter that was reset, a
// virtual machine that moved. Looked at when a thread takes a chunk.
#ifndef STIPPLE_RUNTIME_CORE_CLOCK_STEP_H
#define STIPPLE_RUNTIME_CORE_CLOCK_STEP_H

#include <cstdint>

#include "runtime/core/clock.h"

namespace stipple {

inline constexpr std::uint64_t kSureRateNs = 10'000'000;   // a rate from less is no measure
inline constexpr std::uint64_t kLeastStepNs = 10'000'000;  // readings may be interrupted
inline constexpr std::uint64_t kStepShare = 64;            // and the rate be a little wrong

/// From `before` to `now`, the rate being that from `begin` to `before`.
inline bool ClockStepped(const ClockPair& begin, const ClockPair& before, const ClockPair& now) {
  if (now.ticks < before.ticks || now.raw_ns < before.raw_ns) return true;
  if (before.ticks <= begin.ticks || before.raw_ns - begin.raw_ns < kSureRateNs) return false;
  const double ns_per_tick = static_cast<double>(before.raw_ns - begin.raw_ns) /
                             static_cast<double>(before.ticks - begin.ticks);
  const double expected = static_cast<double>(now.ticks - before.ticks) * ns_per_tick;
  const double seen = static_cast<double>(now.raw_ns - before.raw_ns);
  const double difference = expected < seen ? seen - expected : expected - seen;
  return difference > static_cast<double>(kLeastStepNs) + seen / static_cast<double>(kStepShare);
}

}  // namespace stipple

#endif
