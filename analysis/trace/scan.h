// SPDX-License-Identifier: MIT
// The one decoder of events: calls a visitor for each event of a thread, in the order of the slots.
//
// A function event holds the low 40 bits of its time. The upper bits follow from the time before
// it: events of a thread are in order, so the least time not before the last one is meant. A signal
// handler between reservation and clock read, or damage, can put a time a little before its
// predecessor: a step back of less than 2^36 ticks is taken as such and the event gets the
// predecessor's time, so that no duration is ever negative. No event is later than the begin of the
// thread's next chunk. An event whose clock was not read lies between its clocked neighbours, in
// equal steps: an estimate; the neighbours are its bounds.
//
// Whatever is rare (records, unclocked runs, damage) is out of line, and state is in registers.
// Most events are plain: a visitor that wants them gets many at once, after one test (HasBlocks).
#ifndef STIPPLE_ANALYSIS_TRACE_SCAN_H
#define STIPPLE_ANALYSIS_TRACE_SCAN_H

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

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
  std::uint64_t clock_steps = 0;
  std::uint64_t first_step_ticks = 0;  // when the first of them was seen
  std::uint64_t damaged_chunks = 0;    // compacted, of which nothing can be read

  std::uint64_t Events() const { return function_events + records; }
  ScanCounts& operator+=(const ScanCounts& o) {
    function_events += o.function_events;
    records += o.records;
    uncommitted += o.uncommitted;
    open_records += o.open_records;
    bad_records += o.bad_records;
    undefined_regions += o.undefined_regions;
    if (clock_steps == 0) first_step_ticks = o.first_step_ticks;
    clock_steps += o.clock_steps;
    damaged_chunks += o.damaged_chunks;
    return *this;
  }
};

/// The words of the chunk that a scan is in: where they lie, or decoded here.
class ChunkWords {
 public:
  /// `fresh`: the scan has just come to this chunk.
  const Chunk& Of(const Chunk& stored, bool fresh, ScanCounts& counts) {
    if (stored.code.empty()) [[likely]]
      return stored;
    if (fresh) Decode(stored, counts);
    return chunk_;
  }

 private:
  void Decode(const Chunk& stored, ScanCounts& counts);
  std::vector<EventWord> words_;
  Chunk chunk_;
};

/// Where a scan can be taken up again, in a few words that can be kept: a scan from here meets the
/// same events with the same times. What a visitor had gathered is the visitor's matter: see
/// ProfileVisitor::OpenVisits.
struct ScanPlace {
  std::uint64_t chunk = 0;
  std::uint64_t words = 0;  // of the chunk that are behind
  std::uint64_t now = 0;
  std::uint64_t step = 0;
  std::uint64_t unclocked = 0;
};

/// Where a scan stands; a fresh one stands before the first event. It is moved, never copied: what
/// a visitor is shown may lie in it, until the scan comes to the next chunk.
struct ScanPosition {
  std::size_t chunk = 0;
  const EventWord* word = nullptr;  // in `chunk`; null: the scan has not come to it yet
  std::uint64_t words_behind = 0;   // of the chunk's words, those before `word`
  std::uint64_t now = 0;            // ticks of the last event
  std::uint64_t step = 0;           // between unclocked events
  std::uint64_t unclocked = 0;      // events left that take a step
  ChunkWords words;

  ScanPosition() = default;
  explicit ScanPosition(const ScanPlace& place)
      : chunk(place.chunk),
        words_behind(place.words),
        now(place.now),
        step(place.step),
        unclocked(place.unclocked) {}
  ScanPlace Place() const { return {chunk, words_behind, now, step, unclocked}; }
  ScanPosition(ScanPosition&&) = default;
  ScanPosition& operator=(ScanPosition&&) = default;
};

/// A copy of the record at `word`, which SoundRecordWords has accepted.
template <class Record>
Record RecordAt(const EventWord* word) {
  Record record;
  std::memcpy(&record, word, sizeof(Record));
  return record;
}

/// Regions of the frames in an OpenFrames record that has been accepted, outermost first; those
/// that are not below region_count as 0.
std::vector<std::uint32_t> OpenRegions(const EventWord* record, std::uint32_t region_count);
/// Whether that is all that was open.
bool AllOpenKnown(const EventWord* record);

/// Words of the record at `word` when it lies wholly in [word, end) and is as long as its kind
/// says; else 0.
std::uint64_t SoundRecordWords(const EventWord* word, const EventWord* end);

/// What a scan does at a record: the words to step over (0: the rest of the chunk cannot be read),
/// whether the record is there to be seen, and the time after it.
struct RecordStep {
  std::uint64_t words = 0;
  bool sound = false;
  std::uint64_t now = 0;
  bool enters = false;  // the record enters `region`, as an event would
  std::uint32_t region = 0;
};
RecordStep StepRecord(const EventWord* word, const Chunk& chunk, std::uint64_t now,
                      std::uint64_t limit, ScanCounts& counts);

/// A run of events without a clock, between two moments that are known.
struct UnclockedRun {
  std::uint64_t events = 0;
  std::uint64_t step = 0;  // between them, as estimated
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};
/// That which begins at `word`.
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

/// A visitor may be told of a run of events without a clock, before the first of them.
template <class Visitor>
concept HasRuns = requires(Visitor& visitor, const EventWord* word, const UnclockedRun& run) {
  visitor.Run(word, run);
};
/// A visitor may want to know which events had no clock: they come here and not to Function.
template <class Visitor>
concept HasUnclocked = requires(Visitor& visitor) {
  visitor.Unclocked(0U, false, 0U);
};

/// A visitor may want to know which enters are records (CountedEnter): they come here and not to
/// Function.
template <class Visitor>
concept HasCounted = requires(Visitor& visitor, const EventWord* record) {
  visitor.Counted(record, 0U, 0U);
};

/// Function events in a row that a visitor may take all at once.
struct PlainEvents {
  const EventWord* end = nullptr;
  std::uint64_t offset = 0;  // from the low 40 bits of the time to ticks, for all of them
  bool is_plain = false;     // else what is before `end` must be taken one by one
};
/// What begins at `word` and ends before `stop`: events whose regions are defined and whose times,
/// all read, do not step back, and are not after `limit`.
PlainEvents FindPlain(const EventWord* word, const EventWord* stop, std::uint32_t region_count,
                      std::uint64_t now, std::uint64_t limit);

/// A visitor may take plain events by the block: `Block(words, count, offset)` sees `count` (> 0)
/// of them, at TimeOf(word) + offset, and returns how many it took; the next one then comes to
/// Function.
template <class Visitor>
concept HasBlocks = requires(Visitor& visitor, const EventWord* words) {
  { visitor.Block(words, std::size_t{}, std::uint64_t{}) } -> std::same_as<std::size_t>;
};
/// A visitor may want to know where chunks begin.
template <class Visitor>
concept HasChunks = requires(Visitor& visitor) {
  visitor.BeginChunk();
};

/// Scans at least `budget` words from `at` (fewer at the end of a chunk), within one chunk. The
/// visitor has
///   void Function(std::uint32_t region, bool leave, std::uint64_t ticks)   region < region_count
///   void Record(const EventWord* record, std::uint64_t ticks)
/// A record that enters a region (CountedEnter) comes as a function event.
/// Regions are the process's numbers; one that is not below region_count comes as 0.
/// Returns false when there is no chunk left.
template <class Visitor>
// NOLINTNEXTLINE(readability-function-size): what is read, how far, from where, and who is told.
bool ScanSome(const ThreadStream& thread, std::uint32_t region_count, std::uint64_t budget,
              ScanPosition& at, ScanCounts& counts, Visitor& visitor) {
  if (at.chunk >= thread.chunks.size()) return false;
  const Chunk& chunk = at.words.Of(thread.chunks[at.chunk], at.word == nullptr, counts);
  const std::uint64_t limit =
      at.chunk + 1 < thread.chunks.size() ? thread.chunks[at.chunk + 1].ticks : thread.end_limit;
  const EventWord* const end = WrittenEnd(chunk);
  const EventWord* w =
      chunk.begin + std::min(at.words_behind, static_cast<std::uint64_t>(end - chunk.begin));
  const EventWord* const stop = w + std::min(static_cast<std::uint64_t>(end - w), budget);
  std::uint64_t now = at.now > chunk.ticks ? at.now : chunk.ticks;
  std::uint64_t step = at.step;
  std::uint64_t unclocked = at.unclocked;
  std::uint64_t function_events = 0;
  PlainEvents plain{w, 0, false};
  if constexpr (HasChunks<Visitor>)
    if (at.word == nullptr && at.words_behind == 0) visitor.BeginChunk();
  decltype(auto) hot = HotPartOf(visitor);
  const auto known = [&counts, region_count](std::uint32_t region) -> std::uint32_t {
    if (region != 0 && region < region_count) [[likely]]
      return region;
    ++counts.undefined_regions;
    return 0;
  };
  while (w < stop) {
    if constexpr (HasBlocks<std::remove_reference_t<decltype(hot)>>) {
      if (w >= plain.end && unclocked == 0) plain = FindPlain(w, stop, region_count, now, limit);
      if (plain.is_plain && w < plain.end) {
        const std::size_t taken =
            hot.Block(w, static_cast<std::size_t>(plain.end - w), plain.offset);
        w += taken;
        function_events += taken;
        if (taken != 0) now = TimeOf(w[-1]) + plain.offset;
        if (w == plain.end) continue;
      }
    }
    EventWord word = *w;
    std::uint32_t region = static_cast<std::uint32_t>(word & kRegionMask);
    const std::uint64_t low = TimeOf(word);
    if (region >= kKindBase) [[unlikely]] {
      const RecordStep record = StepRecord(w, chunk, now, limit, counts);
      if (record.words == 0) w = end;
      // Of a ring only the first chunk's open frames say something new.
      if (record.sound && (KindOf(word) != RecordKind::kOpenFrames || at.chunk == 0)) {
        now = record.now;
        if (!record.enters) hot.Record(w, now);
      }
      const EventWord* const at_record = w;
      w += record.words;
      if (!record.enters) continue;
      region = record.region;
      word = 0;  // an enter
      if constexpr (HasCounted<decltype(hot)>) {
        ++function_events;
        hot.Counted(at_record, known(region), now);
        continue;
      }
    } else if (low == 0) [[unlikely]] {
      if (word == 0) {
        ++counts.uncommitted;
        ++w;
        continue;
      }
      if (unclocked == 0) {
        const UnclockedRun run = MeasureUnclocked(w, end, now, limit);
        unclocked = run.events;
        step = run.step;
        if constexpr (HasRuns<decltype(hot)>) hot.Run(w, run);
      }
      --unclocked;
      now += step;
      ++w;
      if constexpr (HasUnclocked<decltype(hot)>) {
        ++function_events;
        hot.Unclocked(known(region), IsLeave(word), now);
        continue;
      }
    } else {
      now = TicksAfter(now, low, limit);
      ++w;
    }
    ++function_events;
    hot.Function(known(region), IsLeave(word), now);
  }
  if constexpr (HasHotPart<Visitor>) visitor.End(hot);
  counts.function_events += function_events;
  const bool more = w < end;
  at.chunk += more ? 0 : 1;
  at.word = more ? w : nullptr;
  at.words_behind = more ? static_cast<std::uint64_t>(w - chunk.begin) : 0;
  at.now = now;
  at.step = more ? step : 0;
  at.unclocked = more ? unclocked : 0;
  return true;
}

/// Scans the whole thread; `chunk_done(bytes)` is called behind each chunk, `part_done(at)` behind
/// each chunk and within it behind every `part_words` words or so. Between parts nothing of the
/// visitor is in registers: it can be asked for what it knows.
template <class Visitor, class ChunkDone, class PartDone>
// NOLINTNEXTLINE(readability-function-size): what is read, who is told of what.
ScanCounts ScanThread(const ThreadStream& thread, std::uint32_t region_count, Visitor& visitor,
                      ChunkDone&& chunk_done, std::uint64_t part_words, PartDone&& part_done) {
  ScanCounts counts;
  ScanPosition at;
  for (const Chunk& chunk : thread.chunks) {
    do {
      ScanSome(thread, region_count, part_words, at, counts, visitor);
      part_done(static_cast<const ScanPosition&>(at));
    } while (at.word != nullptr);
    chunk_done(chunk.Bytes());
  }
  return counts;
}

}  // namespace stipple

#endif
