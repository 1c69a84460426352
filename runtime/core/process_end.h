// SPDX-License-Identifier: MIT
// Notices how the process ends.
#ifndef STIPPLE_RUNTIME_CORE_PROCESS_END_H
#define STIPPLE_RUNTIME_CORE_PROCESS_END_H

namespace stipple {

/// Asks libc to say when the program returns from main or calls exit.
void PrepareEnd();

}  // namespace stipple

#endif
