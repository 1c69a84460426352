// SPDX-License-Identifier: MIT
// A kill at any moment leaves every chunk that is not the one being recycled whole:
//   1. the thread's Overwritten record says that its chunks up to this one are gone; its count of
//      chunks is written last and decides;
//   2. the magic is cleared, then all words: it is no chunk meanwhile;
//   3. the new header is written behind its open frames, magic last.
//
// An event may have reserved its slot just before a signal handler filled the rest of the chunk.
// Its late store must not hit another thread's events: such a chunk has a slot that is zero, and is
// passed over until it has none. The window of a thread that has ended is passed over until the
// kernel has forgotten the thread, since destructors may still record.
#include "runtime/core/ring.h"

#include <emmintrin.h>
#include <errno.h>

#include <atomic>

#include "runtime/core/process.h"
#include "runtime/core/stream.h"

namespace stipple {

/// One place. `next` is its neighbour, closed later.
struct RingPlace {
  char* memory;
  Thread* owner;
  std::uint64_t sequence;
  std::uint64_t events;  // in it, once it is closed
  std::uint64_t closed_ticks;
  std::uint32_t next;
  bool is_window;   // of a thread that has ended
  bool incomplete;  // a slot had not been written when it was closed
};

namespace {

constexpr std::uint64_t kMostPlaceBytes = 128 * 1024;
constexpr std::uint64_t kLeastPlaces = 64;
constexpr std::uint64_t kRetryTicks = std::uint64_t{1} << 20;
constexpr std::uint32_t kThreadsAtOnce = 4096 / sizeof(RingThread);

RingPlace& PlaceAt(Ring& ring, std::uint32_t number) { return ring.places[number - 1]; }

EventWord* FirstWord(char* chunk) {
  return reinterpret_cast<EventWord*>(chunk + sizeof(ChunkHeader));
}

std::uint64_t TicksOf(const char* chunk) {
  return reinterpret_cast<const ChunkHeader*>(chunk)->ticks;
}

void PushClosed(Ring& ring, std::uint32_t number) {
  PlaceAt(ring, number).next = 0;
  if (ring.newest != 0)
    PlaceAt(ring, ring.newest).next = number;
  else
    ring.oldest = number;
  ring.newest = number;
}

std::uint32_t PopClosed(Ring& ring) {
  const std::uint32_t number = ring.oldest;
  ring.oldest = PlaceAt(ring, number).next;
  if (ring.oldest == 0) ring.newest = 0;
  return number;
}

/// What the ring keeps of a thread, made at first use; null without memory. The lock is held.
RingThread* RingThreadOf(Ring& ring, Thread& thread) {
  if (thread.ring != nullptr) return thread.ring;
  if (ring.spare_count == 0) {
    ring.spare = static_cast<char*>(MapWipedMemory(4096));
    if (ring.spare == nullptr) return nullptr;
    ring.spare_count = kThreadsAtOnce;
  }
  --ring.spare_count;
  thread.ring = reinterpret_cast<RingThread*>(ring.spare);
  ring.spare += sizeof(RingThread);
  return thread.ring;
}

/// Events of a chunk, the words behind the last one being zero; whether no slot before is.
FoldedChunk CountEvents(char* chunk, std::uint64_t bytes) {
  const EventWord* end = reinterpret_cast<EventWord*>(chunk + bytes);
  const EventWord* first = FirstWord(chunk);
  while (end > first && end[-1] == 0) --end;
  FrameStack none{};
  none.unknown = 1;
  return FoldChunk(none, first, end, TicksOf(chunk));
}

/// The kernel does not know the thread any more.
bool IsGone(const Process& process, const Thread& thread) {
  return Syscall(SYS_tgkill, static_cast<long>(process.pid), static_cast<long>(thread.tid), 0) ==
         -ESRCH;
}

bool MayRecycle(Process& process, RingPlace& place) {
  if (!place.is_window && !place.incomplete) return true;
  const FoldedChunk counted = CountEvents(place.memory, process.ring.place_bytes);
  if (place.is_window) {
    if (!IsGone(process, *place.owner)) return false;
    place.owner->chunk = nullptr;
    place.events = counted.events;
    return true;
  }
  return counted.complete || (place.owner->ended != 0 && IsGone(process, *place.owner));
}

/// Notes that the chunk in `place` is gone; false if that cannot be written. The lock is held.
bool NoteOverwritten(Process& process, const RingPlace& place) {
  RingThread* known = RingThreadOf(process.ring, *place.owner);
  if (known == nullptr) return false;
  if (known->overwritten == nullptr) {
    Overwritten record{};
    record.thread = place.owner->index;
    if (!Define(process, &record, Overwritten::kKind, sizeof record)) return false;
    known->overwritten = reinterpret_cast<Overwritten*>(process.definitions.next - sizeof record);
  }
  Overwritten& record = *known->overwritten;
  record.events += place.events;
  record.bytes += process.ring.place_bytes;
  if (place.closed_ticks > record.from_ticks) record.from_ticks = place.closed_ticks;
  if (place.sequence >= record.chunks)
    std::atomic_ref<std::uint64_t>(record.chunks)
        .store(place.sequence + 1, std::memory_order_release);
  std::atomic_ref<std::uint64_t>(reinterpret_cast<ChunkHeader*>(place.memory)->magic)
      .store(0, std::memory_order_release);
  return true;
}

/// Says once from when on events were lost for want of a place. The lock is held.
void NoteFull(Process& process, std::uint64_t ticks) {
  if (process.ring.said_full != 0) return;
  process.ring.said_full = 1;
  Loss record{};
  record.from_ticks = ticks;
  record.error = ENOBUFS;
  Define(process, &record, Loss::kKind, sizeof record);
}

/// The place closed longest ago whose events may go; 0: none. The lock is held.
std::uint32_t Recycle(Process& process, std::uint64_t ticks) {
  Ring& ring = process.ring;
  const std::uint32_t last = ring.newest;
  while (ring.oldest != 0) {
    const std::uint32_t number = PopClosed(ring);
    if (MayRecycle(process, PlaceAt(ring, number)))
      return NoteOverwritten(process, PlaceAt(ring, number)) ? number : 0;
    PushClosed(ring, number);
    if (number == last) break;
  }
  ring.retry_ticks = ticks + kRetryTicks;
  NoteFull(process, ticks);
  return 0;
}

/// A place for the thread, its old events still in it; 0: none. The lock is held.
std::uint32_t TakePlaceFor(Process& process, Thread& thread, std::uint64_t ticks) {
  Ring& ring = process.ring;
  if (process.state.load(std::memory_order_relaxed) != State::kRecording) return 0;
  if (thread.chunk == nullptr && ticks < ring.retry_ticks) return 0;
  std::uint32_t number = 0;
  if (ring.made < ring.most) {
    int error = 0;
    char* memory = TakeBytes(process.file, ring.place_bytes, &error);
    if (memory == nullptr) {
      StopProcess(process, error);
      return 0;
    }
    number = ++ring.made;
    PlaceAt(ring, number).memory = memory;
  } else {
    number = Recycle(process, ticks);
  }
  if (number == 0) return 0;
  RingPlace& place = PlaceAt(ring, number);
  place = {place.memory, &thread, thread.sequence, 0, 0, 0, false, false};
  return number;
}

/// Reads the thread's full chunk back; returns its place, which is not the ring's yet (0: it is,
/// the thread has ended). The lock is held.
std::uint32_t CloseChunk(Process& process, Thread& thread, std::uint64_t ticks) {
  Ring& ring = process.ring;
  RingThread* known = RingThreadOf(ring, thread);
  RingPlace& place = PlaceAt(ring, thread.place);
  const auto* end = reinterpret_cast<const EventWord*>(
      thread.waste != 0 ? thread.waste
                        : reinterpret_cast<std::uint64_t>(thread.chunk) + thread.chunk_bytes);
  FrameStack none{};
  none.unknown = 1;
  const FoldedChunk folded = FoldChunk(known != nullptr ? known->frames : none,
                                       FirstWord(thread.chunk), end, TicksOf(thread.chunk));
  const std::uint32_t closed = place.is_window ? 0 : thread.place;
  place.events = folded.events;
  place.closed_ticks = ticks;
  place.incomplete = !folded.complete;
  place.is_window = false;
  thread.chunk = nullptr;
  thread.place = 0;
  // Until it has another, every event takes the slow path.
  thread.chunk_end = thread.control.end = 0;
  thread.step = 0;
  return closed;
}

/// No granule may look like a chunk while its words are being cleared.
void ClearPlace(char* memory, std::uint64_t bytes) {
  for (std::uint64_t granule = 0; granule < bytes; granule += kGranuleBytes)
    std::atomic_ref<EventWord>(*reinterpret_cast<EventWord*>(memory + granule))
        .store(0, std::memory_order_release);
  // Ordinary stores: they leave the lines in the cache, which `rep stosb` need not.
  auto* line = reinterpret_cast<__m128i*>(memory);
  for (std::uint64_t i = 0; i < bytes / sizeof(__m128i); i += 4)
    for (std::uint64_t j = 0; j < 4; ++j) _mm_store_si128(line + i + j, _mm_setzero_si128());
}

}  // namespace

void BeginRing(Process& process, std::uint64_t max_bytes) {
  Ring& ring = process.ring;
  std::uint64_t place_bytes = kGranuleBytes;
  while (place_bytes < kMostPlaceBytes && 2 * place_bytes * kLeastPlaces <= max_bytes)
    place_bytes *= 2;
  std::uint64_t most = max_bytes / place_bytes;
  if (most < kLeastPlaces) most = kLeastPlaces;
  if (most > 0x7fffffff) most = 0x7fffffff;
  ring.places = static_cast<RingPlace*>(MapWipedMemory(most * sizeof(RingPlace)));
  if (ring.places == nullptr) return;
  ring.most = static_cast<std::uint32_t>(most);
  ring.place_bytes = place_bytes;
  process.file.ahead_limit = kGranuleBytes + most * place_bytes;
}

bool TakeRingChunk(Process& process, Thread& thread, std::uint64_t ticks, std::uint32_t* closed) {
  std::uint32_t number = 0;
  {
    Holding holding(process.lock);
    *closed = thread.chunk != nullptr ? CloseChunk(process, thread, ticks) : 0;
    number = TakePlaceFor(process, thread, ticks);
    if (number == 0 && *closed != 0) {
      // No other is free: its own.
      PushClosed(process.ring, *closed);
      *closed = 0;
      process.ring.retry_ticks = 0;
      number = TakePlaceFor(process, thread, ticks);
    }
  }
  if (number == 0) return false;
  RingPlace& place = PlaceAt(process.ring, number);
  ClearPlace(place.memory, process.ring.place_bytes);
  thread.place = number;
  thread.chunk = place.memory;
  thread.chunk_bytes = process.ring.place_bytes;
  return true;
}

void GiveToRing(Process& process, std::uint32_t closed) {
  if (closed == 0) return;
  Holding holding(process.lock);
  PushClosed(process.ring, closed);
}

std::uint64_t WriteOpenFrames(const Thread& thread, char* place, std::uint64_t ticks) {
  if (thread.sequence == 0) return 0;
  FrameStack none{};
  none.unknown = 1;
  return WriteFrames(thread.ring != nullptr ? thread.ring->frames : none, place,
                     thread.chunk_bytes / 4, ticks);
}

void EndRingThread(Process& process, Thread& thread, std::uint64_t ticks) {
  if (thread.place == 0) return;
  RingPlace& place = PlaceAt(process.ring, thread.place);
  place.is_window = true;
  place.closed_ticks = ticks;
  PushClosed(process.ring, thread.place);
}

}  // namespace stipple
