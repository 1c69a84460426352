/* SPDX-License-Identifier: MIT */
/* Manual events: what a program tells stipple about itself. C and C++.
 *
 * Nothing is linked: each call looks up a weak symbol and does nothing when no runtime is loaded,
 * so a program that uses this header runs unchanged without stipple (cost: one load and one test
 * per call). All calls may come from any thread, from signal handlers (but for those that say
 * otherwise), before and after main; errno stays as it is. Their times are exact whatever the clock
 * mode. From C89 and C++98 on; on anything but x86-64 with ELF they do nothing.
 *
 * Regions, names and channels are handles of static storage duration: the runtime writes `id` at
 * first use. Fortran: stipple.f90. Examples: docs/user.md. */
#ifndef STIPPLE_USER_H
#define STIPPLE_USER_H

#include <stdint.h>

/* The calls themselves are no functions of the program. */
#define STIPPLE_INLINE static __inline__ __attribute__((no_instrument_function))

#ifdef __cplusplus
extern "C" {
#endif

/* A piece of the program's work: a phase, a loop, a step of a pipeline. It is analysed as a
 * function is. STIPPLE_REGION(solve, "solve"); */
struct stipple_region {
  const char* name;
  const char* file; /* "" and 0: not said */
  uint32_t line;
  uint32_t id;
};
#define STIPPLE_REGION(variable, name) \
  static struct stipple_region variable = {name, __FILE__, __LINE__, 0}

/* The name of a mark or counter, with its unit ("" for none).
 * static struct stipple_name queue_length = {"queue length", "rays", 0}; */
struct stipple_name {
  const char* name;
  const char* unit;
  uint32_t id;
};

/* What messages between threads go through: a queue, a ring, a mailbox.
 * static struct stipple_channel jobs = {"jobs", 0}; */
struct stipple_channel {
  const char* name;
  uint32_t id;
};

/* The address of a runtime function, or null. Read through the GOT by hand: a compiler's own access
 * to a weak symbol may be resolved to zero when the program is linked, and then a preloaded runtime
 * would never be seen. */
#if defined(__x86_64__) && defined(__ELF__) && !defined(__ILP32__)
#define STIPPLE_RUNTIME_FUNCTION(symbol, pointer)                                                 \
  __asm__(".weak " #symbol "\n\t{movq " #symbol "@GOTPCREL(%%rip), %0|mov %0, QWORD PTR " #symbol \
          "@GOTPCREL[rip]}"                                                                       \
          : "=r"(pointer))
#else
#define STIPPLE_RUNTIME_FUNCTION(symbol, pointer) ((pointer) = 0)
#endif

/* A call that the compiler cannot put behind the function's own end, as it does with the last one
 * of a function: the event belongs into it. */
#define STIPPLE_CALL(call) \
  do {                     \
    call;                  \
    __asm__ volatile("");  \
  } while (0)

/* The region begins or ends on this thread. Regions nest among each other and with functions, so
 * one ends in the function that began it; if it has not, it ends there. */
STIPPLE_INLINE void stipple_region_begin(struct stipple_region* region) {
  void (*record)(struct stipple_region*);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_begin, record);
  if (record) STIPPLE_CALL(record(region));
}
STIPPLE_INLINE void stipple_region_end(struct stipple_region* region) {
  void (*record)(struct stipple_region*);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_end, record);
  if (record) STIPPLE_CALL(record(region));
}

/* Marks a moment: the start of a phase, a decision, an end of supply. */
STIPPLE_INLINE void stipple_mark(struct stipple_name* name) {
  void (*record)(struct stipple_name*);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_mark, record);
  if (record) STIPPLE_CALL(record(name));
}

/* Records the value that a counter of this process has from now on, in the name's unit. */
STIPPLE_INLINE void stipple_counter(struct stipple_name* name, double value) {
  void (*record)(struct stipple_name*, double);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_counter, record);
  if (record) STIPPLE_CALL(record(name, value));
}

/* The time, for stipple_receive: ticks of the archive's clock; 0 without a runtime. */
STIPPLE_INLINE uint64_t stipple_time(void) {
  uint64_t (*read_clock)(void);
  STIPPLE_RUNTIME_FUNCTION(stipple_ticks, read_clock);
  return read_clock ? read_clock() : 0;
}

/* A message from one thread of this process to another: send just before it is handed over, receive
 * just after it was taken. On one channel with one key the first that was sent is the first that is
 * received; where items overtake each other give each its own key, such as its address.
 * `waiting_since`: the time when the receiver began to look for it, or 0; it tells late senders. */
STIPPLE_INLINE void stipple_send(struct stipple_channel* channel, uint64_t key, uint64_t bytes) {
  void (*record)(struct stipple_channel*, uint64_t, uint64_t);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_send, record);
  if (record) STIPPLE_CALL(record(channel, key, bytes));
}
STIPPLE_INLINE void stipple_receive(struct stipple_channel* channel, uint64_t key, uint64_t bytes,
                                    uint64_t waiting_since) {
  void (*record)(struct stipple_channel*, uint64_t, uint64_t, uint64_t);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_receive, record);
  if (record) STIPPLE_CALL(record(channel, key, bytes, waiting_since));
}

/* Handles with names made at run time. The text is copied, so it may go away at once. Each call
 * looks the text up under a lock (0.6 us): keep the handle where you can. The same texts give
 * the same region, name or channel; there is room for 65535 names and channels. */
STIPPLE_INLINE struct stipple_region stipple_make_region(const char* name, const char* file,
                                                         uint32_t line) {
  struct stipple_region made = {0, 0, 0, 0};
  uint32_t (*define)(const char*, const char*, uint32_t, uint32_t);
  STIPPLE_RUNTIME_FUNCTION(stipple_define_region, define);
  if (define) made.id = define(name, file, line, 3); /* a region of the program's own */
  return made;
}
STIPPLE_INLINE struct stipple_name stipple_make_name(const char* name, const char* unit) {
  struct stipple_name made = {0, 0, 0};
  uint32_t (*define)(const char*, const char*);
  STIPPLE_RUNTIME_FUNCTION(stipple_define_name, define);
  if (define) made.id = define(name, unit);
  return made;
}
STIPPLE_INLINE struct stipple_channel stipple_make_channel(const char* name) {
  struct stipple_channel made = {0, 0};
  uint32_t (*define)(const char*);
  STIPPLE_RUNTIME_FUNCTION(stipple_define_channel, define);
  if (define) made.id = define(name);
  return made;
}

/* This process is the host: it hands out work and is shown apart, last. */
STIPPLE_INLINE void stipple_host(void) {
  void (*record)(void);
  STIPPLE_RUNTIME_FUNCTION(stipple_record_host, record);
  if (record) STIPPLE_CALL(record());
}

/* Switches recording off and on again, in all threads of this process. In between there are no
 * events of any kind; visits that are open are recorded to their ends. The archive says when it was
 * off. MPI programs switch all ranks at the same point, else messages lack one end. */
STIPPLE_INLINE void stipple_stop(void) {
  void (*record)(int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch, record);
  if (record) STIPPLE_CALL(record(0));
}
STIPPLE_INLINE void stipple_start(void) {
  void (*record)(int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch, record);
  if (record) STIPPLE_CALL(record(1));
}

/* The same for the functions loaded now whose names match a pattern of a filter file, such as
 * "solver::*". A function is recorded while both it and the process are switched on. Functions of
 * -finstrument-functions have no names yet and match nothing but "*" and the like. Not for signal
 * handlers: making names readable takes the program's malloc. */
STIPPLE_INLINE void stipple_stop_regions(const char* pattern) {
  void (*record)(const char*, int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch_regions, record);
  if (record) STIPPLE_CALL(record(pattern, 0));
}
STIPPLE_INLINE void stipple_start_regions(const char* pattern) {
  void (*record)(const char*, int);
  STIPPLE_RUNTIME_FUNCTION(stipple_switch_regions, record);
  if (record) STIPPLE_CALL(record(pattern, 1));
}

/* Simulated time: for programs that a simulator runs, with the runtime of flavour sim linked into
 * them (docs/architecture.md, "Simulated machines"). Nothing happens elsewhere. */

/* A message on its way through the machine's network, from when its first byte left until its last
 * one was there. */
struct stipple_transmission {
  uint64_t begin_ns, end_ns;
  uint64_t bytes;   /* with what the network adds */
  int32_t receiver; /* world rank */
  int32_t reserved;
};

/* What the simulator tells the runtime of this rank. */
struct stipple_simulator {
  uint64_t (*now_ns)(void);    /* the time, all that was charged included; never goes back */
  void (*charge)(uint64_t ns); /* this rank works for so long */
  void (*settle)(void);        /* all that was charged passes, for all the machine to see */
  void (*end)(void);           /* after MPI_Finalize: from now on the time stands */
  uint64_t (*send_ns)(uint64_t bytes);    /* what the system takes to start a message */
  uint64_t (*receive_ns)(uint64_t bytes); /* and to take one */
  int (*next_transmission)(
      struct stipple_transmission*); /* 0: no further one of this rank has ended */
  uint64_t event_ns;                 /* what recording an event costs on the simulated machine */
};

/* Before the first event; `simulator` stays. */
STIPPLE_INLINE void stipple_simulated_by(const struct stipple_simulator* simulator) {
  void (*set)(const struct stipple_simulator*);
  STIPPLE_RUNTIME_FUNCTION(stipple_set_simulator, set);
  if (set) STIPPLE_CALL(set(simulator));
}

/* The program has worked for so long on the simulated machine. */
STIPPLE_INLINE void stipple_charge(uint64_t ns) {
  void (*charge)(uint64_t);
  STIPPLE_RUNTIME_FUNCTION(stipple_charge_ns, charge);
  if (charge) STIPPLE_CALL(charge(ns));
}

#ifdef __cplusplus
}
#endif

#if defined(__cplusplus) && __cplusplus >= 201103L
#define STIPPLE_MEMBER __attribute__((no_instrument_function))
namespace stipple {

/* A visit of a region that lasts as long as this object, or until End(): also when an exception
 * passes by. It ends on the thread that destroys it, which should be the one that made it. */
class Scope {
 public:
  STIPPLE_MEMBER explicit Scope(stipple_region& region) noexcept : region_(&region) {
    stipple_region_begin(region_);
  }
  STIPPLE_MEMBER Scope(Scope&& other) noexcept : region_(other.region_) { other.region_ = nullptr; }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
  STIPPLE_MEMBER ~Scope() { End(); }

  STIPPLE_MEMBER void End() noexcept {
    if (region_ != nullptr) stipple_region_end(region_);
    region_ = nullptr;
  }

 private:
  stipple_region* region_;
};

/* Hidden: as a plain variable of an inline function GCC would make it unique in the process, and a
 * library with it could not be unloaded. */
struct __attribute__((visibility("hidden"))) ScopeRegion {
  stipple_region region;
};

}  // namespace stipple

/* The rest of the enclosing block is a region. STIPPLE_SCOPE("solve"); */
#define STIPPLE_SCOPE(name) STIPPLE_SCOPE_AT(name, __LINE__)
#define STIPPLE_SCOPE_AT(name, line) STIPPLE_SCOPE_NAMED(name, line)
#define STIPPLE_SCOPE_NAMED(name, line)                                                  \
  static ::stipple::ScopeRegion stipple_region_##line = {{name, __FILE__, __LINE__, 0}}; \
  const ::stipple::Scope stipple_scope_##line(stipple_region_##line.region)
#endif

#endif
