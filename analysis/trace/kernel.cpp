// SPDX-License-Identifier: MIT
#include "analysis/trace/kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace stipple {
namespace {

struct NumberedCall {
  std::uint32_t number;
  SystemCallEntry entry;
};
constexpr std::array kCalls = {
#define STIPPLE_SYSTEM_CALL(number, name, parameters) NumberedCall{number, {#name, parameters}},
#include "analysis/trace/system_calls.def"
#undef STIPPLE_SYSTEM_CALL
};

double Signed(std::uint64_t a, std::uint64_t b) {
  return a >= b ? static_cast<double>(a - b) : -static_cast<double>(b - a);
}

}  // namespace

RawClock::RawClock(const Stream& stream, double ns_per_tick)
    : pairs_(stream.clock_pairs), ns_per_tick_(ns_per_tick) {
  std::ranges::sort(pairs_, {}, &ClockPair::raw_ns);
  // Of damage nothing is left that goes back.
  std::vector<ClockPair> rising;
  for (const ClockPair& p : pairs_)
    if (rising.empty() || (p.raw_ns > rising.back().raw_ns && p.ticks > rising.back().ticks))
      rising.push_back(p);
  pairs_ = std::move(rising);
  if (pairs_.size() > 1)
    ns_per_tick_ = Signed(pairs_.back().raw_ns, pairs_.front().raw_ns) /
                   Signed(pairs_.back().ticks, pairs_.front().ticks);
  if (!(ns_per_tick_ > 0)) ns_per_tick_ = 1;
}

std::uint64_t RawClock::Ticks(std::uint64_t raw_ns) const {
  if (pairs_.empty()) return 0;
  const auto next = std::ranges::upper_bound(pairs_, raw_ns, {}, &ClockPair::raw_ns);
  const ClockPair& before = next == pairs_.begin() ? *next : *(next - 1);
  double slope = ns_per_tick_;
  if (next != pairs_.begin() && next != pairs_.end())
    slope = Signed(next->raw_ns, before.raw_ns) / Signed(next->ticks, before.ticks);
  const double ticks = std::clamp(Signed(raw_ns, before.raw_ns) / slope, -9e18, 9e18);
  const auto whole = static_cast<std::int64_t>(std::llround(ticks));
  const std::uint64_t result = before.ticks + static_cast<std::uint64_t>(whole);
  if (whole < 0 && result > before.ticks) return 0;
  if (whole > 0 && result < before.ticks) return kNoTickLimit;
  return result;
}

void ForEachKernelRecord(const ThreadStream& thread, ScanCounts& counts,
                         const std::function<void(const EventWord*, std::uint64_t)>& record) {
  for (const Chunk& chunk : thread.kernel) {
    const EventWord* const end = WrittenEnd(chunk);
    for (const EventWord* w = chunk.begin; w < end;) {
      if (!IsRecord(*w)) {
        ++w;
        continue;
      }
      const std::uint64_t words = SoundRecordWords(w, chunk.end);
      if (words < 2) {
        ++counts.bad_records;
        break;
      }
      if (IsClosed(*w))
        record(w, w[1]);
      else
        ++counts.open_records;
      w += words;
    }
  }
}

KernelAccount ReadKernel(const Trace& trace, const Location& location) {
  const Process& process = trace.ProcessOf(location);
  const RawClock clock(*process.stream, trace.NsPerTick(location));
  const auto time = [&](std::uint64_t raw_ns) {
    constexpr std::int64_t kMost = std::int64_t{1} << 61;  // differences of damage stay numbers
    return std::clamp(trace.TimeNs(location, clock.Ticks(raw_ns)), -kMost, kMost);
  };
  KernelAccount account;
  ScanCounts counts;
  ForEachKernelRecord(*location.stream, counts, [&](const EventWord* word, std::uint64_t raw_ns) {
    if (KindOf(*word) == RecordKind::kCounter) {
      const auto r = RecordAt<Counter>(word);
      account.counts.push_back({time(raw_ns), process.NameOf(r.name), r.value});
    } else if (KindOf(*word) == RecordKind::kContextSwitch) {
      const auto r = RecordAt<ContextSwitch>(word);
      Absence a;
      a.out_ns = time(r.out_ns);
      a.is_back = r.in_ns != 0;
      a.in_ns = a.is_back ? std::max(a.out_ns, time(r.in_ns)) : std::max(a.out_ns, trace.SpanNs());
      a.away_ns = a.in_ns - a.out_ns;
      if (r.count > 1)
        a.away_ns =
            static_cast<std::int64_t>(std::min(static_cast<std::uint64_t>(a.away_ns), r.away_ns));
      a.count = std::max(r.count, 1u);
      a.blocked = r.reason == SwitchReason::kBlocked;
      a.migrated = r.in_cpu != r.out_cpu;
      account.absences.push_back(a);
    }
  });
  std::ranges::stable_sort(account.absences, {}, &Absence::in_ns);
  std::ranges::stable_sort(account.counts, {}, &KernelCount::time_ns);
  return account;
}

bool HasRecorded(const Trace& trace, const Location& location, std::string_view what) {
  const auto& all = trace.ProcessOf(location).stream->availability;
  return std::ranges::any_of(
      all, [what](const AvailabilityDefinition& a) { return a.what == what && a.available; });
}

const SystemCallEntry* SystemCallOf(std::uint32_t number) {
  const auto entry = std::ranges::lower_bound(kCalls, number, {}, &NumberedCall::number);
  return entry != kCalls.end() && entry->number == number ? &entry->entry : nullptr;
}

std::string NameOf(const Trace& trace, const Process& process, const SystemCall& call) {
  if (const std::uint32_t name = process.NameOf(call.name); name != 0)
    return trace.names()[name].text;
  const SystemCallEntry* entry = SystemCallOf(call.number);
  return entry != nullptr ? std::string(entry->name) : "call " + std::to_string(call.number);
}

bool MovesBytes(std::uint32_t number) {
  constexpr std::array<std::string_view, 16> kMovers = {
      "read",    "write",    "pread64",  "pwrite64",       "readv",  "writev",
      "sendto",  "recvfrom", "sendmsg",  "recvmsg",        "preadv", "pwritev",
      "preadv2", "pwritev2", "sendfile", "copy_file_range"};
  const SystemCallEntry* entry = SystemCallOf(number);
  return entry != nullptr && std::ranges::find(kMovers, entry->name) != kMovers.end();
}

}  // namespace stipple
