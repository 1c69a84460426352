// SPDX-License-Identifier: MIT
// The traced program of the core's tests: `writer BEHAVIOUR NUMBER [FILE]`. One table row each.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string_view>
#include <thread>
#include <vector>

#include "events.h"
#include "runtime/core/recorder.h"
#include "stipple/user.h"

namespace {

using stipple_test::Enter;
using stipple_test::Leave;
using stipple_test::object;
using stipple_test::Object;
using stipple_test::Visit;
using stipple_test::Work;

constexpr const char* kNames[] = {"outer", "inner", "handler"};
const char* file_name = nullptr;

int Return(long rounds) {
  Work(rounds);
  return 3;
}

int Threads(long rounds) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 64; ++i) threads.emplace_back(Work, rounds);
  for (std::thread& thread : threads) thread.join();
  return 0;
}

int Fork(long rounds) {
  Work(rounds);
  if (fork() == 0) {
    Work(2 * rounds);
    exit(5);
  }
  wait(nullptr);
  if (syscall(SYS_fork) == 0) {
    Work(3 * rounds);
    _exit(6);
  }
  wait(nullptr);
  if (vfork() == 0) _exit(7);
  wait(nullptr);
  Work(rounds);
  return 0;
}

int Quick(long rounds) {
  Work(rounds);
  quick_exit(9);
}

int Immediate(long rounds) {
  Work(rounds);
  _exit(7);
}

int Abort(long rounds) {
  Work(rounds);
  abort();
}

int Exec(long rounds) {
  Work(rounds);
  execl("/nonexistent", "nonexistent", nullptr);
  Work(rounds);
  execlp("true", "true", nullptr);
  return 1;
}

/// What a killed thread had finished for sure: rounds, by kernel thread.
struct Progress {
  std::atomic<long> tid;
  std::atomic<long> rounds;
  char padding[48];
};

int Killed(long ms) {
  const int descriptor = open(file_name, O_RDWR | O_CREAT, 0600);
  if (ftruncate(descriptor, 4096) != 0) return 1;
  auto* progress = static_cast<Progress*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([p = progress + i] {
      p->tid = syscall(SYS_gettid);
      for (long round = 1;; ++round) {
        Work(1);
        p->rounds.store(round, std::memory_order_release);
      }
    });
  for (int i = 0; i < 4; ++i)
    while (progress[i].rounds == 0) sched_yield();
  usleep(static_cast<useconds_t>(1000 * ms));
  kill(getpid(), SIGKILL);
  return 1;
}

int Modes(long rounds) {
  Visit(0);  // with the clock
  std::atomic_ref<std::uint32_t> outer(object->descriptors[0].id);
  std::atomic_ref<std::uint32_t> inner(object->descriptors[1].id);
  outer |= STIPPLE_NO_CLOCK;
  inner |= STIPPLE_COUNT_ONLY;
  Work(rounds);
  std::thread(Work, rounds).join();
  return 0;
}

/// Switches ids on and off while other threads run through them. On a loaded machine the switcher
/// may not be scheduled while `rounds` pass, or sleep with all switched off: hence the visits
/// before and after, and rounds until it has switched often enough.
int Toggle(long rounds) {
  const std::uint32_t ids[] = {object->descriptors[0].id, object->descriptors[1].id};
  Visit(0);
  std::atomic<bool> done{false};
  std::atomic<long> switches{0};
  std::thread toggler([&] {
    const std::uint32_t modes[] = {0, ~0u, STIPPLE_NO_CLOCK, STIPPLE_COUNT_ONLY};
    for (unsigned i = 0; !done; ++i) {
      const std::uint32_t mode = modes[i / 2 % 4];
      const std::uint32_t id = mode == 0 ? 0 : ids[i % 2] | (mode == ~0u ? 0 : mode);
      std::atomic_ref<std::uint32_t>(object->descriptors[i % 2].id) = id;
      ++switches;
    }
  });
  Work(rounds);
  while (switches < 1000) {
    Work(100);
    sched_yield();
  }
  done = true;
  toggler.join();
  object->descriptors[0].id = ids[0];
  Visit(0);
  return 0;
}

std::atomic<long> handled{0};
void Handle(int) {
  const int before = errno;
  Visit(2);
  stipple_ticks();
  if (errno != before) _exit(1);
  ++handled;
}

int Storm(long rounds) {
  struct sigaction action {};
  action.sa_handler = Handle;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  itimerval every_50_us{{0, 50}, {0, 50}};
  setitimer(ITIMER_REAL, &every_50_us, nullptr);
  static stipple_name mark = {"in the storm", "", 0};
  for (int i = 0; i < 100; ++i) {
    Work(rounds / 100);
    stipple_mark(&mark);
  }
  every_50_us = {};
  setitimer(ITIMER_REAL, &every_50_us, nullptr);
  std::printf("%ld\n", handled.load());
  return 0;
}

int Manual(long rounds) {
  static stipple_name queue = {"queue length", "rays", 0};
  static stipple_name phase = {"phase", "", 0};
  stipple_host();
  const std::uint32_t region = stipple_define_region("MPI_Send", "", 0, 2);
  if (region != stipple_define_region("MPI_Send", "", 0, 2)) return 1;
  for (long i = 0; i < rounds; ++i) {
    stipple_mark(&phase);
    const std::uint64_t entered = stipple_enter(region);
    stipple_counter(&queue, 1.5);
    if (stipple_leave(region) < entered) return 1;
  }
  if (fork() == 0) {
    stipple_mark(&phase);
    return 0;
  }
  wait(nullptr);
  return stipple_recording() ? 0 : 1;
}

int ThreadEnds(long rounds) {
  static pthread_key_t key;
  pthread_key_create(&key, [](void*) { Visit(2); });
  std::thread([rounds] {
    pthread_setspecific(key, &key);
    Work(rounds);
  }).join();
  return 0;
}

/// Closes every descriptor it can find, and goes on.
int CloseAll(long rounds) {
  Work(1);
  for (int descriptor = 3; descriptor < 1024; ++descriptor) close(descriptor);
  for (int descriptor = 3; descriptor < 1024; ++descriptor) open("/dev/null", O_RDWR);
  Work(rounds);
  return 0;
}

/// The same object again and again: as if loaded and unloaded.
int Reload(long rounds) {
  for (long i = 0; i < rounds; ++i) {
    Object<3> again(kNames);
    if (again.descriptors[2].id != object->descriptors[2].id) return 1;
  }
  return 0;
}

/// Defines so many functions: one object that comes again and again, its functions on other lines.
int Exhaust(long functions) {
  static stipple_descriptor descriptors[4096];
  static const char name[] = "f";
  for (std::uint32_t line = 1; line <= functions;) {
    for (stipple_descriptor& d : descriptors)
      d = {0, line++, name - reinterpret_cast<const char*>(&d.name), 0};
    stipple_dso dso{};
    dso.abi = STIPPLE_ABI;
    dso.descriptor_bytes = sizeof(stipple_descriptor);
    dso.begin = std::begin(descriptors);
    dso.end = std::end(descriptors);
    stipple_register(&dso);
    Leave(dso, Enter(dso, descriptors[0]));
    stipple_unregister(&dso);
  }
  Work(1);
  return 3;
}

struct Behaviour {
  std::string_view name;
  int (*run)(long number);
};
constexpr Behaviour kBehaviours[] = {
    {"return", Return},      {"threads", Threads},
    {"fork", Fork},          {"quick", Quick},
    {"_exit", Immediate},    {"abort", Abort},
    {"exec", Exec},          {"killed", Killed},
    {"modes", Modes},        {"toggle", Toggle},
    {"storm", Storm},        {"manual", Manual},
    {"reload", Reload},      {"thread-ends", ThreadEnds},
    {"close-all", CloseAll}, {"exhaust", Exhaust},
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  if (argc > 3) file_name = argv[3];
  static Object<3> in_main(kNames);
  object = &in_main;
  for (const Behaviour& behaviour : kBehaviours)
    if (behaviour.name == argv[1]) return behaviour.run(std::atol(argv[2]));
  return 2;
}
