// SPDX-License-Identifier: MIT
// Native stacks as the archive holds them. libunwind does the work, in a library of its own that is
// opened when the process begins to record; without it only frame pointers are followed.
#ifndef STIPPLE_RUNTIME_CORE_NATIVE_STACK_H
#define STIPPLE_RUNTIME_CORE_NATIVE_STACK_H

#include <ucontext.h>

#include <cstdint>

#include "stipple/format.h"

namespace stipple {

struct NativeStack {
  std::uint32_t count;
  std::uint32_t cut;  // as in Sample
  std::uint64_t frames[kMostFrames];
};

/// Opens the unwinder, once. In the program's own context: the loader allocates.
void OpenUnwinder();
/// Whether it is there; error: ENOENT or the like.
bool HaveUnwinder();

/// Makes this thread's first stack one that needs no memory. In the program's own context.
void PrepareUnwinding();

/// The stack that a signal interrupted, on this thread. `quick`: cached, for samples; a stack
/// longer than kMostFrames loses its outer frames.
void ReadStack(ucontext_t* context, bool quick, NativeStack& stack);

/// The caller's stack, without the frames of the runtime's own libraries.
void ReadStackHere(NativeStack& stack);

/// A signal handler for faults calls this first: if reading a stack went wrong, it does not return.
void LeaveFaultyStack();

/// Around fork: no other thread is reading a stack meanwhile, so none of its locks is held in the
/// child.
void HoldUnwinding();
void ReleaseUnwinding();
/// In the child: if another thread was reading after all, no stack is read here.
void ReleaseUnwindingInChild();

}  // namespace stipple

#endif
