// SPDX-License-Identifier: MIT
// The smallest runtime that keeps the promises of abi.h, so that the plugins can be tested without
// the real one. Events go to the file STIPPLE_RECORDER_FILE, one a line: process, thread, enter or
// leave, linkage name. STIPPLE_RECORDER_MODE is a list of words:
//   direct    every event takes the slow path and is written at once (survives _exit and abort)
//   count     ids carry STIPPLE_COUNT_ONLY: no events, at the end one line `count N NAME` each, and
//             `asked N NAME` for the visits that came to the slow path, at most each tenth
//   no-clock  ids carry STIPPLE_NO_CLOCK
//   sparse    the clock is read for one event in eight
//   toggle    a timer takes the ids away and gives them back while the program runs
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include "stipple/abi.h"

namespace {

constexpr unsigned kRegions = 1 << 16, kThreads = 256, kObjects = 64;
constexpr size_t kBufferBytes = size_t{1} << 28;

struct Thread {
  stipple_control control;
  uint64_t begin;
  int process;
};

struct Region {
  char* name;
  char* file;
  uint32_t line;
};

Region regions[kRegions];
uint64_t visits[kRegions], asked[kRegions];
uint64_t
    words[kRegions];  // stipple_control.counts, of all threads: visits counted before they happen
unsigned region_count = 1;
Thread threads[kThreads];
int thread_count;
stipple_dso* objects[kObjects];
unsigned object_count;
int* process_count;  // shared with forked children
int process;
bool direct, sparse, toggle, off;
uint32_t mode;
pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

stipple_control nowhere;  // end 0: the first event of each thread takes the slow path
__thread stipple_control* control __attribute__((tls_model("initial-exec"))) = &nowhere;
__thread Thread* self __attribute__((tls_model("initial-exec")));

int File() { return open(getenv("STIPPLE_RECORDER_FILE"), O_WRONLY | O_APPEND | O_CREAT, 0644); }

void Print(int fd, int thread, uint64_t word) {
  const Region& region = regions[word & STIPPLE_REGION_MASK];
  char line[4096];
  const int bytes = snprintf(line, sizeof(line), "%d %d %s %s\n", process, thread,
                             (word & STIPPLE_LEAVE) != 0 ? "leave" : "enter", region.name);
  if (write(fd, line, size_t(bytes)) != bytes) abort();
}

void Write(Thread& thread, uint64_t word) {
  if (direct) {
    const int fd = File();
    Print(fd, int(&thread - threads), word);
    close(fd);
    return;
  }
  const uint64_t slot = __atomic_fetch_add(&thread.control.cur, 8, __ATOMIC_RELAXED);
  *reinterpret_cast<uint64_t*>(slot) = word;
}

// A thread's buffer; in a forked child, the parent's are not written again.
Thread& Self() {
  if (self != nullptr && self->process == process) return *self;
  pthread_mutex_lock(&lock);
  self = &threads[thread_count++];
  pthread_mutex_unlock(&lock);
  void* buffer = mmap(nullptr, kBufferBytes, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (buffer == MAP_FAILED) abort();
  const auto begin = reinterpret_cast<uint64_t>(buffer);
  *self = {{begin, direct ? 0 : begin + kBufferBytes, sparse ? uint64_t{0x38} : 0, words},
           begin,
           process};
  control = &self->control;
  return *self;
}

uint32_t Define(const char* name, const char* file, uint32_t line) {
  for (unsigned id = 1; id < region_count; ++id) {
    const Region& known = regions[id];
    if (known.line == line && strcmp(known.name, name) == 0 && strcmp(known.file, file) == 0)
      return id;
  }
  if (region_count == kRegions) abort();
  regions[region_count] = {strdup(name), strdup(file), line};
  return region_count++;
}

const char* TextAt(const int64_t& offset) {
  return reinterpret_cast<const char*>(&offset) + offset;
}

void SetIds(stipple_dso& dso, bool on) {
  for (stipple_descriptor* d = dso.begin; d != dso.end; ++d) {
    const uint32_t id = on ? Define(TextAt(d->name), TextAt(d->file), d->line) | mode : 0;
    __atomic_store_n(&d->id, id, __ATOMIC_RELAXED);
  }
}

void Toggle(int) {
  off = !off;
  for (unsigned i = 0; i < object_count; ++i)
    if (objects[i] != nullptr) SetIds(*objects[i], !off);
}

void StartToggling() {
  struct sigaction action = {};
  action.sa_handler = Toggle;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  const itimerval every = {{0, 500}, {0, 500}};
  setitimer(ITIMER_REAL, &every, nullptr);
}

void BecomeChild() {
  process = __atomic_add_fetch(process_count, 1, __ATOMIC_RELAXED);
  thread_count = 0;
}

void Begin() {
  const char* word = getenv("STIPPLE_RECORDER_MODE");
  const auto given = [word](const char* name) { return word && strstr(word, name) != nullptr; };
  direct = given("direct");
  sparse = given("sparse");
  toggle = given("toggle");
  mode = (given("count") ? STIPPLE_COUNT_ONLY : 0) | (given("no-clock") ? STIPPLE_NO_CLOCK : 0);
  process_count = static_cast<int*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  pthread_atfork(nullptr, nullptr, BecomeChild);
  if (toggle) StartToggling();
}

__attribute__((destructor)) void Finish() {
  if (toggle) signal(SIGALRM, SIG_IGN);
  if (region_count == 1 || direct) return;
  const int fd = File();
  for (int i = 0; i < thread_count; ++i) {
    if (threads[i].process != process) continue;
    for (uint64_t at = threads[i].begin; at < threads[i].control.cur; at += 8)
      Print(fd, i, *reinterpret_cast<uint64_t*>(at));
  }
  for (unsigned id = 1; id < region_count; ++id) {
    if (visits[id] == 0) continue;
    const auto line = [fd, id](const char* what, uint64_t number) {
      dprintf(fd, "%s %llu %s\n", what, static_cast<unsigned long long>(number), regions[id].name);
    };
    line("count", visits[id] - words[id]);
    line("asked", asked[id]);
  }
  close(fd);
}

}  // namespace

// Called by slow_path.S: eax before, eax after.
extern "C" __attribute__((visibility("hidden"))) uint32_t test_slow_event(uint32_t token) {
  Thread& thread = Self();
  if ((token & STIPPLE_COUNT_ONLY) != 0) {
    const uint32_t region = token & STIPPLE_REGION_MASK;
    ++visits[region];
    ++asked[region];
    if (words[region] == 0) visits[region] += words[region] = 9;
    return 0;
  }
  const uint64_t time = (token & STIPPLE_NO_CLOCK) != 0 ? 0 : __builtin_ia32_rdtsc() << 24;
  Write(thread, time | (token & (STIPPLE_REGION_MASK | STIPPLE_LEAVE)));
  return token & ~uint32_t{STIPPLE_LEAVE};
}

extern "C" void test_slow_path();

extern "C" __attribute__((visibility("default"))) void stipple_register(stipple_dso* dso) {
  if (getenv("STIPPLE_RECORDER_FILE") == nullptr || dso->abi != STIPPLE_ABI) return;
  if (region_count == 1) Begin();
  dso->slow = test_slow_path;
  dso->tp_offset =
      reinterpret_cast<char*>(&control) - static_cast<char*>(__builtin_thread_pointer());
  if (object_count < kObjects) objects[object_count++] = dso;
  SetIds(*dso, true);
}

extern "C" __attribute__((visibility("default"))) void stipple_unregister(stipple_dso* dso) {
  for (stipple_dso*& known : objects)
    if (known == dso) known = nullptr;
  SetIds(*dso, false);
}
