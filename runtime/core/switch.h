// SPDX-License-Identifier: MIT
// Recording switched off and on while the program runs: by the program (user.h) or by a signal.
#ifndef STIPPLE_RUNTIME_CORE_SWITCH_H
#define STIPPLE_RUNTIME_CORE_SWITCH_H

#include <atomic>
#include <cstdint>

#include "runtime/core/process.h"

namespace stipple {

/// Whether the process is to record events. Inherited by a forked child.
extern std::atomic<bool> switched_on;
inline bool IsSwitchedOn() { return switched_on.load(std::memory_order_relaxed); }

/// Begins switched off; SIGUSR2 switches from now on unless the program wants that signal itself.
void BeginPaused();

/// Notes that a region (0: everything) was switched now. The lock is held.
void DefineSwitch(Process& process, bool on, std::uint32_t region);

/// Notes what is switched off when a stream begins. The lock is held.
void DefineSwitches(Process& process);

}  // namespace stipple

#endif
