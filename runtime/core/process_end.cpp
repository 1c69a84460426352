// SPDX-License-Identifier: MIT
// Return from main and exit: libc calls back, with the status. The callback is asked for while this
// library is loaded, before the loader's own is, so it comes after every destructor of every
// object.
#include "runtime/core/process_end.h"

#include <stdlib.h>

#include "runtime/core/process.h"

namespace stipple {
namespace {

#ifdef STIPPLE_SIMULATED

/// The simulator may unload a rank's copy of the program before it exits.
__attribute__((destructor(101))) void AtUnload() { NoteEnd(Ending::kExit, 0); }

#else

constinit bool asked = false;

void AtExit(int status, void*) { NoteEnd(Ending::kExit, status); }

__attribute__((constructor(101))) void PrepareIfAsked() {
  if (getenv("STIPPLE_ARCHIVE") != nullptr) PrepareEnd();
}

#endif

}  // namespace

void PrepareEnd() {
#ifndef STIPPLE_SIMULATED
  if (asked) return;
  asked = true;
  on_exit(AtExit, nullptr);
#endif
}

}  // namespace stipple
