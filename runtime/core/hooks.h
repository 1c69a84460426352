// SPDX-License-Identifier: MIT
// What only the shared library does at certain moments: a static program has none of it, and the
// places that call these need not know. Set once, by constructors.
#ifndef STIPPLE_RUNTIME_CORE_HOOKS_H
#define STIPPLE_RUNTIME_CORE_HOOKS_H

#include "runtime/core/process.h"
#include "stipple/format.h"

namespace stipple {

struct Hooks {
  void (*process_begun)();            // the lock is held
  void (*definitions)(Process&);      // likewise, and definitions can be written
  void (*recording)();                // in the program's own context: may load and allocate
  void (*thread_begun)();             // this thread has a stream; signals are blocked
  void (*thread_ended)();             // likewise, and will have no events but late ones
  void (*appended)(RecordKind kind);  // a record stands in this thread's stream
  void (*process_ending)(Process&);   // before the end is noted; signals are blocked
};
extern Hooks hooks;

}  // namespace stipple

#endif
