/* SPDX-License-Identifier: MIT */
/* planted SHAPE VISITS: a program that knows how long it is in each of its functions.
 *
 * All work is one chain of multiplications, each of which needs the last one's result, through all
 * calls: calls and loops run ahead of the chain and cost nothing. So the exclusive time of a
 * function is its number of links times the time of one, which is measured before and after in code
 * without instrumentation. Prints link_ns BEFORE AFTER / wall_ns N / cpu_ns N / visits N /
 * interruptions N, and for each function: region NAME LINKS */
#define _GNU_SOURCE
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define PLAIN __attribute__((no_instrument_function, noinline))
#define REGION __attribute__((noinline)) static
#define WORK(region, links) (done[region] += (links), x = Chain(x, links))

enum {
  kMix,
  kShort,
  kLong,
  kNested,
  kOuter,
  kInner,
  kCallers,
  kCheap,
  kDear,
  kShared,
  kBimodal,
  kSwinging,
  kRecursion,
  kTree,
  kPeriod,
  kEver1024,
  kRegions
};
static const char* const kNames[kRegions] = {
    "Mix",  "Short",  "Long",    "Nested",   "Outer",     "Inner", "Callers", "Cheap",
    "Dear", "Shared", "Bimodal", "Swinging", "Recursion", "Tree",  "Period",  "Ever1024"};
static uint64_t done[kRegions];

static inline __attribute__((always_inline)) uint64_t Chain(uint64_t x, long links) {
  for (long i = 0; i < links; ++i) {
    x = x * 6364136223846793005u + 1442695040888963407u;
    __asm__ volatile("" : "+r"(x));
  }
  return x;
}

/* Long and short visits side by side. */
REGION uint64_t Short(uint64_t x) { return WORK(kShort, 40); }
REGION uint64_t Long(uint64_t x) { return WORK(kLong, 4000); }
REGION uint64_t Mix(uint64_t x, long n) {
  for (long i = 0; i < n; ++i) {
    x = Short(x);
    x = i % 64 == 0 ? Long(x) : x;
    WORK(kMix, 12);
  }
  return x;
}

/* Short visits inside of short visits. */
REGION uint64_t Inner(uint64_t x) { return WORK(kInner, 30); }
REGION uint64_t Outer(uint64_t x) {
  WORK(kOuter, 20);
  x = Inner(x);
  WORK(kOuter, 15);
  return Inner(x) + 1;
}
REGION uint64_t Nested(uint64_t x, long n) {
  for (long i = 0; i < n; i += 3) {
    x = Outer(x);
    WORK(kNested, 25);
  }
  return x;
}

/* One leaf at different cost for two callers. */
REGION uint64_t Shared(uint64_t x, long links) { return WORK(kShared, links); }
REGION uint64_t Cheap(uint64_t x) {
  for (int i = 0; i < 30; ++i) x = Shared(x, 25);
  return WORK(kCheap, 600);
}
REGION uint64_t Dear(uint64_t x) {
  for (int i = 0; i < 10; ++i) x = Shared(x, 150);
  return WORK(kDear, 900);
}
REGION uint64_t Callers(uint64_t x, long n) {
  for (long i = 0; i < n; i += 42) {
    x = Dear(Cheap(x));
    WORK(kCallers, 50);
  }
  return x;
}

/* Two sorts of visits, in no order. */
REGION uint64_t Swinging(uint64_t x, long links) { return WORK(kSwinging, links); }
REGION uint64_t Bimodal(uint64_t x, long n) {
  uint32_t random = 1;
  for (long i = 0; i < n; ++i) {
    random = random * 1664525u + 1013904223u;
    x = Swinging(x, random >> 28 == 0 ? 500 : 25);
    WORK(kBimodal, 20);
  }
  return x;
}

/* Calls itself. */
REGION uint64_t Tree(uint64_t x, int depth) {
  WORK(kTree, 30);
  if (depth > 1) {
    x = Tree(x, depth - 1);
    x = Tree(x, depth - 2);
  }
  return x + 1;
}
REGION uint64_t Recursion(uint64_t x, long n) {
  for (long i = 0; i < n; i += 1973) { /* about the visits of Tree(x, 15) */
    x = Tree(x, 15);
    WORK(kRecursion, 2000);
  }
  return x;
}

/* In step with a stride of 1024. */
REGION uint64_t Ever1024(uint64_t x, long links) { return WORK(kEver1024, links); }
REGION uint64_t Period(uint64_t x, long n) {
  for (long i = 0; i < n; ++i) {
    x = Ever1024(x, i % 1024 == 0 ? 20000 : 25);
    WORK(kPeriod, 15);
  }
  return x;
}

struct Shape {
  const char* name;
  uint64_t (*run)(uint64_t x, long visits);
};
static const struct Shape kShapes[] = {
    {"mix", Mix},         {"nested", Nested},       {"callers", Callers},
    {"bimodal", Bimodal}, {"recursion", Recursion}, {"period", Period}};

PLAIN static int64_t NowNs(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec * 1000000000LL + t.tv_nsec;
}

/* Nanoseconds of a link: the mean of the stretches that nothing long came between. */
PLAIN static double LinkNs(uint64_t* x) {
  enum { kStretches = 40, kLinks = 300000 };
  double ns[kStretches], least = 1e9, sum = 0;
  int count = 0;
  for (int i = 0; i < kStretches; ++i) {
    const int64_t begin = NowNs(CLOCK_MONOTONIC);
    *x = Chain(*x, kLinks);
    ns[i] = (double)(NowNs(CLOCK_MONOTONIC) - begin) / kLinks;
    if (ns[i] < least) least = ns[i];
  }
  for (int i = 0; i < kStretches; ++i) {
    if (ns[i] > 1.1 * least) continue;
    sum += ns[i];
    ++count;
  }
  return sum / count;
}

PLAIN static long Interruptions(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

PLAIN static int Measure(const struct Shape* shape, long count) {
  uint64_t x = 1;
  const double before = LinkNs(&x);
  const long interruptions = Interruptions();
  const int64_t wall = NowNs(CLOCK_MONOTONIC), cpu = NowNs(CLOCK_THREAD_CPUTIME_ID);
  x = shape->run(x, count);
  const int64_t wall_ns = NowNs(CLOCK_MONOTONIC) - wall,
                cpu_ns = NowNs(CLOCK_THREAD_CPUTIME_ID) - cpu;
  const long interrupted = Interruptions() - interruptions;
  const double after = LinkNs(&x);
  printf("link_ns %.5f %.5f\nwall_ns %lld\ncpu_ns %lld\ninterruptions %ld\n", before, after,
         (long long)wall_ns, (long long)cpu_ns, interrupted);
  for (int r = 0; r < kRegions; ++r)
    if (done[r] != 0) printf("region %s %llu\n", kNames[r], (unsigned long long)done[r]);
  return x == 0; /* never; keeps the chain */
}

PLAIN int main(int argc, char** argv) {
  const size_t shapes = sizeof(kShapes) / sizeof(kShapes[0]);
  for (size_t s = 0; argc == 3 && s < shapes; ++s)
    if (strcmp(argv[1], kShapes[s].name) == 0) return Measure(&kShapes[s], atol(argv[2]));
  fprintf(stderr, "usage: planted SHAPE VISITS    SHAPE:");
  for (size_t s = 0; s < shapes; ++s) fprintf(stderr, " %s", kShapes[s].name);
  fprintf(stderr, "\n");
  return 2;
}
