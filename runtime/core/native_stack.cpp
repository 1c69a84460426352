// SPDX-License-Identifier: MIT
#include "runtime/core/native_stack.h"

#include <dlfcn.h>
#include <sys/uio.h>

#include "runtime/core/lock.h"
#include "runtime/core/module.h"

namespace stipple {
namespace {

using UnwindHere = std::size_t(std::uintptr_t* frames, std::size_t most);
using UnwindFrom = std::size_t(void* context, std::uintptr_t* frames, std::size_t most,
                               std::size_t outer, std::size_t* cut);

constinit UnwindHere* unwind_here = nullptr;
constinit UnwindFrom* unwind_from = nullptr;
constinit bool tried = false;

constinit std::atomic<std::uint32_t> readers{0};
constinit std::atomic<std::uint32_t> held{0};

// Where to go on when reading a stack faults: a stack can be anything.
__thread void* recover[5];
__thread bool may_recover = false;

/// Runs `read` and says whether it came to its end.
template <class Read>
__attribute__((noinline)) bool Survives(Read read) {
  if (__builtin_setjmp(recover) != 0) {
    may_recover = false;
    return false;
  }
  may_recover = true;
  read();
  may_recover = false;
  return true;
}

/// Counts this thread as a reader; not while a fork is under way.
class Reading {
 public:
  Reading() {
    readers.fetch_add(1, std::memory_order_seq_cst);
    allowed_ = held.load(std::memory_order_seq_cst) == 0;
  }
  ~Reading() { readers.fetch_sub(1, std::memory_order_release); }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  bool allowed() const { return allowed_; }

 private:
  bool allowed_;
};

/// Addresses without a file (code made at run time) are looked for in the list of mappings; what
/// was not found there is not looked for again.
class Unknown {
 public:
  bool Has(std::uintptr_t address) const { return Slot(address) == Page(address); }
  void Add(std::uintptr_t address) { Slot(address) = Page(address); }

 private:
  static std::uintptr_t Page(std::uintptr_t address) { return address >> 12; }
  std::uintptr_t& Slot(std::uintptr_t address) { return pages_[Page(address) % kSlots]; }
  std::uintptr_t Slot(std::uintptr_t address) const { return pages_[Page(address) % kSlots]; }
  static constexpr std::size_t kSlots = 64;
  std::uintptr_t pages_[kSlots] = {};
};
constinit Unknown unknown;

std::uint64_t FrameWord(std::uintptr_t address) {
  constexpr std::uint32_t kMostModules = 0xffff;
  const Module* module = KnownModuleAt(address);
  if (module == nullptr && !unknown.Has(address)) {
    const SignalBlock signals_blocked;
    Process* process = BeginProcess();
    if (process != nullptr) {
      Holding holding(process->lock);
      module = ModuleAt(*process, address);
      if (module == nullptr) unknown.Add(address);
    }
  }
  if (module == nullptr || module->number > kMostModules) return address & kFrameOffsetMask;
  return (std::uint64_t{module->number} << kFrameModuleShift) |
         ((address - module->load_bias) & kFrameOffsetMask);
}

void Encode(NativeStack& stack) {
  for (std::uint32_t i = 0; i < stack.count; ++i) stack.frames[i] = FrameWord(stack.frames[i]);
}

/// Reads two words of this process's memory without a fault; false if they are not there.
bool ReadPair(std::uintptr_t address, std::uintptr_t (&pair)[2]) {
  const iovec to = {pair, sizeof pair};
  const iovec from = {reinterpret_cast<void*>(address), sizeof pair};
  return Syscall(SYS_process_vm_readv, static_cast<long>(GetPid()), Argument(&to), 1,
                 Argument(&from), 1) == static_cast<long>(sizeof pair);
}

/// The chain of frame pointers; ends where it is broken, which is at once in code without them.
void FollowFramePointers(const ucontext_t& context, NativeStack& stack) {
  auto frame = static_cast<std::uintptr_t>(context.uc_mcontext.gregs[REG_RBP]);
  std::uintptr_t pair[2];
  while (stack.count < kMostFrames && frame % 8 == 0 && ReadPair(frame, pair) && pair[1] != 0) {
    stack.frames[stack.count++] = pair[1];
    if (pair[0] <= frame) return;
    frame = pair[0];
  }
}

/// Whether the 16 bytes of code around `address` (8 before it) are the end of an event's call.
bool ReturnsFromEvent(const unsigned char* around) {
  return around[3] == 0xe8 && around[8] == 0x48 && around[9] == 0x83 && around[10] == 0xec &&
         around[11] == 0x80;
}

/// Around the call of an event's routine the stack pointer is 128 bytes lower than the unwind table
/// says (plugin/event_code.cpp), and a walk from there would go astray: an event that was
/// interrupted is taken back to its function first.
void LeaveEvent(gregset_t& registers) {
  constexpr long kRedZone = 128;
  std::uintptr_t code[2];
  const auto* around = reinterpret_cast<const unsigned char*>(code);
  const auto address = static_cast<std::uintptr_t>(registers[REG_RIP]);
  if (ReadPair(address - 8, code)) {
    const bool before = around[4] == 0x48 && around[5] == 0x83 && around[6] == 0xc4 &&
                        around[7] == 0x80 && around[8] == 0xe8;
    if (before || ReturnsFromEvent(around)) {
      registers[REG_RSP] += kRedZone;
      return;
    }
  }
  std::uintptr_t top[2];  // in the routine: the return address
  if (!ReadPair(static_cast<std::uintptr_t>(registers[REG_RSP]), top)) return;
  if (top[0] < 4096 || !ReadPair(top[0] - 8, code) || !ReturnsFromEvent(around)) return;
  registers[REG_RIP] = static_cast<greg_t>(top[0]);
  registers[REG_RSP] += kRedZone + static_cast<long>(sizeof top[0]);
}

/// Drops the frames before `address`: those of the signal's handler.
bool DropUntil(std::uintptr_t address, std::uintptr_t* frames, std::size_t& count) {
  std::size_t first = 0;
  while (first < count && frames[first] != address) ++first;
  if (first == count) return false;
  count -= first;
  for (std::size_t i = 0; i < count; ++i) frames[i] = frames[first + i];
  return true;
}

bool ReadQuickly(std::uintptr_t address, NativeStack& stack) {
  constexpr std::size_t kHandlerFrames = 8;
  std::uintptr_t frames[kMostFrames + kHandlerFrames];
  std::size_t count = 0;
  const bool done = Survives([&] { count = unwind_here(frames, kMostFrames + kHandlerFrames); });
  const bool full = count == kMostFrames + kHandlerFrames;
  if (!done || !DropUntil(address, frames, count)) return false;
  stack.count = static_cast<std::uint32_t>(count < kMostFrames ? count : kMostFrames);
  stack.cut = full ? kUnknownCut : 0;
  CopyBytes(stack.frames, frames, stack.count * sizeof frames[0]);
  return true;
}

/// Whether an address lies in the runtime's own code.
bool IsOwn(std::uint64_t frame) {
  static constexpr char kName[] = "/libstipple";
  const auto number = static_cast<std::uint32_t>(frame >> kFrameModuleShift);
  for (const Module* m = Modules(); m != nullptr && number != 0; m = m->next) {
    if (m->number != number) continue;
    std::size_t last = m->path_bytes;
    while (last > 0 && m->path[last - 1] != '/') --last;
    if (last == 0 || m->path_bytes - last < sizeof kName - 2) return false;
    for (std::size_t i = 1; i + 1 < sizeof kName; ++i)
      if (m->path[last + i - 1] != kName[i]) return false;
    return true;
  }
  return false;
}

}  // namespace

void OpenUnwinder() {
  if (tried) return;
  tried = true;
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&OpenUnwinder), &own) == 0) return;
  const char* name = own.dli_fname;
  std::size_t folder = TextBytes(name);
  while (folder > 0 && name[folder - 1] != '/') --folder;
  constexpr char kLibrary[] = "libstipple-unwind.so";
  char path[4200] = {};
  if (folder + sizeof kLibrary > sizeof path) return;
  CopyBytes(path, name, folder);
  CopyBytes(path + folder, kLibrary, sizeof kLibrary);
  // Its own scope: libunwind brings functions that would replace libgcc's and libc's.
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return;
  unwind_from = reinterpret_cast<UnwindFrom*>(dlsym(library, "stipple_unwind_from"));
  unwind_here = reinterpret_cast<UnwindHere*>(dlsym(library, "stipple_unwind_here"));
}

bool HaveUnwinder() { return unwind_here != nullptr && unwind_from != nullptr; }

void PrepareUnwinding() {
  std::uintptr_t frames[16];
  if (HaveUnwinder()) unwind_here(frames, 16);
}

void ReadStack(ucontext_t* context, bool quick, NativeStack& stack) {
  gregset_t& registers = context->uc_mcontext.gregs;
  const greg_t interrupted_at = registers[REG_RIP];
  const greg_t stack_at = registers[REG_RSP];
  LeaveEvent(registers);  // the walk begins with what stands in the signal's frame
  const auto address = static_cast<std::uintptr_t>(registers[REG_RIP]);
  stack.count = 1;
  stack.cut = 0;
  stack.frames[0] = address;
  const Reading reading;
  bool done = false;
  if (HaveUnwinder() && reading.allowed()) {
    if (quick) {
      done = ReadQuickly(address, stack);
    } else {
      std::size_t count = 0;
      std::size_t cut = 0;
      done = Survives([&] {
               count = unwind_from(context, stack.frames, kMostFrames, kMostOuterFrames, &cut);
             }) &&
             count != 0;
      if (done) stack.count = static_cast<std::uint32_t>(count);
      if (done) stack.cut = static_cast<std::uint32_t>(cut < kUnknownCut ? cut : kUnknownCut - 1);
    }
  }
  if (!done) {
    stack.count = 1;
    stack.frames[0] = address;
    FollowFramePointers(*context, stack);
  }
  registers[REG_RIP] = interrupted_at;
  registers[REG_RSP] = stack_at;
  Encode(stack);
}

void ReadStackHere(NativeStack& stack) {
  stack.count = stack.cut = 0;
  const Reading reading;
  std::size_t count = 0;
  if (!HaveUnwinder() || !reading.allowed() ||
      !Survives([&] { count = unwind_here(stack.frames, kMostFrames); }))
    return;
  stack.count = static_cast<std::uint32_t>(count);
  stack.cut = count == kMostFrames ? kUnknownCut : 0;
  Encode(stack);
  std::uint32_t own = 0;
  while (own < stack.count && IsOwn(stack.frames[own])) ++own;
  stack.count -= own;
  for (std::uint32_t i = 0; i < stack.count; ++i) stack.frames[i] = stack.frames[own + i];
}

void LeaveFaultyStack() {
  if (may_recover) __builtin_longjmp(recover, 1);
}

void HoldUnwinding() {
  held.fetch_add(1, std::memory_order_seq_cst);
  constexpr int kMostRounds = 10'000;  // readers are quick; a fork that waits no longer is sound
  for (int i = 0; i < kMostRounds && readers.load(std::memory_order_acquire) != 0; ++i)
    Syscall(SYS_sched_yield);
}

void ReleaseUnwinding() { held.fetch_sub(1, std::memory_order_seq_cst); }

void ReleaseUnwindingInChild() {
  if (readers.load(std::memory_order_relaxed) == 0) ReleaseUnwinding();
}

}  // namespace stipple
