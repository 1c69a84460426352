// SPDX-License-Identifier: MIT
// A scratch thread with a chunk of ordinary memory takes this thread's place for a moment, and code
// as the plugin inserts it (abi.h) runs against it: inline for a timed event, a routine for a visit
// that is only counted, through slow.S for the others. Each figure is a median, over batches for
// what a visit costs, over visits for what its own times hold.
#include "runtime/core/calibration.h"

#include "runtime/core/clock.h"
#include "runtime/core/sample.h"

namespace stipple {
namespace {

constexpr int kVisits = 64;
constexpr int kBatches = 9;
constexpr std::uint32_t kUnit = 256;                // of the figures, in a tick
constexpr std::uint32_t kRegion = kCountedRegions;  // none that the program has

/// What stands in for a thread and its chunk.
struct Scratch {
  Thread thread;
  EventWord words[2048];
  Counts counts;
};

std::uint32_t Median(std::uint32_t* values, int count) {
  for (int i = 1; i < count; ++i)
    for (int j = i; j > 0 && values[j - 1] > values[j]; --j) {
      const std::uint32_t value = values[j];
      values[j] = values[j - 1];
      values[j - 1] = value;
    }
  return values[count / 2];
}

/// An enter that is only counted, as the plugin's routine does it; false: it has not been.
inline bool CountedEvent(std::int64_t tp_offset, std::uint64_t token) {
  std::uint64_t left = token;
  __asm__ volatile(
      "addq $-128, %%rsp\n\t"
      "call 1f\n\t"
      "subq $-128, %%rsp\n\t"
      "jmp 3f\n"
      "1: movl %%eax, %%r10d\n\t"
      "testl $0xff000000, %%r10d\n\t"
      "je 2f\n\t"
      "testl %[count_only], %%r10d\n\t"
      "je 2f\n\t"
      "movq %%fs:(%[offset]), %%rdx\n\t"
      "movq 24(%%rdx), %%rdx\n\t"
      "testq %%rdx, %%rdx\n\t"
      "je 2f\n\t"
      "subl $1, -0x8000000(%%rdx,%%r10,8)\n\t"
      "js 4f\n\t"
      "xorl %%eax, %%eax\n\t"
      "ret\n"
      "4: addl $1, -0x8000000(%%rdx,%%r10,8)\n"
      "2: ret\n"
      "3:"
      : "+a"(left)
      : [offset] "r"(tp_offset), [count_only] "i"(STIPPLE_COUNT_ONLY)
      : "rdx", "r10", "r11", "cc", "memory");
  return left == 0;
}

/// One event as it stands in instrumented code; returns the token for the exits.
inline std::uint32_t Event(std::int64_t tp_offset, std::uint32_t token, std::uint32_t leave) {
  const std::uint64_t word = std::uint64_t{token} | leave;
  std::uint64_t back = token | leave;
  __asm__ volatile(
      "testl $0xff000000, %k[word]\n\t"
      "jne 1f\n\t"
      "movq %%fs:(%[offset]), %%rdx\n\t"
      "movl $8, %%r11d\n\t"
      "xaddq %%r11, (%%rdx)\n\t"
      "xorl %%eax, %%eax\n\t"
      "cmpq 8(%%rdx), %%r11\n\t"
      "jae 1f\n\t"
      "testq %%r11, 16(%%rdx)\n\t"
      "jne 2f\n\t"
      "rdtsc\n\t"
      "shlq $24, %%rax\n\t"
      "shlq $56, %%rdx\n\t"
      "orq %%rdx, %%rax\n"
      "2: orq %[word], %%rax\n\t"
      "movq %%rax, (%%r11)\n\t"
      "movl %k[word], %%eax\n\t"
      "jmp 3f\n"
      "1: movl %k[word], %%eax\n\t"
      "leaq 3f(%%rip), %%r11\n\t"
      "jmp stipple_slow\n"
      "3:"
      : "+a"(back)
      : [word] "r"(word), [offset] "r"(tp_offset)
      : "rdx", "r11", "cc", "memory");
  return static_cast<std::uint32_t>(back);
}

class Bench {
 public:
  explicit Bench(Scratch& scratch)
      : scratch_(scratch), stream_(stipple_stream), tp_offset_(ControlSlotOffset()) {
    scratch.thread.tid = 1;
    scratch.thread.review_ticks = ~std::uint64_t{0} >> 1;  // never
    scratch.thread.counts = &scratch.counts;
    scratch.thread.control.counts = scratch.counts.words;
    stipple_stream = &scratch.thread.control;
  }
  ~Bench() { stipple_stream = stream_; }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// The median cost of a visit, and of what lies between its times if both are there.
  void Measure(std::uint32_t mode, bool always_due, std::uint32_t* visit, std::uint32_t* inner) {
    std::uint32_t visits[kBatches], inners[kBatches];
    for (int batch = 0; batch < kBatches; ++batch) {
      visits[batch] = Batch(mode, always_due);
      inners[batch] = inner == nullptr ? 0 : Inner(always_due);
    }
    *visit = Median(visits, kBatches);
    if (inner != nullptr) *inner = Median(inners, kBatches);
  }

 private:
  std::uint32_t Batch(std::uint32_t mode, bool always_due) {
    stipple_control& control = scratch_.thread.control;
    control.cur = reinterpret_cast<std::uint64_t>(scratch_.words);
    control.end = control.cur + sizeof scratch_.words;
    std::uint64_t& word = scratch_.counts.words[kRegion];
    word = ~std::uint64_t{0} >> 33;
    const std::uint64_t begin = ReadTicks();
    for (int i = 0; i < kVisits; ++i) {
      if (always_due) word = 0;
      if (mode == STIPPLE_COUNT_ONLY && CountedEvent(tp_offset_, kRegion | mode)) continue;
      const std::uint32_t token = Event(tp_offset_, kRegion | mode, 0);
      if (token != 0) Event(tp_offset_, token, STIPPLE_LEAVE);
    }
    return static_cast<std::uint32_t>((ReadTicks() - begin) * kUnit / kVisits);
  }

  /// Of the visits of the last batch.
  std::uint32_t Inner(bool sampled) {
    std::uint32_t inners[kVisits];
    const EventWord* word = scratch_.words;
    for (std::uint32_t& inner : inners) {
      std::uint64_t enter = TimeOf(*word);
      if (sampled) enter = reinterpret_cast<const CountedEnter*>(word)->ticks & kTimeMask;
      word += sampled ? sizeof(CountedEnter) / sizeof(EventWord) : 1;
      inner = static_cast<std::uint32_t>((TimeOf(*word++) - enter) * kUnit);
    }
    return Median(inners, kVisits);
  }

  Scratch& scratch_;
  stipple_control* stream_;
  std::int64_t tp_offset_;
};

std::uint32_t ClockRead() {
  std::uint32_t batches[kBatches];
  for (std::uint32_t& batch : batches) {
    const std::uint64_t begin = ReadTicks();
    for (int i = 0; i < kVisits - 1; ++i) ReadTicks();
    batch = static_cast<std::uint32_t>((ReadTicks() - begin) * kUnit / kVisits);
  }
  return Median(batches, kBatches);
}

}  // namespace

Calibration Calibrate() {
  Calibration record{};
  auto* scratch = static_cast<Scratch*>(MapMemory(sizeof(Scratch)));
  if (scratch == nullptr) return record;
  {
    Bench bench(*scratch);
    bench.Measure(0, false, &record.timed_visit, &record.timed_inner);
    bench.Measure(STIPPLE_COUNT_ONLY, true, &record.sampled_visit, &record.sampled_inner);
    bench.Measure(STIPPLE_NO_CLOCK, false, &record.no_clock_visit, nullptr);
    bench.Measure(STIPPLE_COUNT_ONLY, false, &record.counted_visit, nullptr);
  }
  record.clock_read = ClockRead();
  Syscall(SYS_munmap, Argument(scratch), sizeof(Scratch));
  return record;
}

}  // namespace stipple
