// SPDX-License-Identifier: MIT
#include "analysis/trace/scan.h"

#include <algorithm>

namespace stipple {
namespace {

/// Bytes of an event record of fixed size; 0: of a kind whose size varies or is not known.
constexpr std::uint64_t BytesOf(RecordKind kind) {
  switch (kind) {
    case RecordKind::kMark:
      return sizeof(Mark);
    case RecordKind::kCounter:
      return sizeof(Counter);
    case RecordKind::kMpiSend:
      return sizeof(MpiSend);
    case RecordKind::kMpiReceivePost:
      return sizeof(MpiReceivePost);
    case RecordKind::kMpiReceive:
      return sizeof(MpiReceive);
    case RecordKind::kMpiRequestEnd:
      return sizeof(MpiRequestEnd);
    case RecordKind::kMpiCollective:
      return sizeof(MpiCollective);
    case RecordKind::kMpiProbe:
      return sizeof(MpiProbe);
    case RecordKind::kThreadEnd:
      return sizeof(ThreadEnd);
    case RecordKind::kTimeStamp:
      return sizeof(TimeStamp);
    case RecordKind::kJumpPoint:
      return sizeof(JumpPoint);
    case RecordKind::kUnwound:
      return sizeof(Unwound);
    case RecordKind::kStackSwitch:
      return sizeof(StackSwitch);
    case RecordKind::kRegionMode:
      return sizeof(RegionMode);
    case RecordKind::kCountedEnter:
      return sizeof(CountedEnter);
    default:
      return 0;
  }
}

}  // namespace

std::uint64_t SoundRecordWords(const EventWord* word, const EventWord* end) {
  const std::uint64_t words = WordsOf(*word);
  const std::uint64_t expected = BytesOf(KindOf(*word));
  if (words == 0) return 0;
  if (expected != 0 && words * sizeof(EventWord) != expected) return 0;
  return words <= static_cast<std::uint64_t>(end - word) ? words : 0;
}

RecordStep StepRecord(const EventWord* word, const Chunk& chunk, std::uint64_t now,
                      std::uint64_t limit, ScanCounts& counts) {
  // Its last words may be zeros, so it may reach beyond what counts as written.
  const std::uint64_t words = SoundRecordWords(word, chunk.end);
  if (words == 0) {
    ++counts.bad_records;
    return {};
  }
  if (!IsClosed(*word)) {
    ++counts.open_records;
    return {words, false, now};
  }
  const bool has_time = words > 1 && KindOf(*word) < RecordKind::kDefineRegion;
  if (has_time && word[1] >= kMostTicks) {
    ++counts.bad_records;
    return {words, false, now};
  }
  ++counts.records;
  return {words, true, has_time ? std::max(now, std::min(word[1], limit)) : now};
}

UnclockedRun MeasureUnclocked(const EventWord* word, const EventWord* end, std::uint64_t now,
                              std::uint64_t limit) {
  UnclockedRun run;
  std::uint64_t next = limit == kNoTickLimit ? now : std::max(now, limit);
  for (; word < end; ++word) {
    if (IsRecord(*word)) {
      if (word + 1 < end && WordsOf(*word) > 1 && word[1] < limit) next = std::max(now, word[1]);
      break;
    }
    if (TimeOf(*word) != 0) {
      next = TicksAfter(now, TimeOf(*word), limit);
      break;
    }
    if (*word != 0) ++run.events;
  }
  run.step = (next - now) / (run.events + 1);
  return run;
}

const EventWord* WrittenEnd(const Chunk& chunk) {
  const EventWord* end = chunk.end;
  while (end != chunk.begin && end[-1] == 0) --end;
  return end;
}

}  // namespace stipple
