// SPDX-License-Identifier: MIT
// A variant of a kernel (kernel.h), loaded from its shared object, and its times.
#ifndef STIPPLE_TESTS_BENCH_EVENTS_VARIANT_H
#define STIPPLE_TESTS_BENCH_EVENTS_VARIANT_H

#include <dlfcn.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace stipple_bench {

using Kernel = std::uint64_t (*)(std::uint64_t);

/// The kernel of a shared object; ends the program if there is none.
inline Kernel LoadKernel(const std::string& file) {
  void* object = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* kernel = object == nullptr ? nullptr : dlsym(object, "kernel_run");
  if (kernel == nullptr) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), dlerror());
    std::exit(2);
  }
  return reinterpret_cast<Kernel>(kernel);
}

inline double Quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace stipple_bench

#endif
