// SPDX-License-Identifier: MIT
// The traced program of the budget's tests: `writer BEHAVIOUR NUMBER`. It counts its visits itself
// and prints them at the end, "REGION VISITS" a line.
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <thread>
#include <vector>

#include "events.h"

namespace {

using stipple_test::Enter;
using stipple_test::Leave;
using stipple_test::Object;

constexpr const char* kNames[] = {"outer", "middle", "inner", "handler"};
enum Region { kOuter, kMiddle, kInner, kHandler, kRegions };
Object<kRegions>* object = nullptr;
std::atomic<long> made[kRegions];
thread_local long visits[kRegions];  // of this thread, not yet among `made`

void Settle() {
  for (int region = 0; region < kRegions; ++region) {
    made[region] += visits[region];
    visits[region] = 0;
  }
}

void Print() {
  Settle();
  for (int region = 0; region < kRegions; ++region)
    std::printf("%d %ld\n", region + 1, made[region].load());
  std::fflush(stdout);
}

std::uint32_t Slot(Region region) {
  return std::atomic_ref<std::uint32_t>(object->descriptors[region].id);
}

struct Nothing {
  void operator()() const {}
};

template <class Body = Nothing>
__attribute__((noinline)) void Visit(Region region, Body body = {}) {
  ++visits[region];
  const std::uint32_t token = Enter(object->dso, object->descriptors[region]);
  body();
  __asm__ volatile("" ::: "memory");
  Leave(object->dso, token);
}

/// Three levels: an outer visit holds two middle ones, each of these two inner ones.
void Nest(long rounds) {
  for (long i = 0; i < rounds; ++i)
    Visit(kOuter, [] {
      for (int j = 0; j < 2; ++j)
        Visit(kMiddle, [] {
          Visit(kInner);
          Visit(kInner);
        });
    });
  Settle();
}

void Leaf(long rounds) {
  for (long i = 0; i < rounds; ++i) Visit(kInner);
  Settle();
}

/// All three counted only, by hand.
void Counted(long rounds) {
  for (const Region region : {kOuter, kMiddle, kInner})
    std::atomic_ref<std::uint32_t>(object->descriptors[region].id) |= STIPPLE_COUNT_ONLY;
  Nest(rounds);
}

void Threads(long rounds) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) threads.emplace_back(Nest, rounds);
  for (std::thread& thread : threads) thread.join();
}

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Short until it is counted only, then 20 us a visit until it has its clock back.
void Grow(long rounds) {
  Leaf(rounds);
  while ((Slot(kInner) & STIPPLE_COUNT_ONLY) == 0 && CpuSeconds() < 30) Leaf(1000);
  while ((Slot(kInner) & STIPPLE_MODE_MASK) != 0 && CpuSeconds() < 60)
    Visit(kInner, [] {
      for (int i = 0; i < 1000; ++i) __builtin_ia32_rdtsc();
    });
  for (int i = 0; i < 10; ++i) Visit(kInner);
}

jmp_buf jump_point;
/// Each outer visit is left by a jump from within; inner visits follow at about the same depth.
void Jump(long rounds) {
  Nest(rounds);
  volatile long left = rounds;
  while (left > 0) {
    left = left - 1;
    if (setjmp(jump_point) == 0)
      Visit(kOuter, [] { Visit(kMiddle, [] { longjmp(jump_point, 1); }); });
    Visit(kInner);
  }
}

void Throw(long rounds) {
  Nest(rounds);
  for (long i = 0; i < rounds; ++i) {
    // As the plugin has it: an exception passes a leave.
    ++visits[kOuter];
    const std::uint32_t token = Enter(object->dso, object->descriptors[kOuter]);
    try {
      throw 1;
    } catch (int) {
      Leave(object->dso, token);
    }
    Visit(kInner);
  }
}

ucontext_t here, there;
bool finished = false;
/// On a stack of its own: outer visits that are interrupted in the middle.
void Coroutine() {
  while (!finished) Visit(kOuter, [] { swapcontext(&there, &here); });
  swapcontext(&there, &here);
}

void Switch(long rounds) {
  Nest(rounds);
  static char stack[64 * 1024];
  getcontext(&there);
  there.uc_stack.ss_sp = stack;
  there.uc_stack.ss_size = sizeof stack;
  makecontext(&there, Coroutine, 0);
  for (long i = 0; i < rounds; ++i) {
    swapcontext(&here, &there);
    Visit(kInner);
  }
  finished = true;
  swapcontext(&here, &there);
}

std::atomic<long> handled{0};
void Handle(int) {
  const std::uint32_t token = Enter(object->dso, object->descriptors[kHandler]);
  const std::uint32_t inner = Enter(object->dso, object->descriptors[kInner]);
  Leave(object->dso, inner);
  Leave(object->dso, token);
  ++handled;
}

/// Two hundred signals at least, whatever the machine's load, in the middle of counted visits.
void Storm(long rounds) {
  Nest(rounds);
  for (const Region region : {kOuter, kMiddle, kInner, kHandler})
    std::atomic_ref<std::uint32_t>(object->descriptors[region].id) =
        (Slot(region) & STIPPLE_REGION_MASK) | STIPPLE_COUNT_ONLY;
  struct sigaction action {};
  action.sa_handler = Handle;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  itimerval every{{0, 50}, {0, 50}};
  setitimer(ITIMER_REAL, &every, nullptr);
  for (long i = 0; i < 20 || handled < 200; ++i) Nest(rounds / 20);
  every = {};
  setitimer(ITIMER_REAL, &every, nullptr);
  made[kHandler] += handled;
  made[kInner] += handled;
}

/// The child says first what it did.
void Fork(long rounds) {
  Nest(rounds);
  std::fflush(stdout);
  if (fork() == 0) {
    for (auto& number : made) number = 0;
    Nest(rounds / 10);
    Print();
    exit(0);
  }
  wait(nullptr);
}

void Killed(long rounds) {
  Leaf(rounds);
  Print();
  kill(getpid(), SIGKILL);
}

void Switched(long rounds) {
  Nest(rounds);
  if (fork() == 0) execl("/nonexistent", "nonexistent", nullptr);
  wait(nullptr);
  execl("/nonexistent", "nonexistent", nullptr);
  Nest(rounds);
}

struct Behaviour {
  std::string_view name;
  void (*act)(long);
};
constexpr Behaviour kBehaviours[] = {
    {"leaf", Leaf},   {"nest", Nest}, {"counted", Counted}, {"threads", Threads},
    {"grow", Grow},   {"jump", Jump}, {"throw", Throw},     {"switch", Switch},
    {"storm", Storm}, {"fork", Fork}, {"killed", Killed},   {"exec", Switched},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  object = new Object<kRegions>(kNames);
  for (const Behaviour& behaviour : kBehaviours)
    if (behaviour.name == argv[1]) {
      behaviour.act(std::atol(argv[2]));
      Print();
      return 0;
    }
  return 2;
}
