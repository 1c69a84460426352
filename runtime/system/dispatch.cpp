// SPDX-License-Identifier: MIT
// Syscall User Dispatch (Linux 5.11): the kernel turns each system call of an armed thread into
// SIGSYS while the thread's selector byte says so, and the handler makes the call itself. Code of
// libstipple.so alone always passes; its pass.S holds the instructions for that. Wrappers of libc's
// functions (calls.cpp) set the selector to ALLOW, since they record for a twentieth of the price;
// what is left are calls made without libc, or inside it.
//
// What cannot be repeated from a handler:
//   - a call whose child shares memory and would run on this stack, or go on behind this very
//     instruction on another (vfork, clone): the program makes it itself, with the selector at
//     ALLOW until the next wrapper's end, which for pthread_create, posix_spawn, system and popen
//     is their own;
//   - the end of a signal handler of the program: done from where its frame lies;
//   - masks and alternate stacks: what the handler's own frame brings back is changed as well.
// The kernel kills a process that has SIGSYS blocked when it is raised, so no mask of the program
// ever holds it. A program that wants SIGSYS for itself gets it, and its further calls are not
// seen. A child begins without it, and arms itself when it records.
#include "runtime/system/dispatch.h"

#include <errno.h>
#include <link.h>
#include <signal.h>
#include <sys/prctl.h>
#include <ucontext.h>

#include "runtime/core/recorder.h"
#include "runtime/core/syscalls.h"
#include "runtime/system/record_call.h"

extern "C" {
long stipple_pass_call(long number, const long arguments[6]);
void stipple_pass_return(void);
void stipple_pass_return_from(void* stack);
}

namespace stipple::system {
namespace {

constexpr long kSetDispatch = 59, kDispatchOff = 0, kDispatchOn = 1;
constexpr int kDispatchCode = 2;  // SYS_USER_DISPATCH
constexpr std::size_t kMaskBytes = 8;
constexpr std::uint64_t kSigSysBit = std::uint64_t{1} << (SIGSYS - 1);
constexpr int kSignals = 64;
constexpr std::size_t kParameters = 6;

/// rt_sigaction's, which is not libc's.
struct KernelAction {
  void (*handler)(int, siginfo_t*, void*);
  unsigned long flags;
  void (*restorer)();
  std::uint64_t mask;
};

constinit std::atomic<bool> stepped_aside{false};

long Pass(long number, long a = 0, long b = 0, long c = 0, long d = 0) {
  const long arguments[kParameters] = {a, b, c, d, 0, 0};
  return stipple_pass_call(number, arguments);
}

long ReadAction(int signal, KernelAction* action) {
  return Pass(SYS_rt_sigaction, signal, 0, Argument(action), kMaskBytes);
}

/// The program's handlers must not run with SIGSYS blocked.
void OpenMaskOf(int signal) {
  KernelAction action{};
  if (ReadAction(signal, &action) != 0 || (action.mask & kSigSysBit) == 0) return;
  action.mask &= ~kSigSysBit;
  Pass(SYS_rt_sigaction, signal, Argument(&action), 0, kMaskBytes);
}

/// Nothing more is seen, in any thread: the program, or somebody else, uses SIGSYS.
void StepAside() {
  stepped_aside.store(true, std::memory_order_relaxed);
  for (KernelThread* thread = Threads(); thread != nullptr; thread = thread->older) {
    thread->dispatched = false;
    thread->selector = kAllow;
  }
  const KernelAction standard{};
  Pass(SYS_rt_sigaction, SIGSYS, Argument(&standard), 0, kMaskBytes);
}

/// Makes the program's call; what it does to masks and stacks goes into the frame of the handler.
long Repeat(long number, const long (&arguments)[kParameters], ucontext_t& context) {
  const int signal = static_cast<int>(arguments[0]);
  if (number == SYS_rt_sigaction && signal == SIGSYS && arguments[1] != 0) StepAside();
  const long result = stipple_pass_call(number, arguments);
  if (number == SYS_rt_sigprocmask) {
    std::uint64_t mask = 0;
    Pass(SYS_rt_sigprocmask, SIG_BLOCK, 0, Argument(&mask), kMaskBytes);
    mask &= ~kSigSysBit;
    CopyBytes(&context.uc_sigmask, &mask, kMaskBytes);
  } else if (number == SYS_rt_sigaction && result == 0 && signal != SIGSYS) {
    OpenMaskOf(signal);
  } else if (number == SYS_sigaltstack && result == 0) {
    Pass(SYS_sigaltstack, 0, Argument(&context.uc_stack));
  }
  return result;
}

/// Begins a child in this memory.
bool SharesMemory(long number, long flags) {
  constexpr long kCloneVm = 0x100;
  if (number == SYS_clone) return (flags & kCloneVm) != 0;
  return number == SYS_clone3 || number == SYS_vfork;
}

void OnCall(int, siginfo_t* info, void* pointer) {
  auto& context = *static_cast<ucontext_t*>(pointer);
  KernelThread* thread = ThisThread();
  if (info->si_code != kDispatchCode || thread == nullptr) {  // sent by somebody
    StepAside();
    Pass(SYS_tgkill, Pass(SYS_getpid), Pass(SYS_gettid), SIGSYS);
    return;
  }
  // The selector stays at BLOCK: calls made here pass anyhow, and a signal handler of the program
  // that comes in between is seen like any other code.
  greg_t* registers = context.uc_mcontext.gregs;
  const long number = info->si_syscall;
  if (number == SYS_rt_sigreturn) {
    stipple_pass_return_from(reinterpret_cast<void*>(registers[REG_RSP]));
  }
  if (SharesMemory(number, registers[REG_RDI])) {
    constexpr greg_t kInstructionBytes = 2;
    thread->selector = kAllow;
    registers[REG_RIP] -= kInstructionBytes;
    registers[REG_RAX] = number;
    return;
  }
  const long arguments[kParameters] = {registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                                       registers[REG_R10], registers[REG_R8],  registers[REG_R9]};
  const std::uint64_t enter_ticks = ReadTicks();
  const long result = Repeat(number, arguments, context);
  registers[REG_RAX] = result;
  if (stipple_recording())
    RecordCall(static_cast<std::uint32_t>(number), 0, enter_ticks, result,
               reinterpret_cast<const std::uint64_t*>(arguments), kParameters);
}

/// Where the core's code lies.
struct Code {
  std::uint64_t begin;
  std::uint64_t bytes;
};

int FindCode(dl_phdr_info* object, std::size_t, void* pointer) {
  auto& code = *static_cast<Code*>(pointer);
  const auto inside = reinterpret_cast<std::uint64_t>(stipple_pass_call);
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    const std::uint64_t begin = object->dlpi_addr + segment.p_vaddr;
    if (segment.p_type != PT_LOAD || inside - begin >= segment.p_memsz) continue;
    code = {begin, segment.p_memsz};
    return 1;
  }
  return 0;
}

/// Takes SIGSYS, unless the program has it; 0 or an errno.
int TakeSignal() {
  KernelAction action{};
  if (const long error = ReadAction(SIGSYS, &action); error != 0) return static_cast<int>(-error);
  if (action.handler == OnCall) return 0;
  if (action.handler != nullptr) return EBUSY;
  constexpr unsigned long kRestorer = 0x04000000;
  action = {OnCall, SA_SIGINFO | SA_NODEFER | kRestorer, stipple_pass_return, 0};
  const long error = Pass(SYS_rt_sigaction, SIGSYS, Argument(&action), 0, kMaskBytes);
  if (error != 0) return static_cast<int>(-error);
  for (int signal = 1; signal <= kSignals; ++signal)
    if (signal != SIGSYS) OpenMaskOf(signal);
  return 0;
}

}  // namespace

int Arm(KernelThread& thread) {
  if (stepped_aside.load(std::memory_order_relaxed)) return EBUSY;
  std::uint64_t mask = 0;
  Pass(SYS_rt_sigprocmask, SIG_BLOCK, 0, Argument(&mask), kMaskBytes);
  if ((mask & kSigSysBit) != 0) return EBUSY;
  static constinit Code code{};
  if (code.bytes == 0 && dl_iterate_phdr(FindCode, &code) != 1) return ENOENT;
  if (const int error = TakeSignal(); error != 0) return error;
  thread.selector = kAllow;
  const long arguments[kParameters] = {kSetDispatch,
                                       kDispatchOn,
                                       static_cast<long>(code.begin),
                                       static_cast<long>(code.bytes),
                                       reinterpret_cast<long>(&thread.selector),
                                       0};
  const long error = stipple_pass_call(SYS_prctl, arguments);
  thread.dispatched = error == 0;
  return static_cast<int>(-error);
}

void Disarm(KernelThread& thread) {
  if (!thread.dispatched) return;
  thread.selector = kAllow;
  thread.dispatched = false;
  Pass(SYS_prctl, kSetDispatch, kDispatchOff);
}

}  // namespace stipple::system
