// SPDX-License-Identifier: MIT
// Libraries that record beside the events are told of threads and chunks (recorder.h).
#ifndef STIPPLE_RUNTIME_CORE_OBSERVER_H
#define STIPPLE_RUNTIME_CORE_OBSERVER_H

#include <atomic>
#include <cstdint>

#include "runtime/core/recorder.h"

namespace stipple {

inline constexpr int kMostObservers = 4;
/// Those there are, then nulls.
extern std::atomic<const stipple_observer*> observers[kMostObservers];

/// Calls the member of each observer that has it.
template <class... Arguments>
void Tell(void (*stipple_observer::*member)(Arguments...), Arguments... arguments) {
  for (const std::atomic<const stipple_observer*>& entry : observers) {
    const stipple_observer* observer = entry.load(std::memory_order_acquire);
    if (observer == nullptr) return;
    if (auto* function = observer->*member) function(arguments...);
  }
}

}  // namespace stipple

#endif
