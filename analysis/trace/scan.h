// SPDX-License-Identifier: MIT
// The one decoder of events: calls a visitor for each event of a thread, in the order of the slots.
//
// A function event holds the low 40 bits of its time. The upper bits follow from the time before
// it: events of a thread are in order, so the least time not before the last one is meant. A signal
// handler between reservation and clock read, or damage, can put a time a little before its
// predecessor: a step back of less than 2^36 ticks is taken as such and the event gets the
// predecessor's time, so that no duration is ever negative. No event is later than the begin of the
// thread's next chunk. An event whose clock was not read lies between its clocked neighbours, in
// equal steps.
//
// The loop touches each word once and keeps its state in registers: about 2 ns an event. Whatever
// is rare (records, unclocked runs, damage) is out of line.
#ifndef STIPPLE_ANALYSIS_TRACE_SCAN_H
#define STIPPLE_ANALYSIS_TRACE_SCAN_H

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "analysis/trace/stream.h"
#include "stipple/format.h"

namespace stipple {

/// What a scan met besides events.
struct ScanCounts {
  std::uint64_t function_events = 0;
  std::uint64_t records = 0;
  std::uint64_t uncommitted = 0;
  std::uint64_t open_records = 0;
  std::uint64_t bad_records = 0;
  std::uint64_t undefined_regions = 0;

  std::uint64_t Events() const { return function_events + records; }
  ScanCounts& operator+=(const ScanCounts& o) {
    function_events += o.function_events;
    records += o.records;
    uncommitted += o.uncommitted;
    open_records += o.open_records;
    bad_records += o.bad_records;
    undefined_regions += o.undefined_regions;
    return *this;
  }
};

/// Where a scan stands; a fresh one stands before the first event.
struct ScanPosition {
  std::size_t chunk = 0;
  const EventWord* word = nullptr;  // in `chunk`; null: at its begin
  std::uint64_t now = 0;            // ticks of the last event
  std::uint64_t step = 0;           // between unclocked events
  std::uint64_t unclocked = 0;      // events left that take a step
};

/// Words of the record at `word` when it lies wholly in [word, end) and is as long as its kind
/// says; else 0.
std::uint64_t SoundRecordWords(const EventWord* word, const EventWord* end);

/// What a scan does at a record: the words to step over (0: the rest of the chunk cannot be read),
/// whether the record is there to be seen, and the time after it.
struct RecordStep {
  std::uint64_t words = 0;
  bool sound = false;
  std::uint64_t now = 0;
};
RecordStep StepRecord(const EventWord* word, const Chunk& chunk, std::uint64_t now,
                      std::uint64_t limit, ScanCounts& counts);

/// The unclocked run that begins at `word`: how many, and the step between them.
struct UnclockedRun {
  std::uint64_t events = 0;
  std::uint64_t step = 0;
};
UnclockedRun MeasureUnclocked(const EventWord* word, const EventWord* end, std::uint64_t now,
                              std::uint64_t limit);

inline constexpr std::uint64_t kBackwardTicks = std::uint64_t{1} << 36;
/// No event is later: a counter would have to run for decades, so a larger time is damage.
inline constexpr std::uint64_t kNoTickLimit = kMostTicks;

/// The time of the event whose low 40 bits are `low`, after an event at `now`.
constexpr std::uint64_t TicksAfter(std::uint64_t now, std::uint64_t low, std::uint64_t limit) {
  const std::uint64_t forward = (low - now) & kTimeMask;
  const std::uint64_t ticks = forward <= kTimeMask - kBackwardTicks ? now + forward : now;
  return ticks < limit ? ticks : limit;
}

/// End of what was written: zeros behind it were never reserved.
const EventWord* WrittenEnd(const Chunk& chunk);

/// A visitor may keep what each event touches in a part of its own that the scan holds as a local
/// object (Begin hands it out, End takes it back): only then can the compiler keep it in registers.
template <class Visitor>
concept HasHotPart = requires(Visitor& visitor) {
  visitor.End(visitor.Begin());
};
template <class Visitor>
Visitor& HotPartOf(Visitor& visitor) {
  return visitor;
}
template <HasHotPart Visitor>
auto HotPartOf(Visitor& visitor) {
  return visitor.Begin();
}

/// Scans at least `budget` words from `at` (fewer at the end of a chunk), within one chunk. The
/// visitor has
///   void Function(std::uint32_t region, bool leave, std::uint64_t ticks)   region < region_count
///   void Record(const EventWord* record, std::uint64_t ticks)
/// Regions are the process's numbers; one that is not below region_count comes as 0.
/// Returns false when there is no chunk left.
template <class Visitor>
// NOLINTNEXTLINE(readability-function-size): what is read, how far, from where, and who is told.
bool ScanSome(const ThreadStream& thread, std::uint32_t region_count, std::uint64_t budget,
              ScanPosition& at, ScanCounts& counts, Visitor& visitor) {
  if (at.chunk >= thread.chunks.size()) return false;
  const Chunk& chunk = thread.chunks[at.chunk];
  const std::uint64_t limit =
      at.chunk + 1 < thread.chunks.size() ? thread.chunks[at.chunk + 1].ticks : kNoTickLimit;
  const EventWord* const end = WrittenEnd(chunk);
  const EventWord* w = at.word == nullptr ? chunk.begin : at.word;
  const EventWord* const stop = w + std::min(static_cast<std::uint64_t>(end - w), budget);
  std::uint64_t now = at.now > chunk.ticks ? at.now : chunk.ticks;
  std::uint64_t step = at.step;
  std::uint64_t unclocked = at.unclocked;
  std::uint64_t function_events = 0;
  decltype(auto) hot = HotPartOf(visitor);
  while (w < stop) {
    const EventWord word = *w;
    std::uint32_t region = static_cast<std::uint32_t>(word & kRegionMask);
    if (region >= kKindBase) [[unlikely]] {
      const RecordStep record = StepRecord(w, chunk, now, limit, counts);
      if (record.words == 0) w = end;
      if (record.sound) {
        now = record.now;
        hot.Record(w, now);
      }
      w += record.words;
      continue;
    }
    const std::uint64_t low = TimeOf(word);
    if (low == 0) [[unlikely]] {
      if (word == 0) {
        ++counts.uncommitted;
        ++w;
        continue;
      }
      if (unclocked == 0) {
        const UnclockedRun run = MeasureUnclocked(w, end, now, limit);
        unclocked = run.events;
        step = run.step;
      }
      --unclocked;
      now += step;
    } else {
      now = TicksAfter(now, low, limit);
    }
    if (region == 0 || region >= region_count) [[unlikely]] {
      region = 0;
      ++counts.undefined_regions;
    }
    ++function_events;
    hot.Function(region, IsLeave(word), now);
    ++w;
  }
  if constexpr (HasHotPart<Visitor>) visitor.End(hot);
  counts.function_events += function_events;
  at = w < end ? ScanPosition{at.chunk, w, now, step, unclocked}
               : ScanPosition{at.chunk + 1, nullptr, now, 0, 0};
  return true;
}

/// Scans the whole thread; `chunk_done(bytes)` is called behind each chunk.
template <class Visitor, class ChunkDone>
ScanCounts ScanThread(const ThreadStream& thread, std::uint32_t region_count, Visitor& visitor,
                      ChunkDone&& chunk_done) {
  ScanCounts counts;
  ScanPosition at;
  for (const Chunk& chunk : thread.chunks) {
    ScanSome(thread, region_count, kNoTickLimit, at, counts, visitor);
    chunk_done(chunk.Bytes());
  }
  return counts;
}

/// A copy of the record at `word`, which SoundRecordWords has accepted.
template <class Record>
Record RecordAt(const EventWord* word) {
  Record record;
  std::memcpy(&record, word, sizeof(Record));
  return record;
}

}  // namespace stipple

#endif
