// SPDX-License-Identifier: MIT
// What is written when a signal ends the process. Only in the shared library.
#ifndef STIPPLE_RUNTIME_CORE_CRASH_H
#define STIPPLE_RUNTIME_CORE_CRASH_H

#include <ucontext.h>

#include "runtime/core/process.h"

namespace stipple {

/// Another thread of the process has crashed and wants this one's stack: writes it, and waits for
/// the process to end.
bool AnswerCrash(ucontext_t* context);

}  // namespace stipple

#endif
