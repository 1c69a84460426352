/* SPDX-License-Identifier: MIT */
/* What the runner calls in each variant of a kernel. Built five times per compiler: plain, with the
 * plugin (three times: no runtime, filtered, recording) and, with BENCH_FLOOR, with the cheapest event that could be
 * written by hand: read the clock, store 8 bytes. */
#ifndef STIPPLE_TESTS_BENCH_EVENTS_KERNEL_H
#define STIPPLE_TESTS_BENCH_EVENTS_KERNEL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Does the work `calls` times; the result depends on all of it. */
__attribute__((visibility("default"))) uint64_t kernel_run(uint64_t calls);

#ifdef __cplusplus
}
#endif

#ifdef BENCH_FLOOR
static uint64_t floor_ring[8192];
static uint64_t floor_next;
static inline __attribute__((always_inline)) void FloorEvent(uint64_t word) {
  floor_ring[floor_next++ & 8191] = (__builtin_ia32_rdtsc() << 24) | word;
}
#define FLOOR_ENTER() FloorEvent(1)
#define FLOOR_LEAVE() FloorEvent(0x800001)
#else
#define FLOOR_ENTER() (void)0
#define FLOOR_LEAVE() (void)0
#endif

#endif
