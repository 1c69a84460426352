// SPDX-License-Identifier: MIT
#include "runtime/core/save_area.h"

#include <cpuid.h>

#include <cstdint>

extern "C" {
/// Components for xsave; 0: the processor has only fxsave.
constinit std::uint64_t stipple_save_mask = 0;
constinit std::uint64_t stipple_save_bytes = 512 + 64;
}

namespace stipple {

void PrepareSaveArea() {
  // Not saved because nothing here touches them: the tiles (8 KiB) and the protection keys.
  constexpr std::uint64_t kTiles = std::uint64_t{3} << 17, kKeys = std::uint64_t{1} << 9;
  constexpr unsigned kOsXsave = 1u << 27;
  unsigned a = 0, b = 0, c = 0, d = 0;
  __cpuid(1, a, b, c, d);
  if ((c & kOsXsave) == 0) return;
  std::uint32_t low = 0, high = 0;
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  const std::uint64_t mask = (std::uint64_t{high} << 32 | low) & ~(kTiles | kKeys);
  std::uint64_t bytes = 512 + 64;
  for (unsigned component = 2; component < 63; ++component) {
    if ((mask >> component & 1) == 0) continue;
    __cpuid_count(0xd, component, a, b, c, d);
    if (bytes < std::uint64_t{b} + a) bytes = std::uint64_t{b} + a;
  }
  stipple_save_bytes = (bytes + 63) & ~std::uint64_t{63};
  stipple_save_mask = mask;
}

}  // namespace stipple
