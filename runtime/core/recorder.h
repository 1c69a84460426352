// SPDX-License-Identifier: MIT
// What the other runtime libraries (MPI layer, system, unwind) and user.h call in the core.
// Exported by libstipple.so; every function may be called from any thread, from a signal handler,
// before or after main, and leaves errno alone.
#ifndef STIPPLE_RUNTIME_CORE_RECORDER_H
#define STIPPLE_RUNTIME_CORE_RECORDER_H

#include <stddef.h>
#include <stdint.h>

// user.h
struct stipple_channel;
struct stipple_name;
struct stipple_region;
struct stipple_simulator;

/// What a library that records beside the events wants to be told; null: nothing. Called in the
/// thread that it is about, with signals blocked and no lock held. Events of such a call are lost.
struct stipple_observer {
  void (*thread_began)(uint32_t thread, uint32_t tid);  // it has got its stream
  void (*chunk_taken)(void);                            // of events
  void (*thread_ends)(void);
  void (*process_ends)(void);  // in order, or by exec: that may still fail
  void (*call_left)(void);     // stipple_leave; signals are not blocked
};

#pragma GCC visibility push(default)
extern "C" {

/// Begins this process's stream if it has not begun; until this or the first stipple_register the
/// core does nothing. Returns whether the process records at all (false: no archive named, or it
/// cannot be written).
bool stipple_begin();

/// Whether events are being recorded now: the stream has begun, and nobody has switched it off.
bool stipple_recording();

/// The id of a region, defined at first use; the same name, file and line give the same id. Kind:
/// RegionKind. 0 when nothing is recorded or ids have run out.
uint32_t stipple_define_region(const char* name, const char* file, uint32_t line, uint32_t kind);

/// Full 64-bit ticks of the archive's clock.
uint64_t stipple_ticks();

/// Record that this thread entered or left `region` now, always with the clock; return the ticks
/// recorded.
uint64_t stipple_enter(uint32_t region);
uint64_t stipple_leave(uint32_t region);

/// Appends an extended event record (format.h) to this thread's stream. `record` begins with its
/// header word, whose kind is set by the core from `kind`; `bytes` is a multiple of 8.
void stipple_append(const void* record, uint8_t kind, size_t bytes);

/// Appends a definition to the process's definition chunks; `text` follows the struct, zero-padded
/// by the core.
void stipple_define(const void* record, uint8_t kind, size_t bytes, const void* text,
                    size_t text_bytes);

/// A place for an extended record of `bytes` in this thread's stream, which the caller writes: open
/// header, payload, closed header. Null: not recorded. Nothing but stores may come in between.
uint64_t* stipple_reserve(size_t bytes);

/// Id of a name and its unit for Counter, Mark and SystemCall; 0 when nothing is recorded.
uint32_t stipple_define_name(const char* name, const char* unit);

/// Takes a chunk of `kind` (ChunkKind) of `bytes` (a multiple of 16384) for the caller to fill
/// behind its header: mapped, zero, its header written. Null: recording has stopped.
char* stipple_take_chunk(uint32_t kind, uint32_t thread, uint32_t tid, uint64_t sequence,
                         uint64_t lost, size_t bytes);

/// Gives this thread a stream of its own if it has none and the process records.
void stipple_begin_thread(void);

/// From now on `observer`, which must stay, is told. A few can be: false if there are too many.
bool stipple_observe(const struct stipple_observer* observer);

// user.h
void stipple_record_mark(struct stipple_name* name);
void stipple_record_counter(struct stipple_name* name, double value);
void stipple_record_host(void);
void stipple_record_begin(struct stipple_region* region);
void stipple_record_end(struct stipple_region* region);
void stipple_record_send(struct stipple_channel* channel, uint64_t key, uint64_t bytes);
void stipple_record_receive(struct stipple_channel* channel, uint64_t key, uint64_t bytes,
                            uint64_t waiting_since);
uint32_t stipple_define_channel(const char* name);
void stipple_set_simulator(const struct stipple_simulator* simulator);
void stipple_charge_ns(uint64_t ns);
void stipple_switch(int on);
void stipple_switch_regions(const char* pattern, int on);
}
#pragma GCC visibility pop

#endif
