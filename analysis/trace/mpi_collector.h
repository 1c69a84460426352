// SPDX-License-Identifier: MIT
// Collects what one location did with MPI, from the events of its scan: MPI functions and records.
// Marks and messages between threads come with them.
#ifndef STIPPLE_ANALYSIS_TRACE_MPI_COLLECTOR_H
#define STIPPLE_ANALYSIS_TRACE_MPI_COLLECTOR_H

#include <cstdint>
#include <vector>

#include "analysis/trace/mpi_activity.h"
#include "analysis/trace/trace.h"

namespace stipple {

class MpiCollector {
 public:
  MpiCollector(const Trace& trace, const Location& location);

  /// Whether Function wants to see the events of this region of the process.
  bool Wants(std::uint32_t region) const { return is_mpi_[region] != 0; }
  void Function(std::uint32_t region, bool leave, std::uint64_t ticks);
  void Record(const EventWord* record, std::uint64_t ticks);
  /// A call that is open at the end of the location ends there.
  LocationActivity Finish();

 private:
  std::uint32_t Defined(std::uint32_t communicator);
  const Communicator& At(std::uint32_t c) const { return trace_.communicators()[c]; }
  std::int64_t CallBegin(std::uint64_t ticks) const;
  void Called(const SystemCall& r, std::uint64_t ticks);
  void Marked(const Mark& r, std::uint64_t ticks);
  void Handed(const ThreadSend& r, std::uint64_t ticks);
  void Taken(const ThreadReceive& r, std::uint64_t ticks);
  void Send(const MpiSend& r, std::uint64_t ticks);
  void Receive(const MpiReceive& r, std::uint64_t ticks);
  void Collective(const MpiCollective& r, std::uint64_t ticks);
  void Probe(const MpiProbe& r, std::uint64_t ticks);
  void Transmitted(const Transmission& r);

  const Trace& trace_;
  const Location& location_;
  const Process& process_;
  LocationActivity out_;
  std::vector<std::uint8_t> is_mpi_;
  std::uint32_t depth_ = 0;
  std::uint32_t call_ = kNoIndex;  // open
  std::uint32_t call_order_ = 0;
  std::uint32_t order_ = 0;
};

}  // namespace stipple

#endif
