// SPDX-License-Identifier: MIT
// What a visit costs under a budget: the kernels of ../events, each in a process of its own with
// the real runtime. First they run until nothing changes any more; then they run in turns with all
// slots 0 (recording stopped), with the slots as the budget left them, and with all counted and
// none sampled.
//
//   bench_budget ARCHIVE_DIRECTORY [ROUNDS]
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "stipple/abi.h"
#include "tests/bench/events/variant.h"

namespace {

constexpr std::uint64_t kCalls = 20'000;  // a turn: one or two milliseconds
std::vector<stipple_descriptor*> descriptors;
const stipple_dso* object = nullptr;

double CpuNs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * double(now.tv_sec) + double(now.tv_nsec);
}

double NsPerCall(stipple_bench::Kernel kernel, std::uint64_t calls) {
  [[maybe_unused]] static volatile std::uint64_t sink;
  const double start = CpuNs();
  sink = kernel(calls);
  return (CpuNs() - start) / double(calls);
}

template <class Token>
void SetSlots(Token token) {
  for (stipple_descriptor* d : descriptors) __atomic_store_n(&d->id, token(*d), __ATOMIC_RELAXED);
}

std::vector<std::uint32_t> Slots() {
  std::vector<std::uint32_t> slots;
  for (const stipple_descriptor* d : descriptors) slots.push_back(d->id);
  return slots;
}

/// This thread's words of counts and samples (runtime/core/sample.h), one for each function.
std::vector<std::uint64_t*> Words() {
  std::uint64_t thread_pointer = 0;
  __asm__("movq %%fs:0, %0" : "=r"(thread_pointer));
  const auto* control = *reinterpret_cast<stipple_control**>(
      thread_pointer + static_cast<std::uint64_t>(object->tp_offset));
  std::vector<std::uint64_t*> words;
  for (const stipple_descriptor* d : descriptors)
    words.push_back(control->counts + (d->id & STIPPLE_REGION_MASK));
  return words;
}

/// Counting alone: no sample is ever due.
double NsCounted(stipple_bench::Kernel kernel) {
  std::vector<std::uint64_t> before;
  const auto words = Words();
  for (std::uint64_t* word : words) {
    before.push_back(*word);
    *word = 0x7fffffff7fffffff;
  }
  const double ns = NsPerCall(kernel, kCalls);
  for (std::size_t i = 0; i < words.size(); ++i) *words[i] = before[i];
  return ns;
}

/// Until half a second has passed without a step; the seconds before.
double Settle(stipple_bench::Kernel kernel) {
  double since = 0, all = 0;
  for (auto before = Slots(); since < 0.5e9;) {
    const double start = CpuNs();
    NsPerCall(kernel, kCalls);
    since += CpuNs() - start;
    all += CpuNs() - start;
    if (auto now = Slots(); now != before) {
      before = now;
      since = 0;
    }
  }
  return (all - since) * 1e-9;
}

void Measure(const std::string& name, int rounds) {
  const auto kernel = stipple_bench::LoadKernel(BENCH_EVENTS_DIR "/" + name + "_exact.so");
  const double settled_s = Settle(kernel);
  const auto left = Slots();
  std::vector<double> stopped, budget, counted, more, beyond;
  for (int round = 0; round < rounds; ++round) {
    SetSlots([](const auto&) { return 0u; });
    stopped.push_back(NsPerCall(kernel, kCalls));
    std::size_t i = 0;
    SetSlots([&](const auto&) { return left[i++]; });
    budget.push_back(NsPerCall(kernel, kCalls));
    i = 0;
    SetSlots([&](const auto&) { return (left[i++] & STIPPLE_REGION_MASK) | STIPPLE_COUNT_ONLY; });
    counted.push_back(NsCounted(kernel));
    more.push_back(100 * (budget.back() / stopped.back() - 1));
    beyond.push_back((budget.back() - counted.back()) / 2);
  }
  using stipple_bench::Quantile;
  std::printf("%-9s %8.2f %8.2f %8.2f %8.1f  %6.1f..%-6.1f %8.2f  %6.2f..%-6.2f %8.1f %8.2f\n",
              name.c_str(), Quantile(stopped, 0.5), Quantile(budget, 0.5), Quantile(counted, 0.5),
              Quantile(more, 0.5), Quantile(more, 0.1), Quantile(more, 0.9), Quantile(beyond, 0.5),
              Quantile(beyond, 0.1), Quantile(beyond, 0.9),
              100 * (Quantile(budget, 0) / Quantile(stopped, 0) - 1), settled_s);
  std::fflush(stdout);
}

}  // namespace

/// Before the runtime's own: to know the slots.
extern "C" __attribute__((visibility("default"))) void stipple_register(stipple_dso* dso) {
  using Register = void(stipple_dso*);
  static auto* real = reinterpret_cast<Register*>(dlsym(RTLD_NEXT, "stipple_register"));
  real(dso);
  object = dso;
  for (stipple_descriptor* d = dso->begin; d < dso->end; ++d) descriptors.push_back(d);
}

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_budget ARCHIVE_DIRECTORY [ROUNDS]\n");
    return 2;
  }
  setenv("STIPPLE_ARCHIVE", argv[1], 1);
  setenv("STIPPLE_CLOCK", "budget:5", 1);
  std::printf("%-9s %8s %8s %8s %8s  %14s %8s  %14s %8s %8s\n", "", "stopped", "budget", "counted",
              "more %", "10%..90%", "beyond", "10%..90%", "least %", "settled");
  for (const char* kernel : {"leaf", "fib", "mix"})
    for (const char* compiler : {"gcc", "llvm"}) {
      std::fflush(stdout);
      const pid_t child = fork();
      if (child == 0) {
        Measure(std::string(kernel) + "_" + compiler, argc > 2 ? std::atoi(argv[2]) : 301);
        std::_Exit(0);
      }
      int status = -1;
      if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return 1;
    }
  std::printf(
      "ns of CPU time per visit, the function's own work included: recording stopped, under "
      "budget:5, all counted and none sampled;\nmore: budget to stopped, round by round; beyond: "
      "budget less "
      "counted, ns per event; least: of the least of each;\nsettled: seconds until no slot changed "
      "any more\n");
}
