// SPDX-License-Identifier: MIT
// Cost of an event of a leaf function under the exact clock, against its floor: the same leaf with
// an inline rdtsc and an 8-byte store into a small ring. Rounds alternate; CPU time of the thread,
// page faults and chunk switches included. Then the same by the hooks of -finstrument-functions,
// and both while recording is switched off, against an empty leaf. Prints medians over the rounds,
// and the least, which a busy machine disturbs less.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "events.h"
#include "stipple/user.h"

extern "C" {
void __cyg_profile_func_enter(void* function, void* caller);
void __cyg_profile_func_exit(void* function, void* caller);
}

namespace {

using stipple_test::Enter;
using stipple_test::Leave;
using stipple_test::Object;

constexpr const char* kNames[] = {"leaf"};
constexpr long kRingWords = 4096;
std::uint64_t ring[kRingWords];
std::uint64_t ring_next = 0;

inline void FloorEvent(std::uint64_t token) {
  ring[ring_next++ & (kRingWords - 1)] = __builtin_ia32_rdtsc() << 24 | token;
}

__attribute__((noinline)) void FloorLeaf() {
  FloorEvent(1);
  __asm__ volatile("" ::: "memory");
  FloorEvent(1 | STIPPLE_LEAVE);
}

__attribute__((noinline)) void TracedLeaf(const Object<1>& object) {
  const std::uint32_t token = Enter(object.dso, object.descriptors[0]);
  __asm__ volatile("" ::: "memory");
  Leave(object.dso, token);
}

__attribute__((noinline)) void EmptyLeaf() { __asm__ volatile("" ::: "memory"); }

__attribute__((noinline)) void HookedLeaf() {
  __cyg_profile_func_enter(reinterpret_cast<void*>(&HookedLeaf), nullptr);
  __asm__ volatile("" ::: "memory");
  __cyg_profile_func_exit(reinterpret_cast<void*>(&HookedLeaf), nullptr);
}

double CpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

template <class Leaf>
double NsPerEvent(long calls, Leaf leaf) {
  const double start = CpuNs();
  for (long i = 0; i < calls; ++i) leaf();
  return (CpuNs() - start) / (2.0 * static_cast<double>(calls));
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  setenv("STIPPLE_CLOCK", "exact", 1);
  const long events = argc > 1 ? std::atol(argv[1]) : 100'000'000;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 21;
  const long calls = events / rounds / 2;
  const Object<1> object(kNames);
  std::vector<double> floor_ns, traced_ns, ratios, hooked_ns, empty_ns, off_ns, hooked_off_ns;
  for (int round = 0; round < rounds; ++round) {
    floor_ns.push_back(NsPerEvent(calls, FloorLeaf));
    traced_ns.push_back(NsPerEvent(calls, [&object] { TracedLeaf(object); }));
    ratios.push_back(traced_ns.back() / floor_ns.back());
    hooked_ns.push_back(NsPerEvent(calls, HookedLeaf));
    stipple_stop();
    empty_ns.push_back(NsPerEvent(calls, EmptyLeaf));
    off_ns.push_back(NsPerEvent(calls, [&object] { TracedLeaf(object); }));
    hooked_off_ns.push_back(NsPerEvent(calls, HookedLeaf));
    stipple_start();
  }
  if (argc > 3)
    for (double ns : traced_ns) std::printf("%.2f ", ns);
  std::printf("floor %.2f ns, event %.2f ns, ratio %.3f (median of %d rounds, %ld events each)\n",
              Median(floor_ns), Median(traced_ns), Median(ratios), rounds, 2 * calls);
  const auto print = [](const char* name, const std::vector<double>& ns) {
    std::printf("%-22s %6.2f ns, least %6.2f\n", name, Median(ns),
                *std::min_element(ns.begin(), ns.end()));
  };
  print("floor", floor_ns);
  print("event", traced_ns);
  print("event by hook", hooked_ns);
  print("half an empty leaf", empty_ns);
  print("event while off", off_ns);
  print("event by hook, off", hooked_off_ns);
}
