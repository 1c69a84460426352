// SPDX-License-Identifier: MIT
// The archive's clock: on real machines the time-stamp counter and what relates it to nanoseconds,
// in a simulation the simulator's.
#ifndef STIPPLE_RUNTIME_CORE_CLOCK_H
#define STIPPLE_RUNTIME_CORE_CLOCK_H

#include <cpuid.h>
#include <time.h>

#include <cstdint>

#include "runtime/core/flavour.h"
#include "runtime/core/simulator.h"
#include "runtime/core/syscalls.h"
#include "stipple/format.h"

namespace stipple {

#ifdef STIPPLE_SIMULATED
inline constexpr ClockKind kClockKind = ClockKind::kVirtual;
inline std::uint64_t ReadTicks() { return SimulatedTicks(); }
#else
inline constexpr ClockKind kClockKind = ClockKind::kTsc;
inline std::uint64_t ReadTicks() { return __builtin_ia32_rdtsc(); }
#endif

inline std::uint64_t ReadClockNs(clockid_t clock) {
  if constexpr (kSimulated)
    if (clock == CLOCK_MONOTONIC_RAW) return ReadTicks();
  timespec now{};
  // Not the vDSO's: its address would have to be looked up, and this is never on a fast path.
  Syscall(SYS_clock_gettime, clock, Argument(&now));
  return static_cast<std::uint64_t>(now.tv_sec) * 1000000000u +
         static_cast<std::uint64_t>(now.tv_nsec);
}

/// One moment on both clocks.
struct ClockPair {
  std::uint64_t ticks;
  std::uint64_t raw_ns;
};

/// Reads both clocks close together: the counter before and after, and the middle of them. An
/// interruption in between is seen by its length and the reading done again.
inline ClockPair ReadClockPair() {
  constexpr std::uint64_t kFewTicks = 2000;
  ClockPair best{};
  std::uint64_t best_length = ~std::uint64_t{0};
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::uint64_t before = ReadTicks();
    const std::uint64_t raw_ns = ReadClockNs(CLOCK_MONOTONIC_RAW);
    const std::uint64_t length = ReadTicks() - before;
    if (length < best_length) {
      best = {before + length / 2, raw_ns};
      best_length = length;
    }
    if (length < kFewTicks) break;
  }
  return best;
}

/// Ticks per second as the processor or the hypervisor states it; 0: unknown.
inline std::uint64_t StatedTicksPerSecond() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid_max(0, nullptr) >= 0x15) {
    __cpuid_count(0x15, 0, a, b, c, d);
    if (a != 0 && b != 0 && c != 0) return std::uint64_t{c} * b / a;
  }
  __cpuid(1, a, b, c, d);
  const bool hypervisor = (c >> 31) != 0;
  if (!hypervisor) return 0;
  __cpuid(0x40000000, a, b, c, d);
  if (a < 0x40000010) return 0;
  __cpuid(0x40000010, a, b, c, d);
  return std::uint64_t{a} * 1000;
}

}  // namespace stipple

#endif
