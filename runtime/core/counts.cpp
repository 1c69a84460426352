// SPDX-License-Identifier: MIT
// Begin and end of a thread's counts (sample.h).
#include "runtime/core/region.h"
#include "runtime/core/sample.h"

namespace stipple {
namespace {

/// What follows a VisitCounts.
struct Entry {
  std::uint32_t region;
  std::uint32_t thread;
  std::uint64_t visits;
};
static_assert(sizeof(Entry) == 16);
constexpr std::uint64_t kMostEntries = 32;

void WriteEntries(Process& process, const Entry* entries, std::uint64_t count) {
  VisitCounts record{};
  record.entries = count;
  Define(process, &record, VisitCounts::kKind, sizeof record,
         reinterpret_cast<const char*>(entries), count * sizeof(Entry));
}

/// Writes what a thread has counted and takes it off.
void WriteCounts(Process& process, Counts& counts, std::uint32_t thread) {
  Entry entries[kMostEntries];
  std::uint64_t count = 0;
  for (std::uint32_t region = 1; region <= LastRegion() && region < kCountedRegions; ++region) {
    std::uint64_t& word = counts.words[region];
    const std::int64_t visits = CountIn(word);
    if (visits <= 0) continue;
    entries[count++] = {region, thread, static_cast<std::uint64_t>(visits)};
    word -= static_cast<std::uint64_t>(visits) << 32;
    if (count == kMostEntries) {
      WriteEntries(process, entries, count);
      count = 0;
    }
  }
  if (count != 0) WriteEntries(process, entries, count);
}

}  // namespace

Counts* MakeCounts(Thread& thread) {
  if (thread.counts == nullptr) {
    auto* counts = static_cast<Counts*>(MapWipedMemory(sizeof(Counts)));
    if (counts == nullptr) return nullptr;
    counts->random = thread.index;
    thread.counts = counts;
    thread.control.counts = counts->words;
  }
  return thread.counts;
}

void EndCounts(Process& process, Thread& thread) {
  Counts* counts = thread.counts;
  if (counts == nullptr) return;
  thread.control.counts = nullptr;
  thread.counts = nullptr;
  WriteCounts(process, *counts, thread.index);
  Syscall(SYS_munmap, Argument(counts), sizeof(Counts));
}

void WriteVisitCounts(Process& process) {
  for (const Thread* thread = process.threads; thread != nullptr; thread = thread->next)
    if (thread->counts != nullptr) WriteCounts(process, *thread->counts, thread->index);
}

}  // namespace stipple
