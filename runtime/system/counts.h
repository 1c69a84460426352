// SPDX-License-Identifier: MIT
// What the kernel and the processor count of a thread anyway: page faults, switches, instructions.
#ifndef STIPPLE_RUNTIME_SYSTEM_COUNTS_H
#define STIPPLE_RUNTIME_SYSTEM_COUNTS_H

#include "runtime/system/thread.h"

namespace stipple::system {

/// Begins this thread's hardware counters; 0 or an errno.
int OpenCounters(KernelThread& thread);
void CloseCounters(KernelThread& thread);

/// Appends this thread's counts, as Counter records. The caller drains.
void NoteOwnCounts(KernelThread& thread);
/// Those of another thread of the process: without the hardware's.
void NoteCountsOf(KernelThread& thread);

}  // namespace stipple::system

#endif
