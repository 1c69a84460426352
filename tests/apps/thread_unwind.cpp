// SPDX-License-Identifier: MIT
// A thread that ends by pthread_exit or cancellation in C++ is unwound: destructors run, exits are
// events, thread_local objects are destroyed afterwards.
#include <pthread.h>
#include <semaphore.h>
#include <unistd.h>

#include <cstdio>

namespace {
sem_t ready;
}

struct Noisy {
  const char* name;
  [[gnu::noinline]] ~Noisy() { std::printf("~%s\n", name); }
};

[[gnu::noinline]] void Exit() { pthread_exit(nullptr); }
[[gnu::noinline]] void Wait() {
  sem_post(&ready);
  for (;;) pause();
}
[[gnu::noinline]] void Frame(void (*end)()) {
  Noisy local{"local"};
  end();
  std::puts("never");
}
[[gnu::noinline]] void Touch() {
  thread_local Noisy of_thread{"of_thread"};
  std::puts(of_thread.name);
}

extern "C" void* Exits(void* argument) {
  Touch();
  Frame(Exit);
  return argument;
}
extern "C" void* Cancelled(void* argument) {
  Touch();
  Frame(Wait);
  return argument;
}

int main() {
  sem_init(&ready, 0, 0);
  pthread_t thread;
  pthread_create(&thread, nullptr, Exits, nullptr);
  pthread_join(thread, nullptr);
  pthread_create(&thread, nullptr, Cancelled, nullptr);
  sem_wait(&ready);
  pthread_cancel(thread);
  pthread_join(thread, nullptr);
  std::puts("done");
}
