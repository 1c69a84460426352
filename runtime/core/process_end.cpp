// SPDX-License-Identifier: MIT
// Return from main and exit: libc calls back, with the status. The callback is asked for while this
// library is loaded, before the loader's own is, so it comes after every destructor of every
// object.
#include "runtime/core/process_end.h"

#include <stdlib.h>

#include "runtime/core/process.h"

namespace stipple {
namespace {

constinit bool asked = false;

void AtExit(int status, void*) { NoteEnd(Ending::kExit, status); }

__attribute__((constructor(101))) void PrepareIfAsked() {
  if (getenv("STIPPLE_ARCHIVE") != nullptr) PrepareEnd();
}

}  // namespace

void PrepareEnd() {
  if (asked) return;
  asked = true;
  on_exit(AtExit, nullptr);
}

}  // namespace stipple
