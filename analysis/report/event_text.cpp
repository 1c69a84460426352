// SPDX-License-Identifier: MIT
#include "analysis/report/event_text.h"

#include <fmt/format.h>

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

std::string ModeText(const Trace& trace, const Process& p, const RegionMode& r) {
  const char* how = r.mode == RegionModeKind::kTimed     ? "with all times"
                    : r.mode == RegionModeKind::kNoClock ? "without times"
                                                         : "by counting visits";
  return fmt::format("budget: {} is recorded {}, {} visits seen",
                     RegionOfProcess(trace, p, r.region).name, how, r.visits);
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
    case RecordKind::kThreadEnd:
      return "thread end";
    default:
      return {};
  }
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
    case RecordKind::kTimeStamp:
      return "time stamp";
    case RecordKind::kJumpPoint:
      return "jump point";
    case RecordKind::kUnwound:
      return "unwound";
    case RecordKind::kStackSwitch:
      return "stack switch";
    case RecordKind::kRegionMode:
      return ModeText(trace, p, RecordAt<RegionMode>(record));
    default:
      return fmt::format("record of kind {}", static_cast<unsigned>(KindOf(*record)));
  }
}

}  // namespace

std::string CanonicalText(const Trace& trace, const Location& location, const Event& event) {
  if (event.record == nullptr)
    return std::string(event.leave ? "leave " : "enter ")
        .append(trace.regions()[event.region].name);
  return StableText(trace, trace.ProcessOf(location), event.record);
}

std::string EventText(const Trace& trace, const Location& location, const Event& event) {
  if (event.record != nullptr) {
    std::string text = StableText(trace, trace.ProcessOf(location), event.record);
    return text.empty() ? TimingText(trace, trace.ProcessOf(location), event.record) : text;
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
