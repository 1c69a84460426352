// SPDX-License-Identifier: MIT
#include "runtime/core/skipped.h"

#include <atomic>

#include "runtime/core/stream.h"
#include "runtime/core/syscalls.h"

namespace stipple {

STIPPLE_PER_THREAD SkippedVisits* skipped_visits = nullptr;

namespace {

struct Visit {
  std::uintptr_t what;  // 0: of a signal handler's caller, which is about to write it
  std::uintptr_t frame;
};

constexpr std::size_t kBytes = 64 * 1024;
constexpr std::uint32_t kRoom = (kBytes - 16) / sizeof(Visit);

}  // namespace

/// A stack; what does not fit is only counted.
struct SkippedVisits {
  std::uint32_t depth;
  std::uint32_t beyond;
  Visit visits[kRoom];
};
static_assert(sizeof(SkippedVisits) <= kBytes);

namespace {

void Drop(std::uint32_t depth) {
  while (skipped_visits->depth > depth) {
    skipped_visits->visits[skipped_visits->depth - 1].what = 0;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    --skipped_visits->depth;
  }
}

/// Frames below `frame` have ended: exits are lost when an exception passes by.
void DropEnded(std::uintptr_t frame) {
  std::uint32_t depth = skipped_visits->depth;
  while (depth > 0 && skipped_visits->visits[depth - 1].frame < frame) --depth;
  Drop(depth);
}

}  // namespace

void NoteSkipped(std::uintptr_t what, const void* frame) {
  if (skipped_visits == nullptr) {
    if (!BeginThread()) return;  // its end gives the stack back
    skipped_visits = static_cast<SkippedVisits*>(MapMemory(kBytes));
    if (skipped_visits == nullptr) return;
  }
  const auto at = reinterpret_cast<std::uintptr_t>(frame);
  if (skipped_visits->depth == kRoom) DropEnded(at);
  if (skipped_visits->depth == kRoom || skipped_visits->beyond != 0) {
    ++skipped_visits->beyond;
    return;
  }
  const std::uint32_t index = skipped_visits->depth;
  skipped_visits->depth = index + 1;
  // A signal handler that comes here finds its own place above.
  std::atomic_signal_fence(std::memory_order_seq_cst);
  skipped_visits->visits[index] = {what, at};
}

// A visit that ends is the innermost one that is still open, so its entry is the topmost of `what`.
// Entries above it are of visits that lost their exits. Entries whose hook ran in a frame above are
// of callers: only the first of these can be meant, by a function that has since made its frame
// larger.
bool TakeSkippedSlowly(std::uintptr_t what, const void* frame) {
  if (skipped_visits->depth == 0) return false;
  if (skipped_visits->beyond != 0) {
    --skipped_visits->beyond;
    return true;
  }
  const auto at = reinterpret_cast<std::uintptr_t>(frame);
  for (std::uint32_t i = skipped_visits->depth; i-- > 0;) {
    const Visit& visit = skipped_visits->visits[i];
    if (visit.what == what) {
      Drop(i);
      return true;
    }
    if (visit.frame > at) break;
  }
  return false;
}

void ForgetSkipped() {
  if (skipped_visits == nullptr) return;
  SkippedVisits* gone = skipped_visits;
  skipped_visits = nullptr;
  Syscall(SYS_munmap, Argument(gone), static_cast<long>(kBytes));
}

}  // namespace stipple
