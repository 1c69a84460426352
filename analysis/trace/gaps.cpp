// SPDX-License-Identifier: MIT
#include "analysis/trace/gaps.h"

#include <algorithm>
#include <optional>

#include "analysis/trace/chunks.h"
#include "analysis/trace/scan.h"

namespace stipple {
namespace {

// A damaged count must not pass for a loss.
constexpr std::uint64_t kMostLost = std::uint64_t{1} << 48;

/// The step with which a chunk begins. Such a chunk is never compacted.
std::optional<ClockStep> StepOf(const Chunk& chunk) {
  const EventWord* word = chunk.begin;
  while (word != chunk.end && IsRecord(*word) && IsClosed(*word)) {
    const std::uint64_t words = SoundRecordWords(word, chunk.end);
    if (words == 0) break;
    if (KindOf(*word) == RecordKind::kClockStep) {
      const auto step = RecordAt<ClockStep>(word);
      if (step.ticks < kMostTicks && step.before_ticks < kMostTicks) return step;
      break;
    }
    if (KindOf(*word) != RecordKind::kOpenFrames) break;
    word += words;
  }
  return std::nullopt;
}

/// The ticks that a clock would have shown at `raw_ns`, at its rate between the stream's begin and
/// the step.
std::uint64_t TicksWithoutStep(const FileHeader& h, const ClockStep& step, std::uint64_t raw_ns) {
  if (step.before_raw_ns <= h.start_raw_ns || step.before_ticks <= h.start_ticks ||
      raw_ns <= step.before_raw_ns)
    return step.before_ticks;
  const double rate = static_cast<double>(step.before_ticks - h.start_ticks) /
                      static_cast<double>(step.before_raw_ns - h.start_raw_ns);
  const double since = rate * static_cast<double>(raw_ns - step.before_raw_ns);
  return since < static_cast<double>(kMostTicks - step.before_ticks)
             ? step.before_ticks + static_cast<std::uint64_t>(since)
             : step.before_ticks;
}

/// The last time that the stream knows of.
std::uint64_t EndTicks(const Stream& stream) {
  std::uint64_t last = stream.end ? stream.end->ticks : 0;
  for (const ThreadStream& t : stream.threads)
    if (!t.chunks.empty()) last = std::max(last, t.chunks.back().ticks);
  return last;
}

/// From when on events may have been lost of which no chunk tells.
std::uint64_t UntoldFrom(const Stream& stream) {
  std::uint64_t from = kMostTicks;
  for (const Loss& loss : stream.loss_records) from = std::min(from, loss.from_ticks);
  if (from != kMostTicks) return from;
  for (const ThreadStream& t : stream.threads)
    if (!t.chunks.empty()) from = std::min(from, t.chunks.back().ticks);
  return from == kMostTicks ? stream.header.start_ticks : from;
}

}  // namespace

bool BeginsWithStep(const Chunk& chunk) { return StepOf(chunk).has_value(); }

std::uint64_t DropOverwritten(ThreadStream& thread, const Stream& stream) {
  std::uint64_t first = 0;
  for (const Overwritten& o : stream.overwritten)
    if (o.thread == thread.thread) first = std::max(first, o.chunks);
  std::erase_if(thread.chunks, [first](const Chunk& c) { return c.sequence < first; });
  return first;
}

void MendSteps(ThreadStream& thread, Stream& stream) {
  std::optional<ClockStep> first;
  std::uint64_t before = 0;
  for (Chunk& chunk : thread.chunks) {
    if (!first) {
      first = StepOf(chunk);
      ReleaseChunk(stream, chunk);  // a look at its begin has brought what is around
      // A clock that ran ahead is only told of: times stay in order.
      if (first && first->ticks >= first->before_ticks) return;
    }
    if (first) {
      const std::uint64_t ticks = TicksWithoutStep(stream.header, *first, chunk.raw_ns);
      chunk.ticks = std::max(before, std::max(chunk.ticks, ticks));
    }
    before = chunk.ticks;
  }
  if (!first) return;
  const std::uint64_t end_ns = stream.end ? stream.end->raw_ns : 0;
  thread.end_limit = std::max(before, TicksWithoutStep(stream.header, *first, end_ns));
  std::erase_if(stream.clock_pairs,
                [&](const ClockPair& p) { return p.raw_ns > first->before_raw_ns; });
}

void PlaceLosses(Stream& stream) {
  std::uint64_t told = 0;
  for (const ThreadStream& thread : stream.threads) {
    const Chunk* last = nullptr;
    for (const Chunk& chunk : thread.chunks) {
      const std::uint64_t lost = last == nullptr ? 0 : last->lost;
      if (chunk.lost > lost && chunk.lost < kMostLost) {
        const std::uint64_t from = last == nullptr ? stream.header.start_ticks : last->ticks;
        stream.losses.push_back({std::min(from, chunk.ticks), chunk.ticks, chunk.lost - lost});
        told += chunk.lost - lost;
      }
      last = &chunk;
    }
  }
  if (stream.lost > told) {
    const std::uint64_t from = UntoldFrom(stream);
    stream.losses.push_back({from, std::max(from, EndTicks(stream)), stream.lost - told});
  }
  stream.lost = std::max(stream.lost, told);
}

}  // namespace stipple
