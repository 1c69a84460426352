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

// user.h
void stipple_record_mark(struct stipple_name* name);
void stipple_record_counter(struct stipple_name* name, double value);
void stipple_record_host(void);
void stipple_record_begin(struct stipple_region* region);
void stipple_record_end(struct stipple_region* region);
void stipple_record_send(struct stipple_channel* channel, uint64_t key, uint64_t bytes);
void stipple_record_receive(struct stipple_channel* channel, uint64_t key, uint64_t bytes,
                            uint64_t waiting_since);
uint32_t stipple_define_name(const char* name, const char* unit);
uint32_t stipple_define_channel(const char* name);
void stipple_switch(int on);
void stipple_switch_regions(const char* pattern, int on);
}
#pragma GCC visibility pop

#endif
