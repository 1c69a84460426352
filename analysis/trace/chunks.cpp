// SPDX-License-Identifier: MIT
#include "analysis/trace/chunks.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

namespace stipple {
namespace {

using Bytes = std::span<const std::byte>;

/// Where chunks may begin.
struct Layout {
  std::size_t first;
  std::uint32_t align;
  bool compacted;
};
constexpr Layout kGranules = {kGranuleBytes, kGranuleBytes, false};
constexpr Layout kCompacted = {kFirstCompactedByte, kCompactedAlign, true};

/// Whole pages of a mapped file; when they are looked at again they are there again.
void ReleasePages(Bytes part) {
  static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(part.data());
  const std::uintptr_t first = begin / page * page;
  const std::uintptr_t last = (begin + part.size()) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

bool IsChunk(const ChunkHeader& h, const Layout& layout) {
  return h.magic == kChunkMagic && h.bytes != 0 && h.bytes % layout.align == 0 &&
         (h.kind == ChunkKind::kEvents || h.kind == ChunkKind::kDefinitions ||
          h.kind == ChunkKind::kKernel || (h.kind == ChunkKind::kCompacted && layout.compacted));
}

bool HasMagic(Bytes file, std::size_t offset) {
  std::uint64_t magic = 0;
  if (offset + sizeof(magic) > file.size()) return false;
  std::memcpy(&magic, file.data() + offset, sizeof(magic));
  return magic == kChunkMagic;
}

/// Bytes of the chunk at `offset`: fewer than its header says where another chunk begins inside it.
std::uint32_t SoundBytes(Bytes file, std::size_t offset, std::uint32_t bytes,
                         const Layout& layout) {
  // Compacted chunks stand side by side: one that ends where the next begins is as long as it says.
  if (layout.compacted && (offset + bytes == file.size() || HasMagic(file, offset + bytes)))
    return bytes;
  for (std::uint32_t at = layout.align; at < bytes && offset + at < file.size(); at += layout.align)
    if (HasMagic(file, offset + at)) return at;
  return bytes;
}

/// The chunk whose header is `h`, cut where the file ends.
Chunk ChunkAt(Bytes file, std::size_t offset, const ChunkHeader& h) {
  const std::size_t end = std::min<std::size_t>(file.size(), offset + h.bytes);
  const std::byte* const behind = file.data() + offset + sizeof(ChunkHeader);
  const std::size_t bytes = end - offset - sizeof(ChunkHeader);
  Chunk chunk;
  chunk.sequence = h.sequence;
  chunk.ticks = h.ticks;
  chunk.raw_ns = h.raw_ns;
  chunk.lost = h.lost;
  chunk.thread = h.thread;
  chunk.tid = h.tid;
  if (h.kind != ChunkKind::kCompacted) {
    chunk.begin = reinterpret_cast<const EventWord*>(behind);
    chunk.end = chunk.begin + bytes / sizeof(EventWord);
    return chunk;
  }
  CompactedChunk compacted{};
  if (bytes > sizeof(compacted)) std::memcpy(&compacted, behind, sizeof(compacted));
  // A frame that is cut off or too long is one that cannot be decoded, and is counted when it is
  // read.
  const std::size_t room = bytes > sizeof(compacted) ? bytes - sizeof(compacted) : 0;
  chunk.code = Bytes(behind, bytes).last(room);
  if (compacted.coded_bytes < room) chunk.code = chunk.code.first(compacted.coded_bytes);
  if (chunk.code.empty()) chunk.code = file.first(1);
  chunk.coded_words = std::min(compacted.words, kMostCompactedWords);
  return chunk;
}

/// Whether a chunk of events has lost its magic and nothing else: its thread copied the window and
/// was killed before it had cleared it. The copy counts, and the window's granules begin with
/// events.
bool IsBeingCleared(const ChunkHeader& h) {
  return h.magic == 0 && h.kind == ChunkKind::kEvents && h.bytes != 0 &&
         h.bytes % kGranuleBytes == 0;
}

void Add(FoundChunks& found, const Chunk& chunk, ChunkKind kind) {
  ThreadStream& t = found.threads[chunk.thread];
  t.thread = chunk.thread;
  t.tid = chunk.tid;
  (kind == ChunkKind::kKernel ? t.kernel : t.chunks).push_back(chunk);
}

EventWord Load(const EventWord* word) { return __atomic_load_n(word, __ATOMIC_ACQUIRE); }

const EventWord* WordsAt(Bytes file, std::size_t offset) {
  return reinterpret_cast<const EventWord*>(file.data() + offset);
}

/// A chunk of a file that is being written.
struct LiveChunk {
  std::size_t offset = 0;
  ChunkHeader header = {};
};

/// The header at `offset`, whole; false: there is none (yet).
bool ReadLiveHeader(Bytes file, LiveChunk& chunk) {
  constexpr std::size_t kWords = sizeof(ChunkHeader) / sizeof(EventWord);
  constexpr std::size_t kSequence = offsetof(ChunkHeader, sequence) / sizeof(EventWord);
  constexpr int kTries = 3;
  const EventWord* const at = WordsAt(file, chunk.offset);
  for (int i = 0; i < kTries; ++i) {
    std::array<EventWord, kWords> words;
    for (std::size_t w = 0; w < kWords; ++w) words[w] = Load(at + w);
    if (words[0] != kChunkMagic) return false;
    if (Load(at) != kChunkMagic || Load(at + kSequence) != words[kSequence]) continue;
    std::memcpy(&chunk.header, words.data(), sizeof(chunk.header));
    if (IsChunk(chunk.header, kGranules) && chunk.offset + chunk.header.bytes <= file.size())
      return true;
  }
  return false;
}

/// Copies what is committed in a chunk that its thread may be filling. False: the thread has gone
/// on to use the chunk's place for the next one, and a copy of this one stands elsewhere, complete.
bool CopyLive(Bytes file, const LiveChunk& chunk, std::vector<EventWord>& words) {
  const EventWord* at = WordsAt(file, chunk.offset + sizeof(ChunkHeader));
  const EventWord* const end = WordsAt(file, chunk.offset + chunk.header.bytes);
  // First how far: then all before it was stored, in that order, before what is loaded next.
  const EventWord* written = end;
  while (written != at && Load(written - 1) == 0) --written;
  while (at < written) {
    const EventWord word = Load(at);
    const std::uint64_t length = word != 0 && IsRecord(word) ? WordsOf(word) : 1;
    if (length == 0 || length > static_cast<std::uint64_t>(end - at)) break;
    const bool committed = word != 0 && (!IsRecord(word) || IsClosed(word));
    if (committed) words.push_back(word);
    for (std::uint64_t i = 1; committed && i < length; ++i) words.push_back(Load(at + i));
    at += length;
  }
  LiveChunk again{chunk.offset, {}};
  return ReadLiveHeader(file, again) && again.header.sequence == chunk.header.sequence &&
         again.header.thread == chunk.header.thread;
}

/// Offsets at which a chunk is or may come to be, ascending. Places of chunks do not move.
std::vector<std::size_t> PlacesOf(Bytes file) {
  std::vector<std::size_t> places;
  for (LiveChunk c{kGranuleBytes, {}}; c.offset + sizeof(ChunkHeader) <= file.size();) {
    places.push_back(c.offset);
    c.offset += ReadLiveHeader(file, c) ? c.header.bytes : kGranuleBytes;
  }
  return places;
}

/// The chunk with a copy of what it holds now; false: it is gone.
bool CopyChunk(Stream& stream, const LiveChunk& live, Chunk& chunk) {
  std::vector<EventWord> words;
  chunk = ChunkAt(stream.file.bytes(), live.offset, live.header);
  if (!CopyLive(stream.file.bytes(), live, words)) return false;
  stream.copies.push_back(std::move(words));
  chunk.begin = stream.copies.back().data();
  chunk.end = chunk.begin + stream.copies.back().size();
  return true;
}

/// Whether a chunk before the last one is missing, for now or for ever. Chunks are in order.
bool LacksAChunk(const std::vector<LiveChunk>& chunks) {
  return chunks.front().header.sequence != 0 ||
         std::ranges::adjacent_find(chunks, [](const LiveChunk& a, const LiveChunk& b) {
           return b.header.sequence > a.header.sequence + 1;
         }) != chunks.end();
}

/// Chunks of one thread, by sequence, of equal ones the first in the file; up to the first gap. The
/// last one is copied. False: it went on too fast, or copied one to where only a `grown` file
/// reaches.
bool TakeThread(Stream& stream, std::vector<LiveChunk>& chunks, bool grown, FoundChunks& found) {
  std::ranges::sort(chunks, {},
                    [](const LiveChunk& c) { return std::pair(c.header.sequence, c.offset); });
  const bool lacks = LacksAChunk(chunks);
  std::size_t last = 0;  // first of those with the highest sequence before a gap
  for (std::size_t i = 1; i < chunks.size(); ++i) {
    const std::uint64_t step = chunks[i].header.sequence - chunks[i - 1].header.sequence;
    if (step > 1) chunks.resize(i);
    if (step == 1) last = i;
  }
  std::vector<Chunk> taken;  // the last one first
  Chunk chunk;
  for (std::size_t i = last; i < chunks.size() && taken.empty(); ++i)
    if (CopyChunk(stream, chunks[i], chunk)) taken.push_back(chunk);
  const bool whole = !taken.empty() && !(lacks && grown);
  // Of a thread that has lost its first chunks the others can be dropped, too, at any moment.
  const bool drops = chunks.front().header.sequence != 0;
  for (std::size_t i = last; i-- > 0;) {
    chunk = ChunkAt(stream.file.bytes(), chunks[i].offset, chunks[i].header);
    if (drops && !CopyChunk(stream, chunks[i], chunk)) break;
    taken.push_back(chunk);
  }
  for (auto c = taken.rbegin(); c != taken.rend(); ++c) Add(found, *c, ChunkKind::kEvents);
  return whole;
}

}  // namespace

// Walks the places. One that is no chunk's begin is skipped; a whole granule of zeros was never
// used.
FoundChunks FindChunks(Stream& stream) {
  // Looking at one header makes pages around it resident, of a large file all: they are given back.
  constexpr std::size_t kMostResident = std::size_t{16} << 20;
  const Bytes file = stream.file.bytes();
  std::size_t released = 0;
  const bool compacted =
      (stream.header.features & static_cast<std::uint64_t>(Feature::kCompacted)) != 0;
  const Layout layout = compacted ? kCompacted : kGranules;
  FoundChunks found;
  bool in_damage = false;
  std::size_t offset = layout.first;
  while (offset + sizeof(ChunkHeader) <= file.size()) {
    ChunkHeader h;
    std::memcpy(&h, file.data() + offset, sizeof(h));
    if (!IsChunk(h, layout)) {
      if (compacted ? !in_damage : h.magic != 0)
        stream.health.Add(Defect::kBadChunk, stream.file_name);
      in_damage = true;
      offset += !compacted && IsBeingCleared(h) ? SoundBytes(file, offset, h.bytes, layout)
                                                : layout.align;
      continue;
    }
    in_damage = false;
    if (const std::uint32_t bytes = SoundBytes(file, offset, h.bytes, layout); bytes != h.bytes) {
      stream.health.Add(Defect::kBadChunk, stream.file_name);
      h.bytes = bytes;
    }
    if (h.ticks >= kMostTicks) {
      stream.health.Add(Defect::kBadTime, stream.file_name);
      h.ticks = 0;  // MendTimes finds it a place
    }
    const Chunk chunk = ChunkAt(file, offset, h);
    if (h.ticks != 0) stream.clock_pairs.push_back({h.ticks, h.raw_ns});
    if (h.kind == ChunkKind::kDefinitions)
      found.definitions.push_back(chunk);
    else
      Add(found, chunk, h.kind);
    if (offset + h.bytes > file.size()) stream.health.Add(Defect::kTruncatedFile, stream.file_name);
    offset += h.bytes;
    if (offset - released < kMostResident || offset > file.size()) continue;
    ReleasePages(file.subspan(released, offset - released));
    released = offset;
  }
  ReleasePages(file.subspan(released));
  if (compacted && offset < file.size())
    stream.health.Add(Defect::kTruncatedFile, stream.file_name);
  return found;
}

// A window that is full is copied to a place further behind, then cleared, then it is the thread's
// next chunk (runtime/core/chunk.cpp). So while a window is chunk n, all chunks before n are
// complete elsewhere, and n's copy is complete once the window is not n any more. Headers are read
// from the end of the file to its begin, copies before windows: what a window says then is true of
// every copy that was seen. A chunk that is not a thread's last one never changes. The last one is
// copied word by word, and the copy counts only if the window is still the same one behind it.
FoundChunks FindLiveChunks(Stream& stream, const std::string& path, bool& whole) {
  const Bytes file = stream.file.bytes();
  const std::vector<std::size_t> places = PlacesOf(file);
  std::map<std::uint32_t, std::vector<LiveChunk>> threads;
  FoundChunks found;
  for (std::size_t i = places.size(); i-- > 0;) {
    LiveChunk c{places[i], {}};
    if (!ReadLiveHeader(file, c)) continue;
    if (c.header.kind == ChunkKind::kEvents) threads[c.header.thread].push_back(c);
    // These are written whole, or grow as definitions do.
    if (c.header.kind == ChunkKind::kKernel)
      Add(found, ChunkAt(file, c.offset, c.header), ChunkKind::kKernel);
  }
  // The file grows before anything is copied to its new end.
  std::error_code none;
  const bool grown = std::filesystem::file_size(path, none) > file.size();
  whole = true;
  for (auto& [number, chunks] : threads) {
    const bool taken = TakeThread(stream, chunks, grown, found);
    whole = whole && taken;
  }
  for (const auto& [number, thread] : found.threads)
    for (const Chunk& c : thread.chunks) stream.clock_pairs.push_back({c.ticks, c.raw_ns});
  return found;
}

void ReleaseChunk(const Stream& stream, const Chunk& chunk) {
  const auto* const words = reinterpret_cast<const std::byte*>(chunk.begin);
  const Bytes part = chunk.code.empty()
                         ? Bytes(words, static_cast<std::size_t>(chunk.end - chunk.begin) * 8)
                         : Bytes(chunk.code.data(), chunk.code.size());
  // Copies of what a process still writes lie elsewhere, in memory that would be lost.
  const Bytes file = stream.file.bytes();
  if (part.data() < file.data() || part.data() + part.size() > file.data() + file.size()) return;
  ReleasePages(part);
}

std::vector<Chunk> FindLiveDefinitions(const MappedFile& mapped) {
  const Bytes file = mapped.bytes();
  std::vector<Chunk> definitions;
  for (const std::size_t offset : PlacesOf(file)) {
    LiveChunk c{offset, {}};
    if (ReadLiveHeader(file, c) && c.header.kind == ChunkKind::kDefinitions &&
        c.header.sequence == definitions.size())
      definitions.push_back(ChunkAt(file, c.offset, c.header));
  }
  return definitions;
}

}  // namespace stipple
