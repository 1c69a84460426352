// SPDX-License-Identifier: MIT
// When a clock counts as set back.
#include "runtime/core/clock_step.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(ClockStep, IsABackwardTickOrARateThatDoesNotFit) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const ClockPair begin{1000, 5 * kSecond};
  const ClockPair before{1000 + 2 * kSecond, 6 * kSecond};  // two ticks a nanosecond
  const auto stepped = [&](std::uint64_t ticks, std::uint64_t raw_ns) {
    return ClockStepped(begin, before, {ticks, raw_ns});
  };
  EXPECT_FALSE(stepped(before.ticks + 2 * kSecond, 7 * kSecond));
  EXPECT_FALSE(stepped(before.ticks + 2 * kSecond + 2'000'000, 7 * kSecond));  // 1 ms off
  EXPECT_TRUE(stepped(before.ticks - 1, 7 * kSecond));
  EXPECT_TRUE(stepped(before.ticks + kSecond, 7 * kSecond));
  EXPECT_TRUE(stepped(before.ticks + 900 * kSecond, 7 * kSecond));
  // Of a process that has just begun the rate is not known.
  EXPECT_FALSE(ClockStepped(begin, {3000, 5 * kSecond + 1000}, {4 * kSecond, 7 * kSecond}));
}

}  // namespace
}  // namespace stipple
