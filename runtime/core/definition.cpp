// SPDX-License-Identifier: MIT
// Definition chunks. Each keeps room at its end for a Loss and a ProcessEnd record, so that a full
// disk can still be told from a crash.
#include "runtime/core/clock.h"
#include "runtime/core/process.h"
#include "runtime/core/recorder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kLargestChunkBytes = 256 * 1024;
constexpr std::size_t kKeptBytes = sizeof(Loss) + sizeof(ProcessEnd);

/// Takes a definition chunk with room for `bytes`; 0 or an errno.
int NextChunk(Process& process, std::size_t bytes) {
  DefinitionChunk& chunk = process.definitions;
  const std::size_t least = sizeof(ChunkHeader) + bytes + kKeptBytes;
  std::size_t chunk_bytes = chunk.next_bytes != 0 ? chunk.next_bytes : kGranuleBytes;
  if (chunk_bytes < least)
    chunk_bytes = (least + kGranuleBytes - 1) / kGranuleBytes * kGranuleBytes;
  int error = 0;
  char* place = TakeBytes(process.file, chunk_bytes, &error);
  if (place == nullptr) return error;
  ChunkHeader header{};
  header.bytes = static_cast<std::uint32_t>(chunk_bytes);
  header.kind = ChunkKind::kDefinitions;
  header.tid = GetTid();
  header.sequence = chunk.sequence++;
  header.lost = process.lost.load(std::memory_order_relaxed);
  WriteChunkHeader(process, place, header);
  chunk.next = place + sizeof(ChunkHeader);
  chunk.end = place + chunk_bytes - kKeptBytes;
  chunk.loss = reinterpret_cast<Loss*>(chunk.end);
  chunk.process_end = reinterpret_cast<ProcessEnd*>(chunk.end + sizeof(Loss));
  chunk.next_bytes = chunk_bytes < kLargestChunkBytes ? 2 * chunk_bytes : kLargestChunkBytes;
  return 0;
}

}  // namespace

void WriteChunkHeader(const Process& process, char* chunk, const ChunkHeader& header) {
  ClockPair pair = ReadClockPair();
  if (header.ticks != 0 && pair.ticks > process.begin_ticks) {
    // Moved back by a few microseconds, at the rate seen since the stream began.
    const double ns_per_tick = static_cast<double>(pair.raw_ns - process.begin_raw_ns) /
                               static_cast<double>(pair.ticks - process.begin_ticks);
    const double since = static_cast<double>(pair.ticks - header.ticks);
    pair = {header.ticks, pair.raw_ns - static_cast<std::uint64_t>(since * ns_per_tick)};
  }
  auto* place = reinterpret_cast<ChunkHeader*>(chunk);
  *place = header;
  place->ticks = pair.ticks;
  place->raw_ns = pair.raw_ns;
  std::atomic_ref<std::uint64_t>(place->magic).store(kChunkMagic, std::memory_order_release);
}

// NOLINTNEXTLINE(readability-function-size): three are sizes of what stands before them.
bool Define(Process& process, const void* record, RecordKind kind, std::size_t bytes,
            const char* text, std::size_t text_bytes, const char* more, std::size_t more_bytes) {
  if (process.state.load(std::memory_order_relaxed) == State::kStopped) return false;
  const std::size_t whole = (bytes + text_bytes + more_bytes + 7) & ~std::size_t{7};
  if (whole / 8 > kMaxRecordWords) return false;
  DefinitionChunk& chunk = process.definitions;
  if (chunk.next == nullptr || chunk.next + whole > chunk.end) {
    const int error = NextChunk(process, whole);
    if (error != 0) {
      StopProcess(process, error);
      return false;
    }
  }
  char* place = chunk.next;
  chunk.next += whole;
  std::atomic_ref<EventWord> header(*reinterpret_cast<EventWord*>(place));
  header.store(MakeHeader(kind, whole / 8, false), std::memory_order_release);
  CopyBytes(place + 8, static_cast<const char*>(record) + 8, bytes - 8);
  CopyBytes(place + bytes, text, text_bytes);
  CopyBytes(place + bytes + text_bytes, more, more_bytes);
  header.store(MakeHeader(kind, whole / 8, true), std::memory_order_release);
  return true;
}

}  // namespace stipple

extern "C" void stipple_define(const void* record, uint8_t kind, size_t bytes, const void* text,
                               size_t text_bytes) {
  const stipple::SignalBlock signals_blocked;
  stipple::Process* process = stipple::BeginProcess();
  if (process == nullptr || bytes < 8) return;
  stipple::Holding holding(process->lock);
  stipple::Define(*process, record, static_cast<stipple::RecordKind>(kind), bytes,
                  static_cast<const char*>(text), text_bytes);
}
