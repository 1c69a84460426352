// SPDX-License-Identifier: MIT
// What other libraries need to record beside the events: to be told, and chunks of their own.
#include "runtime/core/observer.h"

#include "runtime/core/file.h"
#include "runtime/core/process.h"
#include "runtime/core/stream.h"

namespace stipple {

constinit std::atomic<const stipple_observer*> observers[kMostObservers] = {};

}  // namespace stipple

extern "C" {

bool stipple_observe(const struct stipple_observer* observer) {
  for (auto& entry : stipple::observers) {
    const stipple_observer* none = nullptr;
    if (entry.compare_exchange_strong(none, observer, std::memory_order_acq_rel)) return true;
  }
  return false;
}

void stipple_begin_thread(void) {
  if (stipple_recording()) stipple::BeginThread();
}

char* stipple_take_chunk(uint32_t kind, uint32_t thread, uint32_t tid, uint64_t sequence,
                         uint64_t lost, size_t bytes) {
  using namespace stipple;
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return nullptr;
  char* chunk = nullptr;
  {
    Holding holding(process->lock);
    int error = 0;
    chunk = TakeBytes(process->file, bytes, &error);
    if (chunk == nullptr) StopProcess(*process, error);
  }
  if (chunk == nullptr) return nullptr;
  ChunkHeader header{};
  header.bytes = static_cast<std::uint32_t>(bytes);
  header.kind = static_cast<ChunkKind>(kind);
  header.thread = thread;
  header.tid = tid;
  header.sequence = sequence;
  header.lost = lost;
  WriteChunkHeader(*process, chunk, header);
  return chunk;
}
}
