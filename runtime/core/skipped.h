// SPDX-License-Identifier: MIT
// Visits that this thread entered while recording was switched off. Only those whose exits are told
// nothing by the enter need to be remembered: the hooks of -finstrument-functions and the calls of
// other libraries. With nothing skipped, which is always so in a run without switching, an exit
// costs one test more.
#ifndef STIPPLE_RUNTIME_CORE_SKIPPED_H
#define STIPPLE_RUNTIME_CORE_SKIPPED_H

#include <cstdint>

#include "runtime/core/flavour.h"

namespace stipple {

struct SkippedVisits;
extern STIPPLE_PER_THREAD SkippedVisits*
    skipped_visits;  // of this thread; null until there was one

/// Remembers a visit of `what` (an address, or a region) whose hook runs in `frame`.
void NoteSkipped(std::uintptr_t what, const void* frame);

bool TakeSkippedSlowly(std::uintptr_t what, const void* frame);

/// Whether the visit that ends now was skipped; forgets it and, with it, visits within that ended
/// without an exit.
inline bool TakeSkipped(std::uintptr_t what, const void* frame) {
  return skipped_visits != nullptr && TakeSkippedSlowly(what, frame);
}

/// The thread ends.
void ForgetSkipped();

}  // namespace stipple

#endif
