// SPDX-License-Identifier: MIT
// Counts of a whole thread, noted when it begins, when it ends and, if it records much, with each
// chunk of events. The hardware's are read without the kernel (rdpmc) from events that only their
// mapping holds, like the ring.
#include "runtime/system/counts.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>

#include "runtime/core/clock.h"
#include "runtime/core/line.h"
#include "runtime/core/recorder.h"
#include "runtime/core/syscalls.h"

namespace stipple::system {
namespace {

struct Name {
  const char* text;
  std::atomic<std::uint32_t> id;  // ids hold in a forked child, too
};
enum Count { kFaults, kMajorFaults, kBlocked, kPreempted, kCounts };
constinit Name names[kCounts] = {{"page faults", {0}},
                                 {"major page faults", {0}},
                                 {"voluntary switches", {0}},
                                 {"involuntary switches", {0}}};
struct Hardware {
  Name name;
  std::uint64_t config;
};
constinit Hardware hardware[kHardwareCounters] = {
    {{"instructions", {0}}, PERF_COUNT_HW_INSTRUCTIONS},
    {{"cycles", {0}}, PERF_COUNT_HW_CPU_CYCLES},
    {{"cache misses", {0}}, PERF_COUNT_HW_CACHE_MISSES}};

constexpr long kPageBytes = 4096;

std::uint32_t IdOf(Name& name) {
  std::uint32_t id = name.id.load(std::memory_order_relaxed);
  if (id == 0) {
    id = stipple_define_name(name.text, "");
    name.id.store(id, std::memory_order_relaxed);
  }
  return id;
}

void Note(KernelThread& thread, std::uint64_t now_ns, Name& name, std::uint64_t value) {
  Counter record{};
  record.ticks = now_ns;
  record.name = IdOf(name);
  record.value = static_cast<double>(value);
  if (record.name != 0) AppendKernel(thread, record);
}

/// What perf_event_open(2) prescribes: again if the kernel changed the page meanwhile. False: the
/// counter is not on the processor.
bool ReadCounter(const perf_event_mmap_page& page, std::uint64_t* value) {
  const volatile perf_event_mmap_page& shared = page;
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::uint32_t sequence = shared.lock;
    __asm__ volatile("" ::: "memory");
    const std::uint32_t index = shared.index;
    std::int64_t count = shared.offset;
    if (shared.cap_user_rdpmc == 0 || index == 0) return false;
    const unsigned unused = 64u - shared.pmc_width;
    std::uint64_t read = __builtin_ia32_rdpmc(static_cast<int>(index - 1)) << unused;
    count += static_cast<std::int64_t>(read) >> unused;
    __asm__ volatile("" ::: "memory");
    if (shared.lock != sequence) continue;
    *value = static_cast<std::uint64_t>(count);
    return true;
  }
  return false;
}

/// Reads /proc/self/task/TID/`file` into `text`; empty if that fails.
template <std::size_t kBytes>
void ReadTaskFile(std::uint32_t tid, const char* file, char (&text)[kBytes]) {
  Line<64> path;
  path.Add("/proc/self/task/").Add(tid).Add("/").Add(file);
  text[0] = '\0';
  const long descriptor = Syscall(SYS_open, Argument(path.text()), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  const long bytes = Syscall(SYS_read, descriptor, Argument(text), kBytes - 1);
  text[bytes > 0 ? bytes : 0] = '\0';
  Syscall(SYS_close, descriptor);
}

std::uint64_t NumberAt(const char* text) {
  while (*text == ' ' || *text == '\t') ++text;
  std::uint64_t number = 0;
  for (; *text >= '0' && *text <= '9'; ++text) number = number * 10 + (*text - '0');
  return number;
}

/// Behind the first `word` of the text; its end if there is none.
const char* Behind(const char* text, const char* word) {
  const std::size_t bytes = TextBytes(word);
  for (; *text != '\0'; ++text) {
    std::size_t same = 0;
    while (same < bytes && text[same] == word[same]) ++same;
    if (same == bytes) return text + bytes;
  }
  return text;
}

/// The n-th field behind the program's name, which may hold anything: "state" is the first.
std::uint64_t StatField(const char* stat, int n) {
  const char* field = stat;
  for (const char* c = stat; *c != '\0'; ++c)
    if (*c == ')') field = c + 1;
  for (; n > 0 && *field != '\0'; ++field)
    if (*field == ' ' && --n == 0) return NumberAt(field);
  return 0;
}

}  // namespace

int OpenCounters(KernelThread& thread) {
  int error = 0;
  for (std::size_t i = 0; i < kHardwareCounters && error == 0; ++i) {
    perf_event_attr attributes;
    auto* bytes = reinterpret_cast<char*>(&attributes);
    for (std::size_t b = 0; b < sizeof attributes; ++b) bytes[b] = 0;
    attributes.size = sizeof attributes;
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.config = hardware[i].config;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    const long descriptor =
        Syscall(SYS_perf_event_open, Argument(&attributes), 0, -1, -1, PERF_FLAG_FD_CLOEXEC);
    if (descriptor < 0) return static_cast<int>(-descriptor);
    const long page = Syscall(SYS_mmap, 0, kPageBytes, PROT_READ, MAP_SHARED, descriptor, 0);
    Syscall(SYS_close, descriptor);
    if (IsError(page)) return static_cast<int>(-page);
    thread.counters[i] = reinterpret_cast<perf_event_mmap_page*>(page);
    if (thread.counters[i]->cap_user_rdpmc == 0) error = EOPNOTSUPP;
  }
  return error;
}

void CloseCounters(KernelThread& thread) {
  for (perf_event_mmap_page*& page : thread.counters) {
    if (page != nullptr) Syscall(SYS_munmap, Argument(page), kPageBytes);
    page = nullptr;
  }
}

void NoteOwnCounts(KernelThread& thread) {
  rusage usage{};
  constexpr long kThisThread = 1;
  if (Syscall(SYS_getrusage, kThisThread, Argument(&usage)) != 0) return;
  const std::uint64_t now_ns = ReadClockNs(CLOCK_MONOTONIC_RAW);
  const long values[kCounts] = {usage.ru_minflt, usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
  for (int i = 0; i < kCounts; ++i)
    Note(thread, now_ns, names[i], static_cast<std::uint64_t>(values[i]));
  for (std::size_t i = 0; i < kHardwareCounters; ++i) {
    std::uint64_t value = 0;
    if (thread.counters[i] != nullptr && ReadCounter(*thread.counters[i], &value))
      Note(thread, now_ns, hardware[i].name, value);
  }
}

void NoteCountsOf(KernelThread& thread) {
  char stat[512];
  char status[4096];
  ReadTaskFile(thread.tid, "stat", stat);
  ReadTaskFile(thread.tid, "status", status);
  if (stat[0] == '\0' || status[0] == '\0') return;
  const std::uint64_t now_ns = ReadClockNs(CLOCK_MONOTONIC_RAW);
  constexpr int kMinorField = 8, kMajorField = 10;
  Note(thread, now_ns, names[kFaults], StatField(stat, kMinorField));
  Note(thread, now_ns, names[kMajorFaults], StatField(stat, kMajorField));
  Note(thread, now_ns, names[kBlocked], NumberAt(Behind(status, "\nvoluntary_ctxt_switches:")));
  Note(thread, now_ns, names[kPreempted], NumberAt(Behind(status, "nonvoluntary_ctxt_switches:")));
}

}  // namespace stipple::system
