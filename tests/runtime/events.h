// SPDX-License-Identifier: MIT
// What a compiler plugin would emit, by hand: descriptors, an object block, and the code of an
// event as abi.h describes it.
#ifndef STIPPLE_TESTS_RUNTIME_EVENTS_H
#define STIPPLE_TESTS_RUNTIME_EVENTS_H

#include <cstdint>

#include "stipple/abi.h"

namespace stipple_test {

/// An object with one descriptor per name.
template <int kCount>
struct Object {
  stipple_descriptor descriptors[kCount] = {};
  stipple_dso dso{};

  explicit Object(const char* const (&names)[kCount]) {
    for (int i = 0; i < kCount; ++i) {
      descriptors[i].line = static_cast<std::uint32_t>(10 * (i + 1));
      descriptors[i].name = names[i] - reinterpret_cast<const char*>(&descriptors[i].name);
      descriptors[i].file = kFile - reinterpret_cast<const char*>(&descriptors[i].file);
    }
    dso.abi = STIPPLE_ABI;
    dso.descriptor_bytes = sizeof(stipple_descriptor);
    dso.begin = descriptors;
    dso.end = descriptors + kCount;
    stipple_register(&dso);
  }
  ~Object() { stipple_unregister(&dso); }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  static constexpr const char* kFile = "by_hand.cpp";
};

/// The event itself: `token` as the word's low half; returns the token for the exits.
__attribute__((always_inline)) inline std::uint32_t Event(const stipple_dso& dso,
                                                          std::uint32_t token) {
  __asm__ volatile(
      "testl $0xff000000, %[token]\n\t"
      "jnz 1f\n\t"
      "movq %c[offset](%[dso]), %%rdx\n\t"
      "movq %%fs:(%%rdx), %%rdx\n\t"
      "movl $8, %%r11d\n\t"
      "xaddq %%r11, (%%rdx)\n\t"
      "cmpq 8(%%rdx), %%r11\n\t"
      "jae 1f\n\t"
      "movl %[token], %%ecx\n\t"
      "testq %%r11, 16(%%rdx)\n\t"
      "movl $0, %%edx\n\t"
      "jnz 3f\n\t"
      "rdtsc\n\t"
      "shlq $32, %%rdx\n\t"
      "orq %%rax, %%rdx\n\t"
      "shlq $24, %%rdx\n\t"
      "3: orq %%rcx, %%rdx\n\t"
      "movq %%rdx, (%%r11)\n\t"
      "movl %%ecx, %%eax\n\t"
      "jmp 2f\n"
      "1: movl %[token], %[token]\n\t"  // the upper half, for the address
      "testl %[counted], %[token]\n\t"
      "je 4f\n\t"
      "movq %c[offset](%[dso]), %%rdx\n\t"
      "movq %%fs:(%%rdx), %%rdx\n\t"
      "movq 24(%%rdx), %%rdx\n\t"
      "testq %%rdx, %%rdx\n\t"
      "je 4f\n\t"
      "subl $1, -0x8000000(%%rdx,%q[token],8)\n\t"
      "js 5f\n\t"
      "xorl %[token], %[token]\n\t"
      "jmp 2f\n"
      "5: addl $1, -0x8000000(%%rdx,%q[token],8)\n"
      "4: leaq 2f(%%rip), %%r11\n\t"
      "jmp *%c[slow](%[dso])\n"
      "2:"
      : [token] "+a"(token)
      : [dso] "r"(&dso), [offset] "i"(__builtin_offsetof(stipple_dso, tp_offset)),
        [slow] "i"(__builtin_offsetof(stipple_dso, slow)), [counted] "i"(STIPPLE_COUNT_ONLY)
      : "rcx", "rdx", "r11", "cc", "memory");
  return token;
}

__attribute__((always_inline)) inline std::uint32_t Enter(const stipple_dso& dso,
                                                          const stipple_descriptor& descriptor) {
  const std::uint32_t token = __atomic_load_n(&descriptor.id, __ATOMIC_RELAXED);
  return token == 0 ? 0 : Event(dso, token);
}

__attribute__((always_inline)) inline void Leave(const stipple_dso& dso, std::uint32_t token) {
  if (token != 0) Event(dso, token | STIPPLE_LEAVE);
}

/// The functions of a traced program: one that calls the second, and one more.
inline Object<3>* object = nullptr;

inline void Visit(int region) {
  const std::uint32_t token = Enter(object->dso, object->descriptors[region]);
  Leave(object->dso, token);
}

/// Four events per round.
inline void Work(long rounds) {
  for (long i = 0; i < rounds; ++i) {
    const std::uint32_t token = Enter(object->dso, object->descriptors[0]);
    Visit(1);
    Leave(object->dso, token);
  }
}

}  // namespace stipple_test

#endif
