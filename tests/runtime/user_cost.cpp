// SPDX-License-Identifier: MIT
// What the calls of user.h cost, in nanoseconds of the thread's CPU time: medians of rounds that
// alternate. By itself without a runtime, under `stipple run` recorded.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "stipple/user.h"

namespace {

STIPPLE_REGION(region, "region");
stipple_name name = {"name", "unit", 0};
stipple_channel channel = {"channel", 0};

struct Row {
  const char* what;
  void (*call)();
};
constexpr Row kRows[] = {
    {"empty loop", [] {}},
    {"region, begin and end", [] { const stipple::Scope scope(region); }},
    {"mark", [] { stipple_mark(&name); }},
    {"counter", [] { stipple_counter(&name, 1); }},
    {"send", [] { stipple_send(&channel, 1, 8); }},
    {"receive", [] { stipple_receive(&channel, 1, 8, 0); }},
    {"name made at run time", [] { static_cast<void>(stipple_make_name("made", "")); }},
};

double CpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  const long calls = argc > 1 ? std::atol(argv[1]) : 100'000;
  constexpr int kRounds = 21;
  std::vector<double> ns[std::size(kRows)];
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t r = 0; r < std::size(kRows); ++r) {
      const double start = CpuNs();
      for (long i = 0; i < calls; ++i) {
        kRows[r].call();
        __asm__ volatile("" ::: "memory");
      }
      ns[r].push_back((CpuNs() - start) / static_cast<double>(calls));
    }
  for (std::size_t r = 0; r < std::size(kRows); ++r) {
    std::sort(ns[r].begin(), ns[r].end());
    std::printf("%-22s %7.2f ns\n", kRows[r].what, ns[r][kRounds / 2]);
  }
}
