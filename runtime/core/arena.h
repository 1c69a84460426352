// SPDX-License-Identifier: MIT
// Memory that is never given back, for names: malloc is the program's. Survives a fork at any
// moment: at worst the child has lost a few bytes of it.
#ifndef STIPPLE_RUNTIME_CORE_ARENA_H
#define STIPPLE_RUNTIME_CORE_ARENA_H

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/core/syscalls.h"

namespace stipple {

class Arena {
 public:
  /// `bytes` of zeroed memory, aligned to 8, or null. The process's lock is held.
  void* Take(std::size_t bytes) {
    bytes = (bytes + 7) & ~std::size_t{7};
    if (next_ + bytes > end_) {
      const std::size_t block = bytes > kBlockBytes ? bytes : kBlockBytes;
      char* memory = static_cast<char*>(MapMemory(block));
      if (memory == nullptr) return nullptr;
      end_ = next_ = 0;
      std::atomic_signal_fence(std::memory_order_seq_cst);
      next_ = reinterpret_cast<std::uintptr_t>(memory);
      std::atomic_signal_fence(std::memory_order_seq_cst);
      end_ = next_ + block;
    }
    const std::uintptr_t taken = next_;
    next_ += bytes;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    return reinterpret_cast<void*>(taken);
  }

  /// A copy of the text, ended by a zero byte, or null.
  const char* Copy(const char* text, std::size_t bytes) {
    char* copy = static_cast<char*>(Take(bytes + 1));
    if (copy != nullptr) CopyBytes(copy, text, bytes);
    return copy;
  }

 private:
  static constexpr std::size_t kBlockBytes = 256 * 1024;
  std::uintptr_t next_ = 0;
  std::uintptr_t end_ = 0;
};

}  // namespace stipple

#endif
