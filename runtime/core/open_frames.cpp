// SPDX-License-Identifier: MIT
#include "runtime/core/open_frames.h"

#include <sys/mman.h>

#include <atomic>

#include "runtime/core/syscalls.h"

namespace stipple {
namespace {

constexpr std::uint32_t kMostPoints = 1024;
constexpr std::uint64_t kBackwardTicks = std::uint64_t{1} << 36;  // as the reader's

/// A place for one more; null without memory.
template <class Item>
Item* Push(Growing<Item>& items) {
  if (items.count == items.room) {
    const std::uint64_t bytes = items.room * sizeof(Item);
    const long grown = items.room == 0
                           ? Argument(MapWipedMemory(4096))
                           : Syscall(SYS_mremap, Argument(items.items), static_cast<long>(bytes),
                                     static_cast<long>(2 * bytes), MREMAP_MAYMOVE);
    if (grown == 0 || IsError(grown)) return nullptr;
    items.items = reinterpret_cast<Item*>(grown);
    items.room = items.room == 0 ? 4096 / sizeof(Item) : 2 * items.room;
  }
  return &items.items[items.count++];
}

/// The full time of an event, in a chunk whose last full time was `ticks`; 0: it has none.
std::uint64_t FullTicks(EventWord word, std::uint64_t ticks) {
  if (TimeOf(word) == 0) return 0;
  const std::uint64_t forward = (TimeOf(word) - ticks) & kTimeMask;
  return forward <= kTimeMask - kBackwardTicks ? ticks + forward : ticks;
}

void Forget(FrameStack& stack) {
  stack.frames.count = stack.points.count = 0;
  stack.unknown = 1;
}

void Enter(FrameStack& stack, std::uint32_t region, std::uint64_t ticks) {
  if (stack.unknown != 0) return;
  OpenFrame* frame = Push(stack.frames);
  if (frame == nullptr) return Forget(stack);
  *frame = {ticks, region, 0};
}

void Leave(FrameStack& stack, std::uint32_t region) {
  std::uint32_t depth = stack.frames.count;
  while (depth > 0 && stack.frames.items[depth - 1].region != region) --depth;
  if (depth > 0) stack.frames.count = depth - 1;
}

/// Points of functions that have been left are dead.
void DropDeadPoints(FrameStack& stack) {
  Growing<OpenPoint>& points = stack.points;
  while (points.count > 0 && points.items[points.count - 1].depth > stack.frames.count)
    --points.count;
}

void RemovePoint(Growing<OpenPoint>& points, std::uint32_t index) {
  for (--points.count; index < points.count; ++index) points.items[index] = points.items[index + 1];
}

void SetPoint(FrameStack& stack, std::uint64_t sp) {
  DropDeadPoints(stack);
  Growing<OpenPoint>& points = stack.points;
  for (std::uint32_t i = points.count; i-- > 0;)
    if (points.items[i].stack == sp) {
      RemovePoint(points, i);
      break;
    }
  if (points.count == kMostPoints) RemovePoint(points, 0);
  OpenPoint* point = Push(points);
  if (point == nullptr) return Forget(stack);
  *point = {sp, stack.frames.count};
}

void Unwind(FrameStack& stack, std::uint64_t sp) {
  std::uint64_t depth = 0;
  for (std::uint32_t i = 0; i < stack.points.count; ++i)
    if (stack.points.items[i].stack == sp) depth = stack.points.items[i].depth;
  if (depth < stack.frames.count) stack.frames.count = static_cast<std::uint32_t>(depth);
}

void Follow(FrameStack& stack, const EventWord* record) {
  switch (KindOf(*record)) {
    case RecordKind::kJumpPoint:
      if (stack.unknown == 0) SetPoint(stack, reinterpret_cast<const JumpPoint*>(record)->stack);
      return;
    case RecordKind::kUnwound:
      return Unwind(stack, reinterpret_cast<const Unwound*>(record)->stack);
    case RecordKind::kThreadEnd:
      stack.frames.count = 0;
      return;
    case RecordKind::kStackSwitch:
      return Forget(stack);
    case RecordKind::kCountedEnter:
      return Enter(stack, reinterpret_cast<const CountedEnter*>(record)->region, record[1]);
    default:
      return;
  }
}

/// Events up to the first that is not plain: an enter with room for it, or a leave of the innermost
/// frame. What each touches is in registers.
// NOLINTNEXTLINE(readability-function-size): from where to where, since when; what was found.
const EventWord* FoldEvents(FrameStack& stack, const EventWord* word, const EventWord* end,
                            std::uint64_t ticks, FoldedChunk& folded) {
  if (stack.unknown != 0) return word;
  OpenFrame* const frames = stack.frames.items;
  OpenFrame* top = frames + stack.frames.count;
  OpenFrame* const limit = frames + stack.frames.room;
  const EventWord* const begin = word;
  for (; word < end; ++word) {
    const auto region = static_cast<std::uint32_t>(*word & kRegionMask);
    if (region - 1 >= kMaxRegion) break;
    if (!IsLeave(*word)) {
      if (top == limit) break;
      *top++ = {FullTicks(*word, ticks), region, 0};
    } else {
      if (top == frames || top[-1].region != region) break;
      --top;
    }
  }
  stack.frames.count = static_cast<std::uint32_t>(top - frames);
  folded.events += static_cast<std::uint64_t>(word - begin);
  return word;
}

void FoldRareEvent(FrameStack& stack, EventWord word, std::uint64_t ticks) {
  const auto region = static_cast<std::uint32_t>(word & kRegionMask);
  if (IsLeave(word))
    Leave(stack, region);
  else
    Enter(stack, region, FullTicks(word, ticks));
}

}  // namespace

FoldedChunk FoldChunk(FrameStack& stack, const EventWord* word, const EventWord* end,
                      std::uint64_t ticks) {
  FoldedChunk folded{0, true};
  while (word < end) {
    word = FoldEvents(stack, word, end, ticks, folded);
    if (word == end) break;
    if ((*word & kRegionMask) == 0) {
      folded.complete = false;
      ++word;
      continue;
    }
    if (!IsRecord(*word)) {
      FoldRareEvent(stack, *word++, ticks);
      ++folded.events;
      continue;
    }
    const std::uint64_t words = WordsOf(*word);
    const bool sound = words > 1 && words <= static_cast<std::uint64_t>(end - word);
    folded.complete = folded.complete && sound && IsClosed(*word);
    if (!sound) break;
    if (IsClosed(*word) && KindOf(*word) != RecordKind::kOpenFrames) {
      ++folded.events;
      if (word[1] > ticks) ticks = word[1];
      Follow(stack, word);
    }
    word += words;
  }
  return folded;
}

std::uint64_t WriteFrames(const FrameStack& stack, char* place, std::uint64_t most,
                          std::uint64_t ticks) {
  OpenFrames record{};
  record.ticks = ticks;
  record.depth = stack.frames.count;
  record.unknown = stack.unknown;
  const std::uint64_t room = (most - sizeof record) / sizeof(OpenFrame);
  // Points are few; what is left belongs to the innermost frames.
  std::uint64_t points = 0;
  while (points < stack.points.count && points < room / 4 &&
         stack.points.items[points].depth <= stack.frames.count)
    ++points;
  const std::uint64_t frames =
      stack.frames.count < room - points ? stack.frames.count : room - points;
  record.frames = static_cast<std::uint32_t>(frames);
  record.points = static_cast<std::uint32_t>(points);
  const std::uint64_t bytes = sizeof record + (frames + points) * sizeof(OpenFrame);
  record.header = MakeHeader(OpenFrames::kKind, bytes / 8, true);
  CopyBytes(place, &record, sizeof record);
  place += sizeof record;
  CopyBytes(place, stack.frames.items + (stack.frames.count - frames), frames * sizeof(OpenFrame));
  CopyBytes(place + frames * sizeof(OpenFrame), stack.points.items, points * sizeof(OpenPoint));
  return bytes;
}

}  // namespace stipple
