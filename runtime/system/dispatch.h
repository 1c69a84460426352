// SPDX-License-Identifier: MIT
// All system calls of a thread, also those made without libc (dispatch.cpp).
#ifndef STIPPLE_RUNTIME_SYSTEM_DISPATCH_H
#define STIPPLE_RUNTIME_SYSTEM_DISPATCH_H

#include "runtime/system/thread.h"

namespace stipple::system {

// SYSCALL_DISPATCH_FILTER_ALLOW and _BLOCK
inline constexpr unsigned char kAllow = 0, kBlock = 1;

/// From now on every system call of this thread is seen; 0 or an errno.
int Arm(KernelThread& thread);
/// No longer. The thread itself.
void Disarm(KernelThread& thread);

/// While it lives, this thread's system calls are the runtime's, or known already.
class Allowed {
 public:
  explicit Allowed(KernelThread* thread) : thread_(thread) {
    if (thread_ != nullptr && thread_->dispatched) thread_->selector = kAllow;
  }
  // Not to what it was before: whoever was left by a jump did not come back here.
  ~Allowed() {
    if (thread_ != nullptr && thread_->dispatched) thread_->selector = kBlock;
  }
  Allowed(const Allowed&) = delete;
  Allowed& operator=(const Allowed&) = delete;

 private:
  KernelThread* thread_;
};

}  // namespace stipple::system

#endif
