// SPDX-License-Identifier: MIT
// The two flavours of the runtime. The usual one records a process and its threads on the machine's
// clock. With STIPPLE_SIMULATED it is linked into a program of which a simulator runs many copies
// in one thread of one process, each a rank with variables of its own (docs/architecture.md,
// "Simulated machines"): the time is the simulator's, every event asks for it, and there are no
// other threads and no signal handlers to be careful about.
#ifndef STIPPLE_RUNTIME_CORE_FLAVOUR_H
#define STIPPLE_RUNTIME_CORE_FLAVOUR_H

// A thousand copies of a library exhaust the room for thread-local variables that code finds
// without asking; a rank is one thread, so that plain variables are as good.
#ifdef STIPPLE_SIMULATED
#define STIPPLE_PER_THREAD
#else
#define STIPPLE_PER_THREAD __thread
#endif

namespace stipple {

#ifdef STIPPLE_SIMULATED
inline constexpr bool kSimulated = true;
#else
inline constexpr bool kSimulated = false;
#endif

}  // namespace stipple

#endif
