// SPDX-License-Identifier: MIT
// What the adversity tests and their traced program agree on.
#ifndef STIPPLE_TESTS_RUNTIME_ADVERSITY_H
#define STIPPLE_TESTS_RUNTIME_ADVERSITY_H

#include <atomic>
#include <string>
#include <vector>

#include "events.h"

namespace stipple_test {

constexpr long kOnes = 61;
constexpr long kTwos = 59;

/// Names of the regions: "one 0" ..., then "two 0" ...
inline std::vector<std::string> RegionNames() {
  std::vector<std::string> names;
  for (long i = 0; i < kOnes; ++i) names.push_back("one" + std::to_string(i));
  for (long i = 0; i < kTwos; ++i) names.push_back("two" + std::to_string(i));
  return names;
}

/// An object with a descriptor for each of them.
struct Regions {
  std::vector<std::string> names = RegionNames();
  stipple_descriptor descriptors[kOnes + kTwos] = {};
  stipple_dso dso{};

  Regions() {
    static const char file[] = "adversity.cpp";
    for (std::size_t i = 0; i < names.size(); ++i) {
      stipple_descriptor& d = descriptors[i];
      d.line = static_cast<std::uint32_t>(i + 1);
      d.name = names[i].c_str() - reinterpret_cast<const char*>(&d.name);
      d.file = file - reinterpret_cast<const char*>(&d.file);
    }
    dso.abi = STIPPLE_ABI;
    dso.descriptor_bytes = sizeof(stipple_descriptor);
    dso.begin = descriptors;
    dso.end = descriptors + names.size();
    stipple_register(&dso);
  }
  Regions(const Regions&) = delete;
  Regions& operator=(const Regions&) = delete;
};

/// What a writer had done for sure when it was killed.
struct Progress {
  std::atomic<long> tid;
  std::atomic<long> visits;
  char padding[48];
};

}  // namespace stipple_test

#endif
