/* SPDX-License-Identifier: MIT */
/* clang-format off: the code below is laid out by hand */
/* ABI 1: what instrumented code and the runtime know of each other. C and C++.
 *
 * The plugin gives each instrumented function a `stipple_descriptor` in section `stipple_desc` of
 * its object file and, at entry and at each exit, code that appends one 8-byte event word
 * (format.h). Each shared object (and the program) holds one hidden `stipple_dso` block and, in
 * .init_array / .fini_array, a constructor that calls the weak `stipple_register` and a destructor
 * that calls the weak `stipple_unregister`. Without a runtime the id slots stay 0 and each event is
 * a load and a test.
 *
 * The code of an event, enter (leave: the same, without the load of the slot, and with bit 23 set
 * in the word):
 *
 *     token = descriptor.id                    enter hands it to every exit of the same visit
 *     if (token == 0) done                     off, filtered or not registered
 *     if (token & mode bits) slow              an enter may count by itself; see below
 *     control = *(thread pointer + dso.tp_offset)
 *     slot = xadd(control.cur, 8)              one instruction: no signal handler comes between
 *     if (slot >= control.end) slow
 *     time = (slot & control.clock_mask) == 0 ? rdtsc << 24 : 0
 *     *slot = time | token                     not zero: this is the commit
 *
 * `slow` is a jump, not a call, so that neither red zone nor unwind tables of the function need to
 * know of it: eax = token (leave: token | STIPPLE_LEAVE), r11 = address to come back to, inside the
 * function and its unwind table; it comes back by `notrack jmp` with eax = the token for the exits
 * (enter) and every other register as it was, but for rdx, r11 and the flags. Where the code of an
 * event is a routine that the function calls, 128 bytes below its stack pointer, it may also come
 * back by `ret` to the routine's caller, 4 bytes before r11, if the return address is still there.
 *
 * A visit that is only counted (STIPPLE_COUNT_ONLY) an enter may count by itself:
 *
 *     words = control.counts
 *     if (words == 0) slow                     the runtime wants to be asked
 *     if (--low half of words[region] >= 0)    one instruction, no signal handler comes between
 *       { token = 0; done }                    the exits have nothing to do
 *     ++low half of words[region]; slow        due: the slow path finds the word as it was
 *
 * A slot holds at most one of the modes STIPPLE_COUNT_ONLY and STIPPLE_NO_CLOCK. Of the visits of
 * such a region the runtime makes one in about a thousand a sample: an enter with a time, whose
 * exits get a token with STIPPLE_SAMPLED and so come to the slow path again. */
/* clang-format on */
#ifndef STIPPLE_ABI_H
#define STIPPLE_ABI_H

#define STIPPLE_ABI 1

/* The id slot: region in the low 23 bits (0: no events), mode in the high byte. */
#define STIPPLE_REGION_MASK 0x007fffff
#define STIPPLE_LEAVE 0x00800000      /* in an event word and in eax of `slow`, never in a slot */
#define STIPPLE_COUNT_ONLY 0x01000000 /* count the visit, write no event; the exit's token is 0 */
#define STIPPLE_NO_CLOCK 0x02000000   /* write the event without reading the clock */
#define STIPPLE_SAMPLED 0x04000000    /* a timed visit of such a region: in an exit's token, never in
                                         a slot; the bits above number the thread's open ones */
#define STIPPLE_SAMPLED_SHIFT 27
#define STIPPLE_MODE_MASK 0xff000000  /* any of these: the slow path */

#ifndef __ASSEMBLER__

#include <stdint.h>

/* One instrumented function. Strings are found relative to the field, so nothing needs relocation
 * at load. */
struct stipple_descriptor {
  uint32_t id;   /* the slot: written by the runtime, read by each enter */
  uint32_t line; /* where the function is defined; 0 if unknown */
  int64_t name;  /* linkage name (mangled, without clone suffix): address of this field + value */
  int64_t file;  /* source file as the compiler was given it: address of this field + value */
};

/* One thread's stream. Lies in a page that is zero in a forked child (MADV_WIPEONFORK), which makes
 * the child's first event take the slow path. The thread pointer + tp_offset holds the address of
 * the control block. */
struct stipple_control {
  uint64_t cur;        /* address of the next free slot */
  uint64_t end;        /* first address behind the chunk; 0: always slow */
  uint64_t clock_mask; /* the clock is read when (slot address & clock_mask) == 0 */
  uint64_t* counts;    /* null: every visit of the two modes takes the slow path; else words by region:
                          the low half counts down, the high half is the runtime's */
};

/* One shared object or program. */
struct stipple_dso {
  uint32_t abi;              /* STIPPLE_ABI of the plugin */
  uint32_t descriptor_bytes; /* sizeof(struct stipple_descriptor) of the plugin */
  int64_t tp_offset;         /* filled in by stipple_register */
  void (*slow)(void); /* filled in by stipple_register; see above, not callable as a function */
  struct stipple_descriptor* begin;
  struct stipple_descriptor* end;
};

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Gives every descriptor of the object an id and lets it record. A dso of another ABI is left
 * untouched. The strings are copied: the object may be unloaded. The same name, file and line get
 * the same id, whichever object they are in. */
void stipple_register(struct stipple_dso* dso);

/* Sets every id of the object to 0. To be called before it is unmapped. */
void stipple_unregister(struct stipple_dso* dso);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif

#endif
