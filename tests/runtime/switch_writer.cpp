// SPDX-License-Identifier: MIT
// The traced program of switch_test.cpp: `switch_writer BEHAVIOUR NUMBER`. One table row each.
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

#include "events.h"
#include "runtime/core/recorder.h"
#include "stipple/user.h"

extern "C" {
void __cyg_profile_func_enter(void* function, void* caller);
void __cyg_profile_func_exit(void* function, void* caller);
}

namespace {

using stipple_test::Enter;
using stipple_test::Leave;
using stipple_test::object;
using stipple_test::Object;
using stipple_test::Visit;
using stipple_test::Work;

constexpr const char* kNames[] = {"outer", "inner", "_ZN6solver4stepEi"};

/// What -finstrument-functions makes of two functions of which one calls the other: four events.
__attribute__((noinline)) void Inner() {
  __cyg_profile_func_enter(reinterpret_cast<void*>(&Inner), nullptr);
  __cyg_profile_func_exit(reinterpret_cast<void*>(&Inner), nullptr);
}
__attribute__((noinline)) void Outer() {
  __cyg_profile_func_enter(reinterpret_cast<void*>(&Outer), nullptr);
  Inner();
  __cyg_profile_func_exit(reinterpret_cast<void*>(&Outer), nullptr);
}

std::uint32_t ManualRegion() { return stipple_define_region("MPI_Send", "", 0, 2); }

/// Switches `switches` times while three threads run through events of each kind. The threads go on
/// until the last switch, which is on, and make a few rounds more.
int Storm(long switches) {
  std::atomic<bool> done{false};
  const std::uint32_t manual = ManualRegion();
  std::vector<std::thread> threads;
  const auto until_done = [&done, &threads](auto round) {
    threads.emplace_back([&done, round] {
      while (!done) round();
      for (int i = 0; i < 10; ++i) round();
    });
  };
  until_done([] { Work(1); });
  until_done(Outer);
  until_done([manual] {
    stipple_enter(manual);
    stipple_enter(manual);
    stipple_leave(manual);
    stipple_leave(manual);
  });
  for (long i = 0; i < switches; ++i) {
    i % 2 == 0 ? stipple_stop() : stipple_start();
    if (i % 100 == 0) sched_yield();
  }
  stipple_start();
  done = true;
  for (std::thread& thread : threads) thread.join();
  return 0;
}

/// Two rounds of each kind are recorded, `rounds` are not; visits open at a switch end.
int Off(long rounds) {
  static stipple_name mark = {"mark", "", 0};
  const std::uint32_t manual = ManualRegion();
  const auto all = [manual] {
    Work(1);
    Outer();
    stipple_mark(&mark);
    stipple_enter(manual);
    stipple_leave(manual);
  };
  all();
  const std::uint32_t token = Enter(object->dso, object->descriptors[0]);
  __cyg_profile_func_enter(reinterpret_cast<void*>(&Outer), nullptr);
  stipple_enter(manual);
  stipple_stop();
  stipple_leave(manual);
  __cyg_profile_func_exit(reinterpret_cast<void*>(&Outer), nullptr);
  Leave(object->dso, token);
  if (stipple_recording()) return 1;
  for (long i = 0; i < rounds; ++i) all();
  const std::uint32_t none = Enter(object->dso, object->descriptors[0]);
  __cyg_profile_func_enter(reinterpret_cast<void*>(&Outer), nullptr);
  stipple_enter(manual);
  stipple_start();
  stipple_leave(manual);
  __cyg_profile_func_exit(reinterpret_cast<void*>(&Outer), nullptr);
  Leave(object->dso, none);
  all();
  return none == 0 && stipple_recording() ? 0 : 1;
}

/// An object that is loaded while recording is off is off, too, and comes on with the others.
int Late(long) {
  constexpr const char* kLate[] = {"late"};
  stipple_stop();
  Object<1> late(kLate);
  if (late.descriptors[0].id != 0) return 1;
  stipple_start();
  if (late.descriptors[0].id == 0) return 1;
  const std::uint32_t token = Enter(late.dso, late.descriptors[0]);
  Leave(late.dso, token);
  return 0;
}

/// One round of all, one without `inner`, one of nothing, one of all but solver::step.
int Regions(long) {
  const auto all = [] {
    Work(1);
    Visit(2);
  };
  all();
  stipple_stop_regions("inn*");
  all();
  stipple_stop();
  stipple_start_regions("inner");
  all();
  stipple_start();
  stipple_stop_regions("solver::step(int)");
  stipple_stop_regions("nothing::*");
  all();
  return 0;
}

int Signalled(long rounds) {
  Work(rounds);
  kill(getpid(), SIGUSR2);
  Work(rounds);
  kill(getpid(), SIGUSR2);
  Work(rounds);
  return 0;
}

volatile sig_atomic_t own_calls = 0;

int OwnHandler(long rounds) {
  signal(SIGUSR2, [](int) { own_calls = own_calls + 1; });
  Work(rounds);
  kill(getpid(), SIGUSR2);
  Work(rounds);
  return own_calls == 1 ? 0 : 1;
}

/// A child goes on as its parent was.
int Fork(long rounds) {
  stipple_stop();
  if (fork() == 0) {
    Work(rounds);
    stipple_start();
    Work(2 * rounds);
    exit(0);
  }
  wait(nullptr);
  stipple_start();
  Work(rounds);
  return 0;
}

int Plain(long rounds) {
  Work(rounds);
  Visit(2);
  return 0;
}

struct Behaviour {
  std::string_view name;
  int (*run)(long number);
};
constexpr Behaviour kBehaviours[] = {
    {"storm", Storm},     {"off", Off},          {"late", Late},
    {"regions", Regions}, {"signal", Signalled}, {"own-handler", OwnHandler},
    {"fork", Fork},       {"plain", Plain},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  static Object<3> in_main(kNames);
  object = &in_main;
  for (const Behaviour& behaviour : kBehaviours)
    if (behaviour.name == argv[1]) return behaviour.run(std::atol(argv[2]));
  return 2;
}
