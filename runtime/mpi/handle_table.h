// SPDX-License-Identifier: MIT
// What the layer knows about an MPI handle (request, message, communicator), by the handle's bits.
//
// Open addressing with linear probing and backward-shift deletion, at most half full, in pages of
// its own. Handles are reused by MPI as soon as they are freed, so Put replaces. The lock is a spin
// lock, is taken only with MPI_THREAD_MULTIPLE, and is never held across a call of MPI.
#ifndef STIPPLE_RUNTIME_MPI_HANDLE_TABLE_H
#define STIPPLE_RUNTIME_MPI_HANDLE_TABLE_H

#include <sched.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/mpi/pages.h"

namespace stipple::mpi {

/// True once MPI_Init_thread granted MPI_THREAD_MULTIPLE: below that no two threads are in MPI at a
/// time.
extern constinit bool threads_may_race;

/// Mutual exclusion where threads may race, nothing where they cannot.
class RaceLock {
 public:
  explicit RaceLock(std::atomic<bool>& taken) : taken_(threads_may_race ? &taken : nullptr) {
    if (taken_ == nullptr) return;
    for (int spins = 0; taken_->exchange(true, std::memory_order_acquire); ++spins) {
      if (spins % 128 == 127) {
        sched_yield();
      } else {
        __builtin_ia32_pause();
      }
    }
  }
  ~RaceLock() {
    if (taken_ != nullptr) taken_->store(false, std::memory_order_release);
  }
  RaceLock(const RaceLock&) = delete;
  RaceLock& operator=(const RaceLock&) = delete;

 private:
  std::atomic<bool>* taken_;
};

/// Value: trivially copyable. Keys are never 0.
template <class Value>
class HandleTable {
 public:
  constexpr HandleTable() = default;

  /// Replaces what the key had. Dropped if there is no memory.
  void Put(std::uint64_t key, const Value& value) {
    RaceLock lock(taken_);
    if (used_ * 2 >= capacity_ && !Grow()) return;
    Slot& slot = slots_[Find(key)];
    if (slot.key == 0) ++used_;
    slot.key = key;
    slot.value = value;
  }

  /// Copies the key's value; false if it has none.
  bool Get(std::uint64_t key, Value* value) {
    RaceLock lock(taken_);
    if (used_ == 0) return false;
    const Slot& slot = slots_[Find(key)];
    if (slot.key == 0) return false;
    *value = slot.value;
    return true;
  }

  /// Calls change(value&) in place; false if the key has none.
  template <class Change>
  bool Update(std::uint64_t key, const Change& change) {
    RaceLock lock(taken_);
    if (used_ == 0) return false;
    Slot& slot = slots_[Find(key)];
    if (slot.key == 0) return false;
    change(slot.value);
    return true;
  }

  /// Removes the key's value if remove(value) says so.
  template <class Predicate>
  void RemoveIf(std::uint64_t key, const Predicate& remove) {
    RaceLock lock(taken_);
    if (used_ == 0) return;
    const std::size_t index = Find(key);
    if (slots_[index].key != 0 && remove(slots_[index].value)) Erase(index);
  }

 private:
  struct Slot {
    std::uint64_t key;  // 0: free
    Value value;
  };
  static constexpr std::size_t kFirstCapacity = 256;

  std::size_t Home(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> 32) & (capacity_ - 1);
  }

  /// Index of the key, or of the free slot where it would go.
  std::size_t Find(std::uint64_t key) const {
    std::size_t index = Home(key);
    while (slots_[index].key != 0 && slots_[index].key != key) {
      index = (index + 1) & (capacity_ - 1);
    }
    return index;
  }

  // Moves later slots of the run back so that no probe meets a gap before its key.
  void Erase(std::size_t hole) {
    --used_;
    for (std::size_t next = (hole + 1) & (capacity_ - 1); slots_[next].key != 0;
         next = (next + 1) & (capacity_ - 1)) {
      const std::size_t home = Home(slots_[next].key);
      const std::size_t distance = (next - home) & (capacity_ - 1);
      if (distance >= ((next - hole) & (capacity_ - 1))) {
        slots_[hole] = slots_[next];
        hole = next;
      }
    }
    slots_[hole].key = 0;
  }

  bool Grow() {
    const std::size_t old_capacity = capacity_;
    Slot* const old_slots = slots_;
    const std::size_t capacity = old_capacity == 0 ? kFirstCapacity : 2 * old_capacity;
    auto* slots = static_cast<Slot*>(TakePages(capacity * sizeof(Slot)));
    if (slots == nullptr) return used_ + 1 < capacity_;  // one slot stays free, or probes never end
    slots_ = slots;
    capacity_ = capacity;
    for (std::size_t i = 0; i < old_capacity; ++i) {
      if (old_slots[i].key != 0) slots_[Find(old_slots[i].key)] = old_slots[i];
    }
    GivePages(old_slots, old_capacity * sizeof(Slot));
    return true;
  }

  Slot* slots_ = nullptr;
  std::size_t capacity_ = 0;
  std::size_t used_ = 0;
  std::atomic<bool> taken_{false};
};

}  // namespace stipple::mpi

#endif
