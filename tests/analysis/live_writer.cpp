// SPDX-License-Identifier: MIT
// The traced program of live_test.cpp: two threads that record known events and live until they are
// killed.
// Visit n is of region n mod 7; a counter says n every eight visits; now and then there is a new
// function, which is visited at once.
#include <unistd.h>

#include <thread>

#include "stipple/user.h"
#include "tests/runtime/events.h"

namespace {

using stipple_test::Enter;
using stipple_test::Leave;
using stipple_test::Object;

constexpr const char* kNames[] = {"r0", "r1", "r2", "r3", "r4", "r5", "r6"};
constexpr unsigned kRegions = 7;
constexpr std::uint64_t kVisitsOfCounter = 8;
constexpr std::uint64_t kVisitsOfFunction = 5000;
constexpr std::uint64_t kVisitsOfBurst = 16384;
constexpr std::uint64_t kMostVisits = std::uint64_t{1} << 21;

/// A function that nobody has seen: its line is new.
void VisitNew() {
  static const char name[] = "new";
  static std::uint32_t line = 1000;
  static stipple_descriptor descriptor;
  descriptor = {0, ++line, name - reinterpret_cast<const char*>(&descriptor.name), 0};
  stipple_dso dso{};
  dso.abi = STIPPLE_ABI;
  dso.descriptor_bytes = sizeof(stipple_descriptor);
  dso.begin = &descriptor;
  dso.end = &descriptor + 1;
  stipple_register(&dso);
  Leave(dso, Enter(dso, descriptor));
  stipple_unregister(&dso);
}

void Count(const Object<kRegions>& object, bool defines) {
  static stipple_name visits = {"visits", "", 0};
  for (std::uint64_t n = 0;; ++n) {
    Leave(object.dso, Enter(object.dso, object.descriptors[n % kRegions]));
    if (n % kVisitsOfCounter == 0) stipple_counter(&visits, static_cast<double>(n));
    if (defines && n % kVisitsOfFunction == 0) VisitNew();
    // Disks are finite: bursts of several chunks with rests between.
    if (n % kVisitsOfBurst == 0) usleep(5000);
    while (n == kMostVisits) pause();
  }
}

}  // namespace

int main() {
  static Object<kRegions> object(kNames);
  std::thread other(Count, std::cref(object), false);
  Count(object, true);
}
