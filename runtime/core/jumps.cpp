// SPDX-License-Identifier: MIT
// Jumps between frames and between stacks, as jumps.S sees them, become records: the reader pops
// the frames that a longjmp left, and keeps one call stack for each context. Only in the shared
// library.
//
// A jump point is named by the stack pointer that it goes back to, not by its buffer: buffers are
// copied, and of two points with the same stack pointer only the later one can be alive.
#include <dlfcn.h>
#include <setjmp.h>
#include <ucontext.h>

#include "runtime/core/clock.h"
#include "runtime/core/process.h"
#include "runtime/core/recorder.h"
#include "runtime/core/sample.h"
#include "runtime/core/stream.h"

extern "C" {
/// The real functions, in the order of kNames; null: not yet looked up.
void* stipple_jumps[11] = {};
/// Where libc goes on when a context's function returns; null: unknown, and its end is not seen.
void* stipple_start_context = nullptr;
void stipple_context_end();
}

namespace stipple {
namespace {

constexpr const char* kNames[] = {"setjmp",      "_setjmp",    "__sigsetjmp", "getcontext",
                                  "longjmp",     "_longjmp",   "siglongjmp",  "__longjmp_chk",
                                  "swapcontext", "setcontext", "vfork"};
static_assert(sizeof kNames / sizeof kNames[0] == sizeof stipple_jumps / sizeof stipple_jumps[0]);

constexpr int kStackSlot = 6;  // of glibc's jmp_buf, mangled
constinit bool jumps_are_known = false;
constinit bool contexts_are_known = false;

std::uint64_t StackOf(const void* buffer) {
  std::uint64_t stack = static_cast<const std::uint64_t*>(buffer)[kStackSlot];
  __asm__("rorq $17, %0\n\txorq %%fs:0x30, %0" : "+r"(stack) : : "cc");
  return stack;
}

std::uint64_t StackOf(const ucontext_t& context) {
  return static_cast<std::uint64_t>(context.uc_mcontext.gregs[REG_RSP]);
}

/// Also while recording is switched off: what is open goes on being left.
template <class Record>
void Append(Record record) {
  if (!stipple_recording()) return;
  record.ticks = ReadTicks();
  AppendRecord(&record, Record::kKind, sizeof record);
}

/// Learns whether the stack pointer in a jmp_buf is where glibc has it.
void LearnJumps() {
  using SetJump = int(void*);
  jmp_buf buffer;
  auto* set_jump = reinterpret_cast<SetJump*>(stipple_jumps[1]);
  if (set_jump == nullptr) return;
  set_jump(&buffer);  // never jumped to
  const auto here = reinterpret_cast<std::uint64_t>(__builtin_frame_address(0));
  jumps_are_known = here - StackOf(&buffer) < 4096;
}

void Nothing() {}

/// Learns what the function of a context returns to, and that rbx then leads to the next context.
void LearnContexts() {
  static std::uint64_t stack[128];
  static ucontext_t context, next;
  context.uc_stack.ss_sp = stack;
  context.uc_stack.ss_size = sizeof stack;
  context.uc_link = &next;
  makecontext(&context, Nothing, 0);
  const std::uint64_t top = StackOf(context);
  const auto link = static_cast<std::uint64_t>(context.uc_mcontext.gregs[REG_RBX]);
  const auto begin = reinterpret_cast<std::uint64_t>(stack);
  contexts_are_known = top - begin < sizeof stack;
  if (!contexts_are_known || link - begin >= sizeof stack) return;
  if (*reinterpret_cast<ucontext_t**>(link) == &next)
    stipple_start_context = *reinterpret_cast<void**>(top);
}

bool HasShadowStack() {
  std::uint32_t features = 0;
  __asm__("movl %%fs:72, %0" : "=r"(features));
  return (features & 2) != 0;
}

void LookUp() {
  for (int i = 0; const char* name : kNames) stipple_jumps[i++] = dlsym(RTLD_NEXT, name);
}

__attribute__((constructor(101))) void PrepareJumps() {
  LookUp();
  LearnJumps();
  if (!HasShadowStack()) LearnContexts();
}

void Switch(std::uint64_t from, const ucontext_t& to) {
  ForgetSamples(kWholeStack);
  if (!contexts_are_known || !stipple_recording()) return;
  NoteFeature(Feature::kStackSwitches);
  StackSwitch record{};
  record.from = from;
  record.to = StackOf(to);
  Append(record);
}

}  // namespace
}  // namespace stipple

extern "C" {

void* stipple_next_jump(int index) {
  stipple::LookUp();
  return stipple_jumps[index];
}

void stipple_note_jump_point(std::uint64_t stack) {
  stipple::JumpPoint record{};
  record.stack = stack;
  stipple::Append(record);
}

void stipple_note_unwound(std::uint64_t stack) {
  stipple::ForgetSamples(stack);
  stipple::Unwound record{};
  record.stack = stack;
  stipple::Append(record);
}

void stipple_note_longjmp(const void* buffer) {
  if (stipple::jumps_are_known) stipple_note_unwound(stipple::StackOf(buffer));
}

/// A context that has not run yet returns to libc; from now on to us, and we to libc.
void stipple_note_switch(std::uint64_t from, const ucontext_t* to) {
  void** top = reinterpret_cast<void**>(stipple::StackOf(*to));
  if (stipple_start_context != nullptr && *top == stipple_start_context)
    *top = reinterpret_cast<void*>(stipple_context_end);
  stipple::Switch(from, *to);
}

void stipple_note_context_end(std::uint64_t from, const ucontext_t* next) {
  if (next != nullptr) stipple::Switch(from, *next);
}
}
