// SPDX-License-Identifier: MIT
// Of the format: records of definition chunks.
#ifndef STIPPLE_FORMAT_DEFINITIONS_H
#define STIPPLE_FORMAT_DEFINITIONS_H

#include <cstdint>

#include "stipple/format/words.h"

namespace stipple {

// Definitions. Text follows the struct: its parts without terminators, one after the other,
// zero-padded to 8 bytes.

struct DefineRegion {
  static constexpr RecordKind kKind = RecordKind::kDefineRegion;
  EventWord header;
  std::uint32_t region;
  RegionKind region_kind;
  std::uint32_t line;        // 0: unknown
  std::uint32_t name_bytes;  // linkage name
  std::uint32_t file_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineRegion) == 32);

struct DefineLocation {
  static constexpr RecordKind kKind = RecordKind::kDefineLocation;
  EventWord header;
  std::uint32_t thread;
  std::uint32_t tid;
  std::uint32_t name_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineLocation) == 24);

/// Name and unit of a mark or counter.
struct DefineName {
  static constexpr RecordKind kKind = RecordKind::kDefineName;
  EventWord header;
  std::uint32_t name;
  std::uint32_t name_bytes;
  std::uint32_t unit_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineName) == 24);

/// What messages between threads go through.
struct DefineChannel {
  static constexpr RecordKind kKind = RecordKind::kDefineChannel;
  EventWord header;
  std::uint32_t channel;
  std::uint32_t name_bytes;
};
static_assert(sizeof(DefineChannel) == 16);

/// This process is a rank of an MPI program.
struct DefineWorld {
  static constexpr RecordKind kKind = RecordKind::kDefineWorld;
  EventWord header;
  std::int32_t world_rank;
  std::int32_t world_size;
};
static_assert(sizeof(DefineWorld) == 16);

/// A communicator, numbered within the process; 1 is MPI_COMM_WORLD, 2 is MPI_COMM_SELF. The same
/// communicator on two ranks has the same parent, creation number and first member. `size` world
/// ranks follow, as int32, in rank order.
struct DefineCommunicator {
  static constexpr RecordKind kKind = RecordKind::kDefineCommunicator;
  EventWord header;
  std::uint32_t communicator;
  std::uint32_t parent;    // 0: none
  std::uint32_t creation;  // how many communicators this rank had created from the parent before
  std::int32_t size;
};
static_assert(sizeof(DefineCommunicator) == 24);

/// This process hands out work (user.h).
struct DefineHost {
  static constexpr RecordKind kKind = RecordKind::kDefineHost;
  EventWord header;
};
static_assert(sizeof(DefineHost) == 8);

/// One reading of another process's clock: `local_ticks` here and `remote_ticks` there happened
/// together, to within half of round_trip_ticks.
struct ClockSync {
  static constexpr RecordKind kKind = RecordKind::kClockSync;
  EventWord header;
  std::uint64_t local_ticks;
  std::uint64_t remote_ticks;
  std::uint64_t round_trip_ticks;  // least of all tries, local clock
  std::int32_t remote_world_rank;
  std::uint32_t tries;
};
static_assert(sizeof(ClockSync) == 40);

/// Events that could not be recorded.
struct Loss {
  static constexpr RecordKind kKind = RecordKind::kLoss;
  EventWord header;
  std::uint64_t from_ticks;
  std::uint64_t events;  // of this process, in all, when the record was written
  std::int32_t error;    // errno that began it; 0: none
  std::uint32_t reserved;
};
static_assert(sizeof(Loss) == 32);

/// The runtime saw the process's end: return from main, exit, _exit, abort or a fatal signal.
struct ProcessEnd {
  static constexpr RecordKind kKind = RecordKind::kProcessEnd;
  EventWord header;
  std::uint64_t ticks;
  std::uint64_t raw_ns;  // CLOCK_MONOTONIC_RAW at `ticks`
  std::uint64_t lost;    // events of the process that could not be recorded
  std::uint32_t how;     // 1 return or exit, 2 _exit, 3 abort, 4 exec, 5 signal (status: which)
  std::int32_t status;
};
static_assert(sizeof(ProcessEnd) == 40);

/// Visits without any event since the thread's last sample of the region (CountedEnter); `entries`
/// of (u32 region, u32 thread, u64 visits) follow.
struct VisitCounts {
  static constexpr RecordKind kKind = RecordKind::kVisitCounts;
  EventWord header;
  std::uint64_t entries;
};
static_assert(sizeof(VisitCounts) == 16);

/// What this process records, and what it could not: `what` as text, "switches", "system calls".
struct Availability {
  static constexpr RecordKind kKind = RecordKind::kAvailability;
  EventWord header;
  std::uint32_t available;  // 0 no, 1 yes
  std::int32_t error;       // errno of the probe
  std::uint32_t what_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(Availability) == 24);

/// The command line, arguments separated by a zero byte.
struct CommandLine {
  static constexpr RecordKind kKind = RecordKind::kCommandLine;
  EventWord header;
  std::uint32_t text_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(CommandLine) == 16);

/// A file with code, for functions known by address (-finstrument-functions) and native stacks: its
/// path as it was mapped, then the bytes of its build-id (none: it has none).
struct DefineModule {
  static constexpr RecordKind kKind = RecordKind::kDefineModule;
  EventWord header;
  std::uint32_t module;  // 1, 2, ...
  std::uint32_t path_bytes;
  std::uint32_t build_id_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(DefineModule) == 24);

/// Where the function of a region begins. Its definition, which stands before this one, has no name
/// but "module+0xoffset": the reader looks for the symbol.
struct DefineCode {
  static constexpr RecordKind kKind = RecordKind::kDefineCode;
  EventWord header;
  std::uint32_t region;
  std::uint32_t module;
  std::uint64_t offset;  // address as the module's file numbers it: without where it was loaded
};
static_assert(sizeof(DefineCode) == 24);

/// Recording was switched off or on: in between this process has no event but the leaves of frames
/// that were open. A process that begins switched off says so.
struct Switched {
  static constexpr RecordKind kKind = RecordKind::kSwitched;
  EventWord header;
  std::uint64_t ticks;
  std::uint32_t on;      // 0 off, 1 on
  std::uint32_t region;  // 0: everything; else this region alone
};
static_assert(sizeof(Switched) == 24);

/// What events cost in this process, measured when it began: medians, in 1/256 ticks of the clock.
/// A visit is an enter and a leave with nothing between; its inner part is what its own times hold.
struct Calibration {
  static constexpr RecordKind kKind = RecordKind::kCalibration;
  EventWord header;
  std::uint32_t timed_visit;  // both events, back to back with others
  std::uint32_t timed_inner;
  std::uint32_t sampled_visit;  // a CountedEnter and its leave, pipeline drained
  std::uint32_t sampled_inner;
  std::uint32_t no_clock_visit;
  std::uint32_t counted_visit;
  std::uint32_t clock_read;  // one reading
  std::uint32_t reserved;
};
static_assert(sizeof(Calibration) == 40);

/// A ring (--max-bytes) dropped the first chunks of a thread. One record for a thread, rewritten in
/// place with each chunk, `chunks` last: a chunk whose sequence is lower is gone, whatever is left
/// of it.
struct Overwritten {
  static constexpr RecordKind kKind = RecordKind::kOverwritten;
  EventWord header;
  std::uint32_t thread;
  std::uint32_t reserved;
  std::uint64_t chunks;
  std::uint64_t events;      // in them
  std::uint64_t bytes;       // of them
  std::uint64_t from_ticks;  // the thread's events from here on are there
};
static_assert(sizeof(Overwritten) == 48);

/// What the filter did to the functions of one object; the filter's path follows. Records add up.
struct Filtered {
  static constexpr RecordKind kKind = RecordKind::kFiltered;
  EventWord header;
  std::uint32_t functions;  // that the object brought
  std::uint32_t filtered;   // of them
  std::uint32_t path_bytes;
  std::uint32_t reserved;
};
static_assert(sizeof(Filtered) == 24);

}  // namespace stipple

#endif
