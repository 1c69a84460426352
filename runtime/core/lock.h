// SPDX-License-Identifier: MIT
// The one lock of a process and the rules that keep it from dead-locking.
//
// It is only ever held with all signals blocked, so no handler of the same thread can want it. It
// lies in memory that a forked child finds zeroed, so a child never inherits it locked. What it
// guards outside of such memory (names, regions) is published by single stores in an order that is
// sound at any point, since fork may photograph it half way.
#ifndef STIPPLE_RUNTIME_CORE_LOCK_H
#define STIPPLE_RUNTIME_CORE_LOCK_H

#include <atomic>
#include <cstdint>

#include "runtime/core/flavour.h"
#include "runtime/core/syscalls.h"

namespace stipple {

/// Keeps every signal, libc's own included, away from this thread. SIGSYS is left as it is: the
/// kernel kills a process that has it blocked when Syscall User Dispatch raises it.
class SignalBlock {
 public:
  SignalBlock() {
    if constexpr (!kSimulated) Change(kBlock, ~(std::uint64_t{1} << (kSigSys - 1)), &before_);
  }
  ~SignalBlock() {
    if constexpr (!kSimulated) Change(kSetMask, before_, nullptr);
  }
  SignalBlock(const SignalBlock&) = delete;
  SignalBlock& operator=(const SignalBlock&) = delete;

 private:
  static constexpr long kBlock = 0, kSetMask = 2;
  static constexpr int kSigSys = 31;
  static void Change(long how, std::uint64_t mask, std::uint64_t* before) {
    Syscall(SYS_rt_sigprocmask, how, Argument(&mask), Argument(before), sizeof mask);
  }
  std::uint64_t before_ = 0;
};

/// Zero is unlocked. 1: locked; 2: locked and somebody may sleep.
/// Source: Drepper, "Futexes Are Tricky", 2011, mutex 2.
class Lock {
 public:
  void Take() {
    std::uint32_t seen = 0;
    if (word_.compare_exchange_strong(seen, 1, std::memory_order_acquire)) return;
    while (word_.exchange(2, std::memory_order_acquire) != 0)
      Syscall(SYS_futex, Argument(&word_), kWaitPrivate, 2);
  }
  void Release() {
    if (word_.exchange(0, std::memory_order_release) == 2)
      Syscall(SYS_futex, Argument(&word_), kWakePrivate, 1);
  }

 private:
  static constexpr long kWaitPrivate = 128, kWakePrivate = 129;
  std::atomic<std::uint32_t> word_;
};

/// Holds a lock; signals must be blocked.
class Holding {
 public:
  explicit Holding(Lock& lock) : lock_(lock) { lock_.Take(); }
  ~Holding() { lock_.Release(); }
  Holding(const Holding&) = delete;
  Holding& operator=(const Holding&) = delete;

 private:
  Lock& lock_;
};

}  // namespace stipple

#endif
