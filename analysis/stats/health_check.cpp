// SPDX-License-Identifier: MIT
#include "analysis/stats/health_check.h"

#include <cstdint>
#include <vector>

#include "analysis/stats/call_stack.h"
#include "analysis/trace/mpi_activity.h"

namespace stipple {
namespace {

/// Follows the call stack and looks up names.
struct Balance {
  explicit Balance(const Process& p) : process(p), stack(p.RegionCount()) {}
  void Function(std::uint32_t region, bool leave, std::uint64_t) {
    if (!leave) {
      stack.Enter(region);
    } else if (!stack.Leave(region, [](std::uint32_t) {})) {
      ++unmatched;
    }
  }
  void Record(const EventWord* record, std::uint64_t) {
    if (KindOf(*record) == RecordKind::kMark)
      undefined_names += process.NameOf(RecordAt<Mark>(record).name) == 0;
    if (KindOf(*record) == RecordKind::kCounter)
      undefined_names += process.NameOf(RecordAt<Counter>(record).name) == 0;
  }
  const Process& process;
  CallStack stack;
  std::uint64_t unmatched = 0;
  std::uint64_t undefined_names = 0;
};

}  // namespace

TraceHealth CheckArchive(const Trace& trace) {
  TraceHealth balance_health;
  for (const Location& l : trace.locations()) {
    const Process& process = trace.ProcessOf(l);
    Balance balance(process);
    trace.Scan(l, balance);
    const std::string& where = process.stream->file_name;
    // A forked child leaves the functions that its parent had entered.
    if (process.stream->header.forked == 0)
      balance_health.Add(Defect::kLeaveWithoutEnter, where, balance.unmatched);
    balance_health.Add(Defect::kUndefinedName, where, balance.undefined_names);
  }
  TraceHealth health = trace.Health();
  health.Add(balance_health);
  health.Add(ReadMpiActivity(trace).health);
  return health;
}

}  // namespace stipple
