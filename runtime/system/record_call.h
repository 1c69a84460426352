// SPDX-License-Identifier: MIT
// Writes the record of one system call.
#ifndef STIPPLE_RUNTIME_SYSTEM_RECORD_CALL_H
#define STIPPLE_RUNTIME_SYSTEM_RECORD_CALL_H

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime/core/clock.h"
#include "runtime/core/recorder.h"
#include "stipple/format.h"

namespace stipple::system {

/// A call that has just returned. Stores only: errno stays what it was.
// NOLINTNEXTLINE(readability-function-size): a system call has that many facts.
inline void RecordCall(std::uint32_t number, std::uint32_t name, std::uint64_t enter_ticks,
                       std::int64_t result, const std::uint64_t* parameters, std::size_t count) {
  const std::size_t bytes = sizeof(SystemCall) + count * sizeof(std::uint64_t);
  std::uint64_t* place = stipple_reserve(bytes);
  if (place == nullptr) return;
  std::atomic_ref<EventWord> header(*place);
  header.store(MakeHeader(SystemCall::kKind, bytes / 8, false), std::memory_order_release);
  place[1] = ReadTicks();
  place[2] = enter_ticks;
  place[3] = static_cast<std::uint64_t>(result);
  place[4] = number | std::uint64_t{name} << 32;
  for (std::size_t i = 0; i < count; ++i) place[5 + i] = parameters[i];
  header.store(MakeHeader(SystemCall::kKind, bytes / 8, true), std::memory_order_release);
}

}  // namespace stipple::system

#endif
