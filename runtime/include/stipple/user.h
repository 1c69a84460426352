/* SPDX-License-Identifier: MIT */
/* Manual events: what a program tells stipple about itself. C and C++.
 *
 * Nothing is linked: each call looks up a weak symbol and does nothing when no runtime is loaded,
 * so a program that uses this header runs unchanged without stipple (cost: one load and one test
 * per call). */
#ifndef STIPPLE_USER_H
#define STIPPLE_USER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The name of a mark or counter, with its unit ("" for none). Make it static: the runtime writes
 * `id` at first use. static struct stipple_name queue_length = {"queue length", "rays", 0}; */
struct stipple_name {
  const char* name;
  const char* unit;
  uint32_t id;
};

/* The address of a runtime function, or null. Read through the GOT by hand: a compiler's own access
 * to a weak symbol may be resolved to zero when the program is linked, and then a preloaded runtime
 * would never be seen. */
#define STIPPLE_RUNTIME_FUNCTION(symbol, pointer)                                                 \
  __asm__(".weak " #symbol "\n\t{movq " #symbol "@GOTPCREL(%%rip), %0|mov %0, QWORD PTR " #symbol \
          "@GOTPCREL[rip]}"                                                                       \
          : "=r"(pointer))

/* Marks a moment: the start of a phase, a decision, an end of supply. */
static inline void stipple_mark(struct stipple_name* name) {
  void (*record)(struct stipple_name*);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_mark, record);
  if (record) record(name);
}

/* Records the value that a counter has from now on, in the name's unit. */
static inline void stipple_counter(struct stipple_name* name, double value) {
  void (*record)(struct stipple_name*, double);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_counter, record);
  if (record) record(name, value);
}

/* This process is the host: it hands out work and is shown apart, last. */
static inline void stipple_host(void) {
  void (*record)(void);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_host, record);
  if (record) record();
}

/* Switches recording off and on again, in all threads of this process. In between there are no
 * events of any kind; visits that are open are recorded to their ends. The archive says when it was
 * off. MPI programs switch all ranks at the same point, else messages lack one end. */
static inline void stipple_stop(void) {
  void (*record)(int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch, record);
  if (record) record(0);
}
static inline void stipple_start(void) {
  void (*record)(int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch, record);
  if (record) record(1);
}

/* The same for the functions loaded now whose names match a pattern of a filter file, such as
 * "solver::*". A function is recorded while both it and the process are switched on. Functions of
 * -finstrument-functions have no names yet and match nothing but "*" and the like. Not for signal
 * handlers: making names readable takes the program's malloc. */
static inline void stipple_stop_regions(const char* pattern) {
  void (*record)(const char*, int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch_regions, record);
  if (record) record(pattern, 0);
}
static inline void stipple_start_regions(const char* pattern) {
  void (*record)(const char*, int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch_regions, record);
  if (record) record(pattern, 1);
}

#ifdef __cplusplus
}
#endif

#endif
