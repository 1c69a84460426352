// SPDX-License-Identifier: MIT
// user.h: marks, counters, the host.
#include "stipple/user.h"

#include "runtime/core/clock.h"
#include "runtime/core/process.h"
#include "runtime/core/recorder.h"
#include "runtime/core/region.h"

namespace stipple {
namespace {

/// The name's id, given at its first use; 0 when nothing is recorded.
std::uint32_t IdOf(stipple_name* name) {
  std::atomic_ref<std::uint32_t> id(name->id);
  const std::uint32_t known = id.load(std::memory_order_acquire);
  if (known != 0) return known;
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return 0;
  Holding holding(process->lock);
  const std::uint32_t given = NameId(*process, name->name, name->unit);
  id.store(given, std::memory_order_release);
  return given;
}

}  // namespace
}  // namespace stipple

extern "C" {

void stipple_record_mark(struct stipple_name* name) {
  stipple::Mark record{};
  record.name = stipple::IdOf(name);
  if (record.name == 0) return;
  record.ticks = stipple::ReadTicks();
  stipple_append(&record, static_cast<uint8_t>(stipple::Mark::kKind), sizeof record);
}

void stipple_record_counter(struct stipple_name* name, double value) {
  stipple::Counter record{};
  record.name = stipple::IdOf(name);
  if (record.name == 0) return;
  record.value = value;
  record.ticks = stipple::ReadTicks();
  stipple_append(&record, static_cast<uint8_t>(stipple::Counter::kKind), sizeof record);
}

void stipple_record_host(void) {
  const stipple::DefineHost record{};
  stipple_define(&record, static_cast<uint8_t>(stipple::DefineHost::kKind), sizeof record, nullptr,
                 0);
}
}
