// SPDX-License-Identifier: MIT
// What an event costs. Each kernel is here as shared objects of several variants (kernel.h), loaded
// side by side; the runner lets them take turns every half millisecond, so that whatever else the
// machine does hits all alike, and compares round by round. The recorder is a ring of 64 KB: this
// measures the code in the program, not the writing of archives (recording.cpp does).
//
//   bench_events [ROUNDS] [KERNEL...]
#include <x86intrin.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "stipple/abi.h"
#include "tests/bench/events/variant.h"

namespace {

constexpr std::uint64_t kRingWords = 8192;
constexpr std::uint64_t kCalls = 12000;

alignas(65536) std::uint64_t ring[kRingWords];
std::uint64_t rings_filled = 0;
bool recording = false;  // what stipple_register answers
std::uint64_t clock_mask = 0;
stipple_control ring_control{};
__thread stipple_control* control __attribute__((tls_model("initial-exec"))) = &ring_control;

using stipple_bench::Kernel;
using stipple_bench::Quantile;

struct Variant {
  std::string name;
  Kernel kernel;
  std::vector<double> ns;  // per call, one of each round
};

}  // namespace

// Called by slow_path.S when the ring is full: begin again at its start.
extern "C" __attribute__((visibility("hidden"))) std::uint32_t test_slow_event(
    std::uint32_t token) {
  if (ring_control.end != 0) ++rings_filled;
  ring_control.cur = reinterpret_cast<std::uint64_t>(ring);
  ring_control.end = ring_control.cur + sizeof(ring);
  ring_control.clock_mask = clock_mask;
  *reinterpret_cast<std::uint64_t*>(ring_control.cur) = (__rdtsc() << 24) | token;
  ring_control.cur += 8;
  return token & ~std::uint32_t{STIPPLE_LEAVE};
}

extern "C" void test_slow_path();

extern "C" __attribute__((visibility("default"))) void stipple_register(stipple_dso* dso) {
  if (!recording) return;
  dso->slow = test_slow_path;
  dso->tp_offset =
      reinterpret_cast<char*>(&control) - static_cast<char*>(__builtin_thread_pointer());
  std::uint32_t id = 1;
  for (stipple_descriptor* d = dso->begin; d != dso->end; ++d) d->id = id++;
}
extern "C" __attribute__((visibility("default"))) void stipple_unregister(stipple_dso*) {}

namespace {

Kernel Load(const std::string& file, bool record, std::uint64_t mask) {
  recording = record;
  clock_mask = mask;
  return stipple_bench::LoadKernel(file);
}

double NsPerCall(Kernel kernel) {
  [[maybe_unused]] static volatile std::uint64_t sink;
  const auto start = std::chrono::steady_clock::now();
  sink = kernel(kCalls);
  const std::chrono::duration<double, std::nano> span = std::chrono::steady_clock::now() - start;
  return span.count() / double(kCalls);
}

std::uint64_t EventsSoFar() {
  if (ring_control.end == 0) return 0;
  return rings_filled * kRingWords + (ring_control.cur - reinterpret_cast<std::uint64_t>(ring)) / 8;
}

double EventsPerCall(Kernel recorded) {
  recorded(kCalls);
  const std::uint64_t before = EventsSoFar();
  recorded(kCalls);
  return double(EventsSoFar() - before) / double(kCalls);
}

void Measure(const std::string& kernel, const std::string& compiler, int rounds) {
  const std::string start = BENCH_EVENTS_DIR "/" + kernel + "_" + compiler + "_";
  Variant variants[] = {{"plain", Load(start + "plain.so", false, 0), {}},
                        {"off", Load(start + "off.so", false, 0), {}},
                        {"floor", Load(start + "floor.so", false, 0), {}},
                        {"exact", Load(start + "exact.so", true, 0), {}}};
  const double events = EventsPerCall(variants[3].kernel);
  for (int round = 0; round < rounds; ++round)
    for (Variant& v : variants) v.ns.push_back(NsPerCall(v.kernel));

  for (const Variant& v : variants) {
    std::vector<double> over_plain, to_floor;  // round by round
    for (std::size_t i = 0; i < v.ns.size(); ++i) {
      over_plain.push_back((v.ns[i] - variants[0].ns[i]) / events);
      to_floor.push_back(v.ns[i] / variants[2].ns[i]);
    }
    std::printf("%-5s %-6s %-6s %8.2f  %7.2f..%-7.2f %8.2f %10.2f %8.3f\n", kernel.c_str(),
                compiler.c_str(), v.name.c_str(), Quantile(v.ns, 0.5), Quantile(v.ns, 0.1),
                Quantile(v.ns, 0.9), Quantile(v.ns, 0.0), Quantile(over_plain, 0.5),
                Quantile(to_floor, 0.5));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 401;
  std::vector<std::string> kernels(argv + std::min(argc, 2), argv + argc);
  if (kernels.empty()) kernels = {"leaf", "fib", "mix"};
  std::printf("%-5s %-6s %-6s %8s  %16s %8s %10s %8s\n", "", "", "", "median", "10%..90%", "least",
              "per event", "to floor");
  for (const std::string& kernel : kernels)
    for (const char* compiler : {"gcc", "llvm"}) Measure(kernel, compiler, rounds);
  std::printf("ns per call; per event: over plain; rounds: %d\n", rounds);
}
