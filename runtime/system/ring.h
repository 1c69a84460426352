// SPDX-License-Identifier: MIT
// A thread's context switches, from the ring in which the kernel notes them.
#ifndef STIPPLE_RUNTIME_SYSTEM_RING_H
#define STIPPLE_RUNTIME_SYSTEM_RING_H

#include "runtime/system/thread.h"

namespace stipple::system {

/// Gives this thread a ring; 0 or an errno.
int OpenRing(KernelThread& thread);

/// Whether it is time to read the ring. Any thread, any time.
inline bool IsRingHalfFull(const KernelThread& thread) {
  const perf_event_mmap_page* ring = thread.ring;
  return ring != nullptr &&
         __atomic_load_n(&ring->data_head, __ATOMIC_RELAXED) - thread.tail > thread.ring_bytes / 2;
}

/// Makes records of what is in the ring. The caller drains.
void ReadRing(KernelThread& thread);

/// The same, and that the thread is still off its processor if it is. `last`: nothing comes after.
void FinishRing(KernelThread& thread);

/// Gives the ring back. The thread itself.
void CloseRing(KernelThread& thread);

}  // namespace stipple::system

#endif
