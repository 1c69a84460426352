// SPDX-License-Identifier: MIT
// Native stacks by libunwind. The core opens this library by name and looks these two up; they may
// be called from a signal handler, never allocate by malloc once a thread has called the first, and
// give code addresses, innermost first.
#ifndef STIPPLE_RUNTIME_UNWIND_UNWIND_H
#define STIPPLE_RUNTIME_UNWIND_UNWIND_H

#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)
extern "C" {

/// The stack of the caller, itself included, through signal frames; cached, 10 ns a frame.
size_t stipple_unwind_here(uintptr_t* frames, size_t most);

/// The stack that a signal interrupted (`context`: its ucontext_t). One longer than `most` has its
/// outermost `outer` frames at the end, and `cut` says how many are missing before them.
size_t stipple_unwind_from(void* context, uintptr_t* frames, size_t most, size_t outer,
                           size_t* cut);
}
#pragma GCC visibility pop

#endif
