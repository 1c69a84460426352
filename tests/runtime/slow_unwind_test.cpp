// SPDX-License-Identifier: MIT
// The jump into the slow path can be unwound at every instruction: slow.S alone, with this file in
// the place of the runtime, single-stepped by the processor's trap flag.
#include <gtest/gtest.h>
#include <signal.h>
#include <ucontext.h>
#include <unwind.h>

#include "events.h"
#include "runtime/core/save_area.h"

extern "C" {
void stipple_slow();
std::uint32_t stipple_slow_event(std::uint32_t token);
}

namespace {

/// Whether the frame of `caller` is found by unwinding from here.
bool IsCalledFrom(std::uintptr_t caller) {
  struct Search {
    std::uintptr_t caller;
    int frames;
    bool found;
  } search{caller, 0, false};
  _Unwind_Backtrace(
      [](_Unwind_Context* context, void* data) {
        auto* wanted = static_cast<Search*>(data);
        const std::uintptr_t frame = _Unwind_GetIP(context);
        wanted->found = wanted->found || frame - wanted->caller < 512;
        return wanted->found || ++wanted->frames == 64 ? _URC_END_OF_STACK : _URC_NO_REASON;
      },
      &search);
  return search.found;
}

constexpr std::uintptr_t kSlowBytes = 1024;  // at most
volatile std::uintptr_t caller = 0;
volatile int steps = 0, blind_steps = 0, calls = 0, blind_calls = 0, samples = 0;
volatile bool throws = false;

void AtStep(int, siginfo_t*, void* context) {
  const auto at =
      static_cast<std::uintptr_t>(static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
  if (at - reinterpret_cast<std::uintptr_t>(&stipple_slow) >= kSlowBytes) return;
  steps = steps + 1;
  if (!IsCalledFrom(caller)) blind_steps = blind_steps + 1;
}

__attribute__((noinline)) void SteppedEvent(const stipple_dso& dso, std::uint32_t token) {
  __asm__ volatile(
      "leaq -128(%%rsp), %%rsp; pushfq; orq $0x100, (%%rsp); popfq; leaq 128(%%rsp), %%rsp" ::
          : "memory", "cc");
  stipple_test::Event(dso, token);
  __asm__ volatile(
      "leaq -128(%%rsp), %%rsp; pushfq; andq $~0x100, (%%rsp); popfq; leaq 128(%%rsp), %%rsp" ::
          : "memory", "cc");
}

}  // namespace

extern "C" {
std::uint64_t counts[8];
std::uint64_t slots[8];
stipple_control control{};
__thread stipple_control* stipple_stream = &control;

/// In the place of the runtime's: half of them go on the general way.
std::uint32_t stipple_sample(std::uint32_t token, std::uint64_t, std::uint64_t*) {
  samples = samples + 1;
  if (!IsCalledFrom(caller)) blind_calls = blind_calls + 1;
  return samples % 2 == 0 ? token : ~std::uint32_t{0};
}
std::uint32_t stipple_sample_leave(std::uint32_t token) {
  return stipple_sample(token, 0, nullptr);
}

/// In the place of the runtime's.
std::uint32_t stipple_slow_event(std::uint32_t token) {
  calls = calls + 1;
  if (!IsCalledFrom(caller)) blind_calls = blind_calls + 1;
  if (throws) throw token;
  return token;
}
}

// Not instrumented objects call these; nothing here does.
extern "C" void stipple_register(stipple_dso*) {}
extern "C" void stipple_unregister(stipple_dso*) {}

TEST(Slow, UnwindsAtEveryInstruction) {
  stipple::PrepareSaveArea();
  struct sigaction action {};
  action.sa_sigaction = AtStep;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGTRAP, &action, nullptr);
  std::uint64_t thread_pointer = 0;
  __asm__("movq %%fs:0, %0" : "=r"(thread_pointer));
  stipple_dso dso{};
  dso.tp_offset =
      static_cast<std::int64_t>(reinterpret_cast<std::uint64_t>(&stipple_stream) - thread_pointer);
  dso.slow = stipple_slow;
  caller = reinterpret_cast<std::uintptr_t>(&SteppedEvent);
  SteppedEvent(dso, 1);                       // no chunk
  SteppedEvent(dso, 1 | STIPPLE_NO_CLOCK);    // no chunk
  SteppedEvent(dso, 1 | STIPPLE_COUNT_ONLY);  // no counts
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(samples, 2);
  SteppedEvent(dso, 1 | STIPPLE_SAMPLED | STIPPLE_LEAVE);
  SteppedEvent(dso, 1 | STIPPLE_SAMPLED | STIPPLE_LEAVE);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(samples, 4);
  control.counts = counts;
  counts[1] = 2;
  control.cur = reinterpret_cast<std::uint64_t>(slots);
  control.end = control.cur + sizeof slots;
  SteppedEvent(dso, 1 | STIPPLE_NO_CLOCK);
  SteppedEvent(dso, 1 | STIPPLE_COUNT_ONLY);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(slots[0], 1u);
  EXPECT_EQ(counts[1], 0xffffffff00000000);   // both of the two left, one of them wrote an event
  SteppedEvent(dso, 1 | STIPPLE_COUNT_ONLY);  // due
  SteppedEvent(dso, 1 | STIPPLE_COUNT_ONLY);
  EXPECT_EQ(samples, 6);
  EXPECT_GT(steps, 100);
  EXPECT_EQ(blind_steps, 0);
  EXPECT_EQ(blind_calls, 0);
}

__attribute__((noinline)) void Throwing(const stipple_dso& dso, std::uint32_t token) {
  if (token == 0) throw token;  // for a compiler an asm never throws
  stipple_test::Event(dso, token);
}

/// As a debugger's or a profiler's code may, in a signal handler there.
TEST(Slow, AnExceptionFromWithinIsCaughtOutside) {
  stipple::PrepareSaveArea();
  static stipple_control empty{};
  stipple_stream = &empty;
  std::uint64_t thread_pointer = 0;
  __asm__("movq %%fs:0, %0" : "=r"(thread_pointer));
  stipple_dso dso{};
  dso.tp_offset =
      static_cast<std::int64_t>(reinterpret_cast<std::uint64_t>(&stipple_stream) - thread_pointer);
  dso.slow = stipple_slow;
  throws = true;
  std::uint32_t caught = 0;
  for (std::uint32_t token = 1; token <= 3; ++token) {
    try {
      Throwing(dso, token);
      ADD_FAILURE();
    } catch (std::uint32_t thrown) {
      caught += thrown;
    }
  }
  throws = false;
  stipple_stream = &control;
  EXPECT_EQ(caught, 6u);
}
