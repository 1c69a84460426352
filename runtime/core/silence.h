// SPDX-License-Identifier: MIT
// Silent threads. An event holds 40 bits of its time: after a silence of more than 2^40 ticks (220 s
// at 5 GHz, 520 s at 2.1 GHz) it would be taken for an earlier one, so a TimeStamp goes before it.
//
// The event itself cannot know, it is written inline. Two things make it take the slow path:
//   1. A thread that records seldom *steps*: each of its events takes the slow path. A thread begins so
//      and goes on so until it has recorded 32 events quickly, and again after a chunk that took long.
//   2. A watch sets `control.end` of threads that recorded nothing between two of its rounds to 0. It
//      is a thread of its own, begun by the first slow path in a process older than 100 s: short
//      programs, and what they ask about their threads, never meet it.
// Left out is a process whose threads all fall silent before that age, one of them in quick succession.
#ifndef STIPPLE_RUNTIME_CORE_SILENCE_H
#define STIPPLE_RUNTIME_CORE_SILENCE_H

#include <cstdint>

#include "runtime/core/stream.h"
#include "stipple/format.h"

namespace stipple {

inline constexpr std::uint32_t kStepEvents = 32;
inline constexpr std::uint64_t kQuickTicks = std::uint64_t{1} << 26;   // 32 events in less: quick
inline constexpr std::uint64_t kSlowTicks = std::uint64_t{1} << 31;    // a chunk in more: slow
inline constexpr std::uint64_t kSilentTicks = std::uint64_t{1} << 36;  // wants a TimeStamp

/// From now on every event of the thread, which has just got a chunk, takes the slow path.
void BeginStepping(Thread& thread, std::uint64_t ticks);

/// A place for `bytes` in the chunk of a stepping thread, behind a TimeStamp if it was silent for long
/// and they are a function event; null if the chunk is full. It steps no longer then, or when it has
/// become quick. Signals are blocked.
EventWord* Step(Thread& thread, std::uint64_t bytes, std::uint64_t ticks);

/// The place for `bytes` whose reservation failed only because the watch wanted it to, behind a
/// TimeStamp; null if that was not the reason. Signals are blocked.
EventWord* TakeForced(Thread& thread, std::uint64_t bytes, std::uint64_t ticks);

/// One round of the watch: threads silent since the last one take the slow path next.
void WatchRound(Process& process);

/// Begins the watch if the process is old enough and has none. Signals are blocked.
void WatchSilence(Process& process, std::uint64_t ticks);

}  // namespace stipple

#endif
