// SPDX-License-Identifier: MIT
#include "analysis/trace/stream_index.h"

#include <cstdint>
#include <vector>

namespace stipple {
namespace {

/// A Chunk whose place is an offset in the file.
struct SavedChunk {
  std::uint64_t offset = 0;  // of the words or the code
  std::uint64_t bytes = 0;
  std::uint64_t is_coded = 0;
  std::uint64_t coded_words = 0;
  std::uint64_t sequence = 0;
  std::uint64_t ticks = 0;
  std::uint64_t raw_ns = 0;
  std::uint64_t lost = 0;
  std::uint32_t thread = 0;
  std::uint32_t tid = 0;
};

void PutChunks(const Stream& stream, const std::vector<Chunk>& chunks, ByteWriter& to) {
  const std::byte* const file = stream.file.bytes().data();
  std::vector<SavedChunk> saved;
  for (const Chunk& c : chunks) {
    const bool coded = !c.code.empty();
    const auto* begin = coded ? c.code.data() : reinterpret_cast<const std::byte*>(c.begin);
    const std::uint64_t bytes =
        coded ? c.code.size() : static_cast<std::uint64_t>(c.end - c.begin) * sizeof(EventWord);
    saved.push_back({static_cast<std::uint64_t>(begin - file), bytes, coded ? 1U : 0U,
                     c.coded_words, c.sequence, c.ticks, c.raw_ns, c.lost, c.thread, c.tid});
  }
  to.PutAll(saved);
}

bool GetChunks(ByteReader& from, const Stream& stream, std::vector<Chunk>& chunks) {
  const std::span<const std::byte> file = stream.file.bytes();
  for (const SavedChunk& s : from.GetAll<SavedChunk>()) {
    if (s.offset > file.size() || s.bytes > file.size() - s.offset) return false;
    Chunk c;
    c.sequence = s.sequence;
    c.ticks = s.ticks;
    c.raw_ns = s.raw_ns;
    c.lost = s.lost;
    c.thread = s.thread;
    c.tid = s.tid;
    if (s.is_coded != 0) {
      if (s.bytes == 0 || s.coded_words > kMostCompactedWords) return false;
      c.code = file.subspan(s.offset, s.bytes);
      c.coded_words = s.coded_words;
    } else {
      if (s.offset % sizeof(EventWord) != 0) return false;
      c.begin = reinterpret_cast<const EventWord*>(file.data() + s.offset);
      c.end = c.begin + s.bytes / sizeof(EventWord);
    }
    chunks.push_back(c);
  }
  return from.sound();
}

}  // namespace

void PutHealth(const TraceHealth& health, ByteWriter& to) {
  to.Put(static_cast<std::uint64_t>(health.problems().size()));
  for (const Problem& p : health.problems()) {
    to.Put(static_cast<std::uint32_t>(p.defect));
    to.PutText(p.where);
    to.Put(p.count);
    to.Put(static_cast<std::uint64_t>(p.when.has_value()));
    to.Put(p.when.value_or(ProblemSpan{}));
  }
}

TraceHealth GetHealth(ByteReader& from) {
  TraceHealth health;
  const auto count = from.Get<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && from.sound(); ++i) {
    const auto defect = static_cast<Defect>(from.Get<std::uint32_t>());
    const std::string where = from.GetText();
    const auto problems = from.Get<std::uint64_t>();
    const bool has_when = from.Get<std::uint64_t>() != 0;
    const auto when = from.Get<ProblemSpan>();
    if (from.sound())
      health.Add(defect, where, problems, has_when ? std::optional(when) : std::nullopt);
  }
  return health;
}

std::vector<std::string_view> SavedStreams(const IndexFile* index, std::size_t files) {
  std::vector<std::string_view> saved(files);
  for (std::size_t i = 0; index != nullptr && i < files; ++i)
    saved[i] = index->Bytes("stream." + std::to_string(i));
  return saved;
}

std::string SavedStream(const Stream& stream) {
  ByteWriter to;
  PutChunks(stream, stream.definitions, to);
  to.Put(static_cast<std::uint64_t>(stream.threads.size()));
  for (const ThreadStream& t : stream.threads) {
    to.Put(t.thread);
    to.Put(t.tid);
    to.Put(t.end_limit);
    to.Put(t.facts.value_or(ThreadFacts{}));
    PutChunks(stream, t.chunks, to);
    PutChunks(stream, t.kernel, to);
  }
  to.PutAll(stream.clock_pairs);
  to.PutAll(stream.losses);
  to.Put(stream.lost);
  PutHealth(stream.health, to);
  return to.bytes();
}

bool LoadChunks(ByteReader& saved, Stream& stream) {
  if (!GetChunks(saved, stream, stream.definitions)) return false;
  const auto threads = saved.Get<std::uint64_t>();
  for (std::uint64_t i = 0; i < threads && saved.sound(); ++i) {
    ThreadStream& t = stream.threads.emplace_back();
    t.thread = saved.Get<std::uint32_t>();
    t.tid = saved.Get<std::uint32_t>();
    t.end_limit = saved.Get<std::uint64_t>();
    t.facts = saved.Get<ThreadFacts>();
    if (!GetChunks(saved, stream, t.chunks) || !GetChunks(saved, stream, t.kernel)) return false;
  }
  return saved.sound();
}

bool LoadFindings(ByteReader& saved, Stream& stream) {
  stream.clock_pairs = saved.GetAll<ClockPair>();
  stream.losses = saved.GetAll<LostSpan>();
  stream.lost = saved.Get<std::uint64_t>();
  stream.health = GetHealth(saved);
  return saved.Done();
}

}  // namespace stipple
