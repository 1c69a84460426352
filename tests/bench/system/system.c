// SPDX-License-Identifier: MIT
// What system events cost the program that makes them: calls | switches | ring (switches that the
// kernel notes in a ring which nobody reads: the floor of recording them). Prints the p10 of up to
// 200 batches, CPU time of the process: ns per close(-1) through libc, ns per context switch of two
// threads that share a processor and yield.
#define _GNU_SOURCE
#include <linux/perf_event.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "stipple/user.h"

enum { kBatches = 200, kCalls = 200, kSeconds = 3 };

/// Of both threads: what others do on the processor does not count.
static double CpuNs(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static double Switches(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return (double)(usage.ru_nvcsw + usage.ru_nivcsw);
}

static int Compare(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return x < y ? -1 : x > y;
}

static double Measure(void (*one)(void), int per_switch) {
  double batches[kBatches];
  int count = 0;
  // On a busy machine a thread that yields is away for long.
  for (const time_t end = time(NULL) + kSeconds; count < kBatches && time(NULL) < end; ++count) {
    const double begin_ns = CpuNs();
    const double begin = Switches();
    for (int i = 0; i < kCalls; ++i) one();
    batches[count] = (CpuNs() - begin_ns) / (per_switch ? Switches() - begin + 1 : kCalls);
  }
  qsort(batches, (size_t)count, sizeof batches[0], Compare);
  return batches[count / 10];
}

static void Close(void) { close(-1); }
static void Yield(void) { sched_yield(); }

static volatile int done;
static int has_ring;

/// The kernel notes this thread's switches, over and over in one page: no record, no loss is kept.
static void OpenRing(void) {
  struct perf_event_attr attributes;
  memset(&attributes, 0, sizeof attributes);
  attributes.size = sizeof attributes;
  attributes.type = PERF_TYPE_SOFTWARE;
  attributes.config = PERF_COUNT_SW_DUMMY;
  attributes.sample_type = PERF_SAMPLE_TID | PERF_SAMPLE_TIME | PERF_SAMPLE_CPU;
  attributes.sample_id_all = attributes.context_switch = 1;
  attributes.exclude_kernel = attributes.exclude_hv = attributes.use_clockid = 1;
  attributes.clockid = CLOCK_MONOTONIC_RAW;
  attributes.write_backward = 1;
  const int descriptor = (int)syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0);
  if (descriptor < 0 || mmap(NULL, 17 * 4096, PROT_READ, MAP_SHARED, descriptor, 0) == MAP_FAILED) {
    perror("ring");
    exit(1);
  }
}

static void* YieldOn(void* argument) {
  if (has_ring) OpenRing();
  while (!done) Yield();
  return argument;
}

int main(int count, char** words) {
  static struct stipple_name begin = {"begin", "", 0};
  has_ring = count > 1 && strcmp(words[1], "ring") == 0;
  const int switches = has_ring || (count > 1 && strcmp(words[1], "switches") == 0);
  if (has_ring) OpenRing();
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(sched_getcpu(), &one);
  sched_setaffinity(0, sizeof one, &one);
  stipple_mark(&begin);
  pthread_t other;
  if (switches && pthread_create(&other, NULL, YieldOn, NULL) != 0) return 1;
  const double ns = Measure(switches ? Yield : Close, switches);
  done = 1;
  if (switches) pthread_join(other, NULL);
  printf("%.1f\n", ns);
  return 0;
}
