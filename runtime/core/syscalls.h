// SPDX-License-Identifier: MIT
// System calls made directly: no errno, no cancellation point, no symbol that a program, a
// sanitizer or another preloaded library could have replaced. Each returns a value, or -errno.
#ifndef STIPPLE_RUNTIME_CORE_SYSCALLS_H
#define STIPPLE_RUNTIME_CORE_SYSCALLS_H

#include <sys/syscall.h>

#include <cstddef>
#include <cstdint>

namespace stipple {

// NOLINTNEXTLINE(readability-function-size): a call of the kernel has six arguments.
inline long Syscall(long number, long a = 0, long b = 0, long c = 0, long d = 0, long e = 0,
                    long f = 0) {
  long result;
  register long r10 __asm__("r10") = d;
  register long r8 __asm__("r8") = e;
  register long r9 __asm__("r9") = f;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
                   : "rcx", "r11", "memory");
  return result;
}

template <class T>
long Argument(T* pointer) {
  return reinterpret_cast<long>(pointer);
}

/// Whether a result of mmap is an error.
inline bool IsError(long result) { return result < 0 && result >= -4095; }

inline std::uint32_t GetPid() { return static_cast<std::uint32_t>(Syscall(SYS_getpid)); }
inline std::uint32_t GetTid() { return static_cast<std::uint32_t>(Syscall(SYS_gettid)); }

/// Private zeroed memory, or null.
inline void* MapMemory(std::size_t bytes) {
  constexpr long kReadWrite = 3, kPrivateAnonymousNoReserve = 0x02 | 0x20 | 0x4000;
  const long result =
      Syscall(SYS_mmap, 0, static_cast<long>(bytes), kReadWrite, kPrivateAnonymousNoReserve, -1, 0);
  return IsError(result) ? nullptr : reinterpret_cast<void*>(result);
}

/// Private memory that is zero again in a forked child, or null.
inline void* MapWipedMemory(std::size_t bytes) {
  constexpr long kWipeOnFork = 18;
  void* memory = MapMemory(bytes);
  if (memory == nullptr) return nullptr;
  if (Syscall(SYS_madvise, Argument(memory), static_cast<long>(bytes), kWipeOnFork) == 0)
    return memory;
  Syscall(SYS_munmap, Argument(memory), static_cast<long>(bytes));
  return nullptr;
}

/// Copies without calling out: the program's memcpy may be a sanitizer's.
inline void CopyBytes(void* to, const void* from, std::size_t bytes) {
  __asm__ volatile("rep movsb" : "+D"(to), "+S"(from), "+c"(bytes) : : "memory");
}

inline std::size_t TextBytes(const char* text) {
  std::size_t bytes = 0;
  if (text != nullptr)
    while (text[bytes] != '\0') ++bytes;
  return bytes;
}

}  // namespace stipple

#endif
