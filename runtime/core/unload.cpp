// SPDX-License-Identifier: MIT
// dlclose, on its way to libc: what it unloads leaves its addresses to others. Only in the shared
// library.
#include <dlfcn.h>

#include "runtime/core/address.h"

extern "C" __attribute__((visibility("default"))) int dlclose(void* handle) noexcept {
  using Close = int(void*);
  auto* real = reinterpret_cast<Close*>(dlsym(RTLD_NEXT, "dlclose"));
  if (real == nullptr) return -1;
  stipple::BeginUnload();
  const int result = real(handle);
  stipple::EndUnload();
  return result;
}
