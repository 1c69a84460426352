// SPDX-License-Identifier: MIT
// The runtime's handlers stand only where the program wants the default. sigaction and signal are
// caught on their way to libc: a program that installs a handler replaces ours, one that asks what
// is there is told of the default, and one that goes back to the default gets ours again. The one
// for samples is different: it stays, and hands on what is not a sample.
#include "runtime/core/signals.h"

#include <dlfcn.h>
#include <errno.h>
#include <sys/mman.h>

#include "runtime/core/lock.h"
#include "runtime/core/syscalls.h"

namespace {

using Action = struct sigaction;
using SetAction = int(int, const Action*, Action*);

constexpr std::size_t kStackBytes = 64 * 1024;
constexpr std::size_t kGuardBytes = 4096;
constexpr int kFaults[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP, SIGABRT, SIGSYS};

constinit stipple::Handler* handlers[NSIG] = {};
constinit Action asked_for{};  // what the program wants for kAskSignal

SetAction* RealAction() {
  static constinit SetAction* real = nullptr;
  if (real == nullptr) real = reinterpret_cast<SetAction*>(dlsym(RTLD_NEXT, "sigaction"));
  return real;
}

Action OurAction(int signal) {
  Action action{};
  action.sa_sigaction = handlers[signal];
  // A fault in the handler of a fault comes back to it (LeaveFaultyStack); all others wait, so no
  // handler of the program can jump out of ours.
  action.sa_flags =
      SA_SIGINFO | SA_ONSTACK | SA_RESTART | (signal == stipple::kAskSignal ? 0 : SA_NODEFER);
  if (signal == stipple::kAskSignal) {
    sigfillset(&action.sa_mask);
    for (const int fault : kFaults) sigdelset(&action.sa_mask, fault);
  }
  return action;
}

bool IsOurs(int signal, const Action& action) {
  return handlers[signal] != nullptr && (action.sa_flags & SA_SIGINFO) != 0 &&
         action.sa_sigaction == handlers[signal];
}

bool IsDefault(const Action& action) {
  return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_DFL;
}

/// sigaction as the program sees it.
int Change(int signal, const Action* action, Action* before) {
  SetAction* real = RealAction();
  if (real == nullptr) {
    errno = ENOSYS;
    return -1;
  }
  if (signal <= 0 || signal >= NSIG || handlers[signal] == nullptr)
    return real(signal, action, before);
  if (signal == stipple::kAskSignal) {
    if (before != nullptr) *before = asked_for;
    if (action != nullptr) asked_for = *action;
    return 0;
  }
  const Action ours = OurAction(signal);
  Action was{};
  const int result = real(signal, action != nullptr && IsDefault(*action) ? &ours : action, &was);
  if (result == 0 && before != nullptr) *before = IsOurs(signal, was) ? Action{} : was;
  return result;
}

/// signal as BSD and System V have it: `flags` tells them apart.
sighandler_t SetHandler(int signal, sighandler_t handler, int flags) {
  Action action{};
  Action before{};
  action.sa_handler = handler;
  action.sa_flags = flags;
  if ((flags & SA_RESTART) != 0) sigaddset(&action.sa_mask, signal);
  return Change(signal, &action, &before) == 0 ? before.sa_handler : SIG_ERR;
}

__thread char* own_stack = nullptr;

}  // namespace

namespace stipple {

bool PrepareStandIns() { return RealAction() != nullptr; }

void StandIn(int signal, Handler* handler) {
  SetAction* real = RealAction();
  Action before{};
  if (real == nullptr || handlers[signal] != nullptr || real(signal, nullptr, &before) != 0) return;
  if (signal == kAskSignal) asked_for = before;
  handlers[signal] = handler;
  const Action ours = OurAction(signal);
  if (signal == kAskSignal || IsDefault(before)) real(signal, &ours, nullptr);
}

void PassOn(int signal, siginfo_t* info, void* context) {
  const Action action = asked_for;
  if ((action.sa_flags & SA_SIGINFO) != 0) {
    action.sa_sigaction(signal, info, context);
  } else if (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN) {
    action.sa_handler(signal);
  }
}

void LetDie(int signal, const siginfo_t* info) {
  constexpr long kBlock = 0;
  const std::uint64_t kernel_default[4] = {};
  const std::uint64_t bit = std::uint64_t{1} << (signal - 1);
  Syscall(SYS_rt_sigaction, signal, Argument(kernel_default), 0, sizeof bit);
  // Held back until the handler's return has brought back the registers: they stand in the core
  // file. The return opens the mask.
  Syscall(SYS_rt_sigprocmask, kBlock, Argument(&bit), 0, sizeof bit);
  const auto pid = static_cast<long>(GetPid());
  const auto tid = static_cast<long>(GetTid());
  if (Syscall(SYS_rt_tgsigqueueinfo, pid, tid, signal, Argument(info)) != 0)
    Syscall(SYS_tgkill, pid, tid, signal);
}

void AddSignalStack() {
  stack_t stack{};
  if (own_stack != nullptr || Syscall(SYS_sigaltstack, 0, Argument(&stack)) != 0 ||
      (stack.ss_flags & SS_DISABLE) == 0)
    return;
  char* memory = static_cast<char*>(MapMemory(kGuardBytes + kStackBytes));
  if (memory == nullptr) return;
  Syscall(SYS_mprotect, Argument(memory), kGuardBytes, PROT_NONE);
  stack = {memory + kGuardBytes, 0, kStackBytes};
  if (Syscall(SYS_sigaltstack, Argument(&stack), 0) == 0)
    own_stack = memory;
  else
    Syscall(SYS_munmap, Argument(memory), kGuardBytes + kStackBytes);
}

void DropSignalStack() {
  char* memory = own_stack;
  stack_t stack{};
  if (memory == nullptr || Syscall(SYS_sigaltstack, 0, Argument(&stack)) != 0) return;
  own_stack = nullptr;
  // The program may have put its own there, or taken ours for its own and unmapped it.
  if (stack.ss_sp != memory + kGuardBytes || (stack.ss_flags & SS_ONSTACK) != 0) return;
  stack = {nullptr, SS_DISABLE, 0};
  if (Syscall(SYS_sigaltstack, Argument(&stack), 0) == 0)
    Syscall(SYS_munmap, Argument(memory), kGuardBytes + kStackBytes);
}

}  // namespace stipple

#define STIPPLE_EXPORT __attribute__((visibility("default")))

extern "C" {

STIPPLE_EXPORT int sigaction(int signal, const struct sigaction* action,
                             struct sigaction* before) noexcept {
  return Change(signal, action, before);
}

STIPPLE_EXPORT sighandler_t signal(int signal, sighandler_t handler) noexcept {
  return SetHandler(signal, handler, SA_RESTART);
}
STIPPLE_EXPORT sighandler_t bsd_signal(int number, sighandler_t handler) noexcept {
  return SetHandler(number, handler, SA_RESTART);
}
STIPPLE_EXPORT sighandler_t ssignal(int number, sighandler_t handler) noexcept {
  return SetHandler(number, handler, SA_RESTART);
}
STIPPLE_EXPORT sighandler_t __sysv_signal(int number, sighandler_t handler) noexcept {
  return SetHandler(number, handler, static_cast<int>(SA_RESETHAND) | SA_NODEFER);
}
STIPPLE_EXPORT sighandler_t sysv_signal(int number, sighandler_t handler) noexcept {
  return SetHandler(number, handler, static_cast<int>(SA_RESETHAND) | SA_NODEFER);
}
}
