// SPDX-License-Identifier: MIT
#include "analysis/trace/scan.h"

#include <algorithm>

#include "analysis/trace/chunk_code.h"

namespace stipple {
namespace {

/// Bytes of an event record of fixed size; 0: of a kind whose size varies or is not known.
constexpr std::uint64_t BytesOf(RecordKind kind) {
  switch (kind) {
    case RecordKind::kMark:
      return sizeof(Mark);
    case RecordKind::kTransmission:
      return sizeof(Transmission);
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
    case RecordKind::kThreadSend:
      return sizeof(ThreadSend);
    case RecordKind::kThreadReceive:
      return sizeof(ThreadReceive);
    case RecordKind::kRegionMode:
      return sizeof(RegionMode);
    case RecordKind::kCountedEnter:
      return sizeof(CountedEnter);
    case RecordKind::kClockStep:
      return sizeof(ClockStep);
    case RecordKind::kContextSwitch:
      return sizeof(ContextSwitch);
    default:
      return 0;
  }
}

constexpr std::ptrdiff_t kGroup = 32;        // words that are looked at together
constexpr std::ptrdiff_t kMostPlain = 1024;  // so that they are still in the nearest cache
constexpr std::ptrdiff_t kLeastPlain = 8;    // fewer are not worth a block

/// What is set if the region at `word` is not defined, or the time there is before that of the word
/// in front of it: then the difference borrows from bits that no difference of less than 2^29 ticks
/// reaches. (A longer silence is taken for odd, too; then kMostPlain words cannot add up to 2^40
/// ticks, and where the times wrap the last one is below the first.) No branch, and operations that
/// any processor has for several words at once.
std::uint64_t OddBits(const EventWord* word, std::uint64_t region_count) {
  const std::uint64_t region = *word & kRegionMask;
  const std::uint64_t difference = (*word | (kLeaveBit | kRegionMask)) - word[-1];
  return (region - 1) | (region_count - 1 - region) | difference;
}
constexpr std::uint64_t kOdd = ~((std::uint64_t{1} << 53) - 1);
static_assert(kMostPlain <= std::ptrdiff_t{1} << 10);

/// How far from `word` on words follow the one in front of them as plain events do.
const EventWord* PlainEnd(const EventWord* word, const EventWord* stop,
                          std::uint64_t region_count) {
  for (; stop - word >= kGroup; word += kGroup) {
    std::uint64_t odd = 0;
    for (std::ptrdiff_t i = 0; i < kGroup; i += 8) __builtin_prefetch(word + kMostPlain + i);
    for (std::ptrdiff_t i = 0; i < kGroup; ++i) odd |= OddBits(word + i, region_count);
    if ((odd & kOdd) != 0) break;
  }
  while (word < stop && (OddBits(word, region_count) & kOdd) == 0) ++word;
  return word;
}

/// Bytes of a whole OpenFrames record; never those of a record that does not fit.
std::uint64_t OpenFramesBytes(const EventWord* word, const EventWord* end) {
  if (static_cast<std::uint64_t>(end - word) * sizeof(EventWord) < sizeof(OpenFrames)) return 1;
  const auto r = RecordAt<OpenFrames>(word);
  return sizeof r + std::uint64_t{r.frames} * sizeof(OpenFrame) +
         std::uint64_t{r.points} * sizeof(OpenPoint);
}

/// Bytes of the frames behind the struct of a native stack, `words` long; nothing if it is too
/// short for its struct.
template <class Record>
bool HoldsFrames(const EventWord* word, std::uint64_t words) {
  if (words * sizeof(EventWord) < sizeof(Record)) return false;
  return words == sizeof(Record) / sizeof(EventWord) + RecordAt<Record>(word).frames;
}

/// Whether a record of a kind whose size varies is as long as it says inside; an open one need not
/// say it yet.
bool IsWhole(const EventWord* word, std::uint64_t words) {
  if (!IsClosed(*word)) return true;
  switch (KindOf(*word)) {
    case RecordKind::kSample:
      return HoldsFrames<Sample>(word, words);
    case RecordKind::kCallPath:
      return HoldsFrames<CallPath>(word, words);
    case RecordKind::kCrash:
      return HoldsFrames<Crash>(word, words);
    default:
      return true;
  }
}

/// A system call has up to six parameters.
bool IsSoundCall(std::uint64_t words) {
  constexpr std::uint64_t kLeast = sizeof(SystemCall) / sizeof(EventWord);
  return words >= kLeast && words <= kLeast + 6;
}

}  // namespace

void ChunkWords::Decode(const Chunk& stored, ScanCounts& counts) {
  thread_local ChunkDecoder decoder;  // larger than the words, and one is enough for many scans
  words_.resize(stored.coded_words);
  chunk_ = stored;
  chunk_.begin = chunk_.end = words_.data();
  if (decoder.Decode(stored.code, words_))
    chunk_.end += stored.coded_words;
  else
    ++counts.damaged_chunks;
}

PlainEvents FindPlain(const EventWord* word, const EventWord* stop, std::uint32_t region_count,
                      std::uint64_t now, std::uint64_t limit) {
  const std::uint64_t region = *word & kRegionMask;
  const std::uint64_t low = TimeOf(*word);
  PlainEvents plain{word + 1, 0, false};
  if (low == 0 || region == 0 || region >= region_count) return plain;
  plain.end =
      PlainEnd(word + 1, word + std::min<std::ptrdiff_t>(stop - word, kMostPlain), region_count);
  const std::uint64_t forward = (low - now) & kTimeMask;
  const std::uint64_t last = TimeOf(plain.end[-1]);
  plain.offset = now + forward - low;
  plain.is_plain = plain.end - word >= kLeastPlain && last >= low &&
                   forward <= kTimeMask - kBackwardTicks && last + plain.offset <= limit;
  return plain;
}

std::vector<std::uint32_t> OpenRegions(const EventWord* record, std::uint32_t region_count) {
  std::vector<std::uint32_t> regions(RecordAt<OpenFrames>(record).frames);
  const EventWord* frame = record + sizeof(OpenFrames) / sizeof(EventWord);
  for (std::uint32_t& region : regions) {
    region = RecordAt<OpenFrame>(frame).region;
    if (region >= region_count) region = 0;
    frame += sizeof(OpenFrame) / sizeof(EventWord);
  }
  return regions;
}

bool AllOpenKnown(const EventWord* record) {
  const auto r = RecordAt<OpenFrames>(record);
  return r.unknown == 0 && r.frames >= r.depth;
}

std::uint64_t SoundRecordWords(const EventWord* word, const EventWord* end) {
  const std::uint64_t words = WordsOf(*word);
  const std::uint64_t expected = KindOf(*word) == RecordKind::kOpenFrames && IsClosed(*word)
                                     ? OpenFramesBytes(word, end)
                                     : BytesOf(KindOf(*word));
  if (words == 0) return 0;
  if (KindOf(*word) == RecordKind::kSystemCall && !IsSoundCall(words)) return 0;
  if (expected != 0 && words * sizeof(EventWord) != expected) return 0;
  if (words > static_cast<std::uint64_t>(end - word)) return 0;
  return IsWhole(word, words) ? words : 0;
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
  if (KindOf(*word) == RecordKind::kOpenFrames) return {words, true, std::max(now, chunk.ticks)};
  RecordStep step{words, true, has_time ? std::max(now, std::min(word[1], limit)) : now};
  step.enters = KindOf(*word) == RecordKind::kCountedEnter;
  if (step.enters)
    step.region = RecordAt<CountedEnter>(word).region;
  else
    ++counts.records;  // the others are counted as function events
  if (KindOf(*word) == RecordKind::kClockStep && counts.clock_steps++ == 0)
    counts.first_step_ticks = now;
  return step;
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
  run.begin = now;
  run.end = next;
  run.step = (next - now) / (run.events + 1);
  return run;
}

const EventWord* WrittenEnd(const Chunk& chunk) {
  const EventWord* end = chunk.end;
  while (end != chunk.begin && end[-1] == 0) --end;
  return end;
}

}  // namespace stipple
