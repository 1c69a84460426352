// SPDX-License-Identifier: MIT
// What the kernel told of a thread: its context switches and counts. They stand in chunks of their
// own with nanoseconds of CLOCK_MONOTONIC_RAW; here they get the times of the archive.
#ifndef STIPPLE_ANALYSIS_TRACE_KERNEL_H
#define STIPPLE_ANALYSIS_TRACE_KERNEL_H

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/stream.h"
#include "analysis/trace/trace.h"
#include "stipple/format.h"

namespace stipple {

/// Ticks of a stream at nanoseconds of CLOCK_MONOTONIC_RAW: linear between the pairs of both that
/// it has, with the mean rate beyond them.
class RawClock {
 public:
  /// `ns_per_tick` counts where the stream has no two pairs.
  RawClock(const Stream& stream, double ns_per_tick);
  std::uint64_t Ticks(std::uint64_t raw_ns) const;

 private:
  std::vector<ClockPair> pairs_;
  double ns_per_tick_;
};

/// A thread was off its processor; `count` times, if it was a run of short absences.
struct Absence {
  std::int64_t out_ns = 0;
  std::int64_t in_ns = 0;  // not back: the end of the archive
  std::int64_t away_ns = 0;
  std::uint32_t count = 1;
  bool blocked = false;
  bool migrated = false;
  bool is_back = true;
};

/// A count that the kernel or the processor keeps of a thread had this value.
struct KernelCount {
  std::int64_t time_ns = 0;
  std::uint32_t name = 0;  // in Trace::names
  double value = 0;
};

struct KernelAccount {
  std::vector<Absence> absences;    // by in_ns
  std::vector<KernelCount> counts;  // by time
};

/// Everything that the kernel told of one location.
KernelAccount ReadKernel(const Trace& trace, const Location& location);

/// Calls `record(word, raw_ns)` for each sound record of the kernel's chunks; what is damaged goes
/// to `counts`.
void ForEachKernelRecord(const ThreadStream& thread, ScanCounts& counts,
                         const std::function<void(const EventWord*, std::uint64_t)>& record);

/// Whether the system's time lies within calls of MPI: on simulated machines it is what messages
/// take to start. Waiting, which switches tell of, is no part of it.
inline bool SystemIsInMpi(const Trace& trace) { return trace.clock().kind == ClockKind::kVirtual; }

/// Whether the process of this location says that it has recorded `what` (Availability).
bool HasRecorded(const Trace& trace, const Location& location, std::string_view what);

/// A system call by its number; null: not known.
struct SystemCallEntry {
  std::string_view name;
  unsigned parameters;
};
const SystemCallEntry* SystemCallOf(std::uint32_t number);

/// "read", or the libc function's name if it is called otherwise; "call 999" if it is not known.
std::string NameOf(const Trace& trace, const Process& process, const SystemCall& call);

/// Whether a result that is not negative counts bytes.
bool MovesBytes(std::uint32_t number);

}  // namespace stipple

#endif
