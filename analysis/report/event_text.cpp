// SPDX-License-Identifier: MIT
#include "analysis/report/event_text.h"

#include <fmt/format.h>
#include <string.h>

#include <algorithm>

#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"
#include "analysis/trace/kernel.h"
#include "analysis/trace/native_stack.h"

namespace stipple {
namespace {

/// A rank of a communicator as world rank, "?" when the communicator is not defined.
std::string WorldText(const Trace& trace, const Process& p, std::uint32_t communicator,
                      std::int32_t rank) {
  const std::int32_t world = trace.communicators()[p.CommunicatorOf(communicator)].WorldRank(rank);
  return world < 0 ? "?" : std::to_string(world);
}

const Region& RegionOfProcess(const Trace& trace, const Process& p, std::uint32_t region) {
  return trace.regions()[region < p.regions.size() ? p.regions[region] : 0];
}

std::string CollectiveText(const Trace& trace, const Process& p, const MpiCollective& r) {
  const std::string root = r.root < 0 ? "none" : WorldText(trace, p, r.communicator, r.root);
  return fmt::format("collective {} root {} sent {} received {}",
                     RegionOfProcess(trace, p, r.region).name, root, r.bytes_sent,
                     r.bytes_received);
}

std::string CounterText(const Trace& trace, const Process& p, const Counter& r) {
  const Name& name = trace.names()[p.NameOf(r.name)];
  return fmt::format("counter {} {}{}{}", name.text, r.value, name.unit.empty() ? "" : " ",
                     name.unit);
}

/// Both ends of a message between threads.
template <class End>
std::string ThreadMessageText(const Trace& trace, const Process& p, const char* what,
                              const End& r) {
  return fmt::format("{} {} through {} key {}", what, r.bytes,
                     trace.channels()[p.ChannelOf(r.channel)], r.key);
}

/// Records that a canonical text shows.
std::string StableText(const Trace& trace, const Process& p, const EventWord* record) {
  switch (KindOf(*record)) {
    case RecordKind::kMark:
      return fmt::format("mark {}", trace.names()[p.NameOf(RecordAt<Mark>(record).name)].text);
    case RecordKind::kCounter:
      return CounterText(trace, p, RecordAt<Counter>(record));
    case RecordKind::kMpiSend: {
      const auto r = RecordAt<MpiSend>(record);
      return fmt::format("send {} to {} tag {}", r.bytes,
                         WorldText(trace, p, r.communicator, r.receiver), r.tag);
    }
    case RecordKind::kMpiReceive: {
      const auto r = RecordAt<MpiReceive>(record);
      return fmt::format("receive {} from {} tag {}", r.bytes,
                         WorldText(trace, p, r.communicator, r.sender), r.tag);
    }
    case RecordKind::kMpiCollective:
      return CollectiveText(trace, p, RecordAt<MpiCollective>(record));
    case RecordKind::kThreadSend:
      return ThreadMessageText(trace, p, "send", RecordAt<ThreadSend>(record));
    case RecordKind::kThreadReceive:
      return ThreadMessageText(trace, p, "receive", RecordAt<ThreadReceive>(record));
    case RecordKind::kThreadEnd:
      return "thread end";
    default:
      return {};
  }
}

constexpr const char* NameOf(RegionModeKind mode) {
  switch (mode) {
    case RegionModeKind::kTimed:
      return "timed";
    case RegionModeKind::kNoClock:
      return "without times";
    case RegionModeKind::kCounted:
      return "counted";
  }
  return "in an unknown mode";
}

std::string ModeText(const Trace& trace, const Process& p, const RegionMode& r) {
  return fmt::format("from here on {} is {}: {} visits until now",
                     RegionOfProcess(trace, p, r.region).name, NameOf(r.mode), r.visits);
}

/// "read(3, 0x7ffe0010, 4096) = 12"
std::string SystemCallText(const Trace& trace, const Process& p, const EventWord* record) {
  const auto r = RecordAt<SystemCall>(record);
  std::size_t count = WordsOf(*record) - sizeof(SystemCall) / sizeof(EventWord);
  const SystemCallEntry* entry = SystemCallOf(r.number);
  if (r.name == 0 && entry != nullptr) count = std::min<std::size_t>(count, entry->parameters);
  std::string text = NameOf(trace, p, r) + "(";
  for (std::size_t i = 0; i < count; ++i) {
    const auto value =
        static_cast<std::int64_t>(record[sizeof(SystemCall) / sizeof(EventWord) + i]);
    constexpr std::int64_t kLikelyAddress = std::int64_t{1} << 32;
    text += i == 0 ? "" : ", ";
    text += value >= kLikelyAddress ? fmt::format("{:#x}", value) : std::to_string(value);
  }
  constexpr std::int64_t kLastError = -4095;
  if (r.result >= 0 || r.result < kLastError) return text + fmt::format(") = {}", r.result);
  const char* error = strerrorname_np(static_cast<int>(-r.result));
  return text + fmt::format(") = -1 {}", error != nullptr ? error : std::to_string(-r.result));
}

std::string SwitchText(const ContextSwitch& r) {
  const char* why = r.reason == SwitchReason::kBlocked ? "blocked" : "preempted";
  std::string text =
      r.in_ns == 0
          ? fmt::format("{} until the end", why)
          : fmt::format("{} for {}", why, FormatSeconds(static_cast<double>(r.away_ns) * 1e-9));
  if (r.count > 1) text += fmt::format(" in {} times", r.count);
  return text + (r.in_cpu == r.out_cpu ? fmt::format(", processor {}", r.in_cpu)
                                       : fmt::format(", processor {} to {}", r.out_cpu, r.in_cpu));
}

/// "main > work > leaf", the runtime's and the C library's beginnings included.
std::string NativePathText(const Trace& trace, const Process& p, const EventWord* record) {
  std::string text;
  for (const std::string& name : PathOf(trace, p, FramesOf(record)))
    text += (text.empty() ? "" : " > ") + ShortName(name);
  return text;
}

std::string CrashText(const Trace& trace, const Process& p, const EventWord* record) {
  const auto r = RecordAt<Crash>(record);
  std::string text =
      r.signal == 0 ? "stack at a crash of another thread" : "crash by " + SignalName(r.signal);
  if (r.signal != 0 && r.code > 0) text += fmt::format(" at {:#x}", r.address);
  for (const std::string& line : StackLines(trace, p, FramesOf(record)))
    text += "\n" + std::string(24, ' ') + "in " + line;
  return text;
}

/// Records that depend on timing.
std::string TimingText(const Trace& trace, const Process& p, const EventWord* record) {
  switch (KindOf(*record)) {
    case RecordKind::kMpiReceivePost:
      return fmt::format("receive posted, request {}", RecordAt<MpiReceivePost>(record).request);
    case RecordKind::kMpiRequestEnd: {
      const auto r = RecordAt<MpiRequestEnd>(record);
      const char* how = r.outcome == 2 ? "cancelled" : r.outcome == 3 ? "freed" : "completed";
      return fmt::format("request {} {}", r.request, how);
    }
    case RecordKind::kMpiProbe: {
      const auto r = RecordAt<MpiProbe>(record);
      return fmt::format("probe {} from {} tag {}", r.bytes,
                         WorldText(trace, p, r.communicator, r.sender), r.tag);
    }
    case RecordKind::kTransmission: {
      const auto r = RecordAt<Transmission>(record);
      return fmt::format("transmission of {} bytes to {}", r.bytes, r.receiver);
    }
    case RecordKind::kRegionMode:
      return ModeText(trace, p, RecordAt<RegionMode>(record));
    case RecordKind::kSample:
      return fmt::format("sample of {:.3f} ms: {}",
                         static_cast<double>(RecordAt<Sample>(record).cpu_ns) * 1e-6,
                         NativePathText(trace, p, record));
    case RecordKind::kCallPath:
      return "native path: " + NativePathText(trace, p, record);
    case RecordKind::kCrash:
      return CrashText(trace, p, record);
    case RecordKind::kTimeStamp:
      return "time stamp";
    case RecordKind::kSystemCall:
      return SystemCallText(trace, p, record);
    case RecordKind::kContextSwitch:
      return SwitchText(RecordAt<ContextSwitch>(record));
    case RecordKind::kJumpPoint:
      return "jump point";
    case RecordKind::kUnwound:
      return "unwound";
    case RecordKind::kStackSwitch:
      return "stack switch";
    case RecordKind::kOpenFrames: {
      const auto r = RecordAt<OpenFrames>(record);
      return r.unknown != 0 ? "open frames unknown" : fmt::format("{} open frames", r.depth);
    }
    case RecordKind::kClockStep: {
      const auto r = RecordAt<ClockStep>(record);
      return fmt::format("clock step, from {} to {} ticks", r.before_ticks, r.ticks);
    }
    default:
      return fmt::format("record of kind {}", static_cast<unsigned>(KindOf(*record)));
  }
}

/// How long a receiver looked for its message; empty when it did not say.
std::string WaitedText(const Trace& trace, const Location& location, const ThreadReceive& r) {
  if (r.waiting_since == 0 || r.waiting_since > r.ticks) return {};
  const std::int64_t ns = trace.TimeNs(location, r.ticks) - trace.TimeNs(location, r.waiting_since);
  return ", waited " + FormatSeconds(static_cast<double>(ns) * 1e-9);
}

std::string SpanText(const Trace& trace, const Location& location, const Transmission& r) {
  return fmt::format(", {:.9f} to {:.9f}",
                     static_cast<double>(trace.TimeNs(location, r.begin_ticks)) * 1e-9,
                     static_cast<double>(trace.TimeNs(location, r.end_ticks)) * 1e-9);
}

}  // namespace

std::string CanonicalText(const Trace& trace, const Location& location, const Event& event) {
  if (event.record == nullptr)
    return std::string(event.leave ? "leave " : "enter ")
        .append(trace.regions()[event.region].name);
  return event.kernel ? "" : StableText(trace, trace.ProcessOf(location), event.record);
}

std::string EventText(const Trace& trace, const Location& location, const Event& event) {
  if (event.record != nullptr) {
    std::string text = StableText(trace, trace.ProcessOf(location), event.record);
    if (KindOf(*event.record) == RecordKind::kThreadReceive)
      text += WaitedText(trace, location, RecordAt<ThreadReceive>(event.record));
    if (text.empty()) text = TimingText(trace, trace.ProcessOf(location), event.record);
    if (KindOf(*event.record) == RecordKind::kTransmission)
      text += SpanText(trace, location, RecordAt<Transmission>(event.record));
    return text;
  }
  const Region& region = trace.regions()[event.region];
  std::string text = CanonicalText(trace, location, event);
  if (!event.leave && !region.file.empty())
    text += fmt::format("  {}:{}", region.file, region.line);
  if (event.counted != nullptr) {
    const auto r = RecordAt<CountedEnter>(event.counted);
    text += r.purpose == CountedPurpose::kSample
                ? fmt::format("  (a sample; {} visits since the last one left no event)", r.visits)
                : "  (inside a sample)";
  }
  return text;
}

}  // namespace stipple
