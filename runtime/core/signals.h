// SPDX-License-Identifier: MIT
// Signal handlers of the runtime beside those of the program. Only in the shared library.
#ifndef STIPPLE_RUNTIME_CORE_SIGNALS_H
#define STIPPLE_RUNTIME_CORE_SIGNALS_H

#include <signal.h>
#include <ucontext.h>

namespace stipple {

using Handler = void(int signal, siginfo_t* info, void* context);

/// The signal that asks a thread for its stack: samples, and the other threads of a crash. Its
/// default is to be ignored, so one that comes late, or after exec, does no harm; programs hardly
/// use it (out-of-band data of sockets).
inline constexpr int kAskSignal = SIGURG;

/// What StandIn needs of libc: looked up while the library is loaded, since the loader's lock must
/// not be waited for later. False: StandIn must not be called.
bool PrepareStandIns();

/// Stands in for the default action of `signal` from now on, as long as the program wants that
/// one: what the program sees of it is SIG_DFL. Nothing if it has a handler or ignores it. Signals
/// that come meanwhile are held back, but for faults.
void StandIn(int signal, Handler* handler);

/// Calls what the program has for a signal that `StandIn` took and that is not the runtime's.
void PassOn(int signal, siginfo_t* info, void* context);

/// The default action of `signal`, with this information, once the handler has returned.
void LetDie(int signal, const siginfo_t* info);

/// Gives this thread a stack for signal handlers if it has none; takes it away again.
void AddSignalStack();
void DropSignalStack();

}  // namespace stipple

#endif
