// SPDX-License-Identifier: MIT
// Where a thread's events go.
//
// Events are stored into mapped pages of the stream file, so a kill loses none. The price is a
// fresh page for every 512 events: a fault, an allocation, file system work, several nanoseconds
// per event, more than all else but the clock. So only a thread's first chunks are new pages, 16
// KiB doubling to 128 KiB. From then on the thread keeps its window: a full one is copied by one
// write to a new place in the file, cleared and used again while it is still in the cache
// (measured: a quarter of the cost of fresh pages).
//
// A kill at any moment leaves every chunk at least once:
//   1. the copy is written, whole with its header. Killed before the end: the window still counts,
//      and it stands earlier in the file; the first of two chunks of one thread and sequence
//      counts;
//   2. the window's magic is set to zero: from here the copy counts;
//   3. the first word of each granule, then all the window is cleared; it is no chunk meanwhile;
//   4. the new header is written, magic last.
//
// A slot of the window may be reserved but not yet written, when a signal handler that interrupted
// an event fills the window. Its late store must not hit the reused window. Such a slot is still
// zero, or its record open: if there is one, the window stays in the file as it is, a chunk like
// any other, and the thread takes a new one.
#include "runtime/core/chunk.h"

#include <emmintrin.h>
#include <sys/mman.h>

#include "runtime/core/clock_step.h"
#include "runtime/core/ring.h"

namespace stipple {
namespace {

constexpr std::uint64_t kWindowBytes = 128 * 1024;
constexpr std::size_t kBlockWords = 16;

/// Whether all words of a block are function events. Two words at a time: the low half of each,
/// without the exit bit and less one, must be neither negative nor as large as a record's.
bool AreEvents(const EventWord* words) {
  const __m128i mask = _mm_set1_epi64x(kRegionMask);
  const __m128i one = _mm_set1_epi64x(1);
  const __m128i most = _mm_set1_epi32(kMaxRegion - 1);
  __m128i bad = _mm_setzero_si128();
  for (std::size_t i = 0; i < kBlockWords; i += 2) {
    const __m128i pair = _mm_loadu_si128(reinterpret_cast<const __m128i*>(words + i));
    const __m128i less = _mm_sub_epi32(_mm_and_si128(pair, mask), one);
    bad = _mm_or_si128(bad, _mm_or_si128(less, _mm_cmpgt_epi32(less, most)));
  }
  return _mm_movemask_ps(_mm_castsi128_ps(bad)) == 0;
}

/// Whether every slot from `word` to `end` has been written.
bool IsComplete(const EventWord* word, const EventWord* end) {
  while (word < end) {
    while (end - word >= static_cast<std::ptrdiff_t>(kBlockWords) && AreEvents(word))
      word += kBlockWords;
    if (word == end) break;
    if ((*word & kRegionMask) == 0) return false;
    const std::uint64_t words = IsRecord(*word) ? WordsOf(*word) : 1;
    const bool whole = !IsRecord(*word) || IsClosed(*word);
    if (!whole || words == 0 || words > static_cast<std::uint64_t>(end - word)) return false;
    word += words;
  }
  return true;
}

EventWord* FirstWord(char* chunk) {
  return reinterpret_cast<EventWord*>(chunk + sizeof(ChunkHeader));
}

/// Takes `bytes` of the file, mapped; null if recording has stopped, now or before.
char* TakeChunk(Process& process, std::size_t bytes) {
  Holding holding(process.lock);
  if (process.state.load(std::memory_order_relaxed) != State::kRecording) return nullptr;
  int error = 0;
  char* place = TakeBytes(process.file, bytes, &error);
  if (place == nullptr) StopProcess(process, error);
  return place;
}

/// Takes a place for a copied window; false if recording has stopped, now or before.
bool TakeCopyPlace(Process& process, std::uint64_t* offset) {
  Holding holding(process.lock);
  if (process.state.load(std::memory_order_relaxed) != State::kRecording) return false;
  int error = 0;
  const bool taken = TakePlace(process.file, kWindowBytes, offset, &error);
  if (!taken) StopProcess(process, error);
  return taken;
}

/// Whether the thread's chunk can be copied away and used again.
bool CanReuse(const Thread& thread, std::size_t bytes) {
  if (thread.chunk_bytes != kWindowBytes || bytes > kWindowBytes - sizeof(ChunkHeader))
    return false;
  const auto* end = reinterpret_cast<const EventWord*>(
      thread.waste != 0 ? thread.waste
                        : reinterpret_cast<std::uint64_t>(thread.chunk) + kWindowBytes);
  return IsComplete(FirstWord(thread.chunk), end);
}

/// Copies the thread's window to its place in the file and clears it; false if that failed.
bool MoveWindowOn(Process& process, Thread& thread) {
  std::uint64_t offset = 0;
  if (!TakeCopyPlace(process, &offset)) return false;
  const int error = WriteBytes(process.file, offset, thread.chunk, kWindowBytes);
  if (error != 0) {
    Holding holding(process.lock);
    StopProcess(process, error);
    return false;
  }
  for (std::uint64_t granule = 0; granule < kWindowBytes; granule += kGranuleBytes)
    std::atomic_ref<EventWord>(*reinterpret_cast<EventWord*>(thread.chunk + granule))
        .store(0, std::memory_order_release);
  // Ordinary stores: they leave the lines in the cache, which `rep stosb` need not.
  auto* line = reinterpret_cast<__m128i*>(thread.chunk);
  for (std::uint64_t i = 0; i < kWindowBytes / sizeof(__m128i); i += 4)
    for (std::uint64_t j = 0; j < 4; ++j) _mm_store_si128(line + i + j, _mm_setzero_si128());
  return true;
}

/// Takes fresh pages; the old chunk's leave this process's memory, not the file: a slot reserved
/// there before can still be written.
bool TakeFreshChunk(Process& process, Thread& thread, std::size_t bytes) {
  std::uint64_t chunk_bytes = thread.next_bytes;
  const std::uint64_t least = sizeof(ChunkHeader) + bytes;
  if (chunk_bytes < least)
    chunk_bytes = (least + kGranuleBytes - 1) / kGranuleBytes * kGranuleBytes;
  char* place = TakeChunk(process, chunk_bytes);
  if (place == nullptr) return false;
  if (thread.chunk != nullptr)
    Syscall(SYS_madvise, Argument(thread.chunk), static_cast<long>(thread.chunk_bytes),
            MADV_DONTNEED);
  thread.chunk = place;
  thread.chunk_bytes = chunk_bytes;
  if (thread.next_bytes < kWindowBytes) thread.next_bytes *= 2;
  return true;
}

/// Takes a chunk of whichever kind; false if recording has stopped, or the ring has none now.
// NOLINTNEXTLINE(readability-function-size): who, how much, when; what the ring gets back.
bool TakeAnyChunk(Process& process, Thread& thread, std::size_t bytes, std::uint64_t ticks,
                  std::uint32_t* closed) {
  if (HasRing(process.ring))
    return FitsRing(process.ring, bytes) && TakeRingChunk(process, thread, ticks, closed);
  return thread.chunk != nullptr && CanReuse(thread, bytes)
             ? MoveWindowOn(process, thread)
             : TakeFreshChunk(process, thread, bytes);
}

ClockPair PairOf(const char* chunk) {
  const auto* header = reinterpret_cast<const ChunkHeader*>(chunk);
  return {header->ticks, header->raw_ns};
}

/// Begins the chunk with what became of the clock since `before`; returns the bytes.
std::uint64_t WriteClockStep(char* place, const ClockPair& before, const ClockPair& now) {
  constexpr std::uint64_t kWords = sizeof(ClockStep) / sizeof(EventWord);
  auto* record = reinterpret_cast<ClockStep*>(place);
  *record = {0, now.ticks, now.raw_ns, before.ticks, before.raw_ns};
  std::atomic_ref<EventWord>(record->header)
      .store(MakeHeader(ClockStep::kKind, kWords, true), std::memory_order_release);
  return sizeof *record;
}

}  // namespace

bool NextChunk(Process& process, Thread& thread, std::size_t bytes, std::uint64_t ticks) {
  const bool has_before = thread.chunk != nullptr;
  const ClockPair before = has_before ? PairOf(thread.chunk) : ClockPair{};
  std::uint32_t closed = 0;
  if (!TakeAnyChunk(process, thread, bytes, ticks, &closed)) return false;
  std::uint64_t used = sizeof(ChunkHeader);
  if (HasRing(process.ring)) used += WriteOpenFrames(thread, thread.chunk + used, ticks);
  ChunkHeader header{};
  header.bytes = static_cast<std::uint32_t>(thread.chunk_bytes);
  header.kind = ChunkKind::kEvents;
  header.thread = thread.index;
  header.tid = thread.tid;
  header.sequence = thread.sequence++;
  header.ticks = ticks;
  header.lost = thread.lost;
  WriteChunkHeader(process, thread.chunk, header);
  if (HasRing(process.ring)) GiveToRing(process, closed);
  const ClockPair begin{process.begin_ticks, process.begin_raw_ns};
  const ClockPair now = PairOf(thread.chunk);
  if (has_before && ClockStepped(begin, before, now))
    used += WriteClockStep(thread.chunk + used, before, now);
  thread.waste = 0;
  thread.control.cur = reinterpret_cast<std::uint64_t>(thread.chunk) + used;
  thread.chunk_end = thread.control.end =
      reinterpret_cast<std::uint64_t>(thread.chunk) + thread.chunk_bytes;
  return true;
}

}  // namespace stipple
