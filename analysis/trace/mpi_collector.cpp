// SPDX-License-Identifier: MIT
#include "analysis/trace/mpi_collector.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "analysis/trace/kernel.h"

namespace stipple {

MpiCollector::MpiCollector(const Trace& trace, const Location& location)
    : trace_(trace), location_(location), process_(trace.ProcessOf(location)) {
  for (const std::uint32_t region : process_.regions)
    is_mpi_.push_back(trace.regions()[region].kind == RegionKind::kMpi);
}

void MpiCollector::Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
  if (!leave) {
    if (depth_++ != 0) return;
    call_ = static_cast<std::uint32_t>(out_.calls.size());
    call_order_ = order_++;
    const std::int64_t now = trace_.TimeNs(location_, ticks);
    out_.calls.push_back(
        {now, now, process_.regions[region], static_cast<std::uint32_t>(location_.index)});
  } else if (depth_ > 0 && --depth_ == 0) {
    out_.calls[call_].end_ns = trace_.TimeNs(location_, ticks);
    call_ = kNoIndex;
  }
}

void MpiCollector::Record(const EventWord* record, std::uint64_t ticks) {
  const RecordKind kind = KindOf(*record);
  if (kind == RecordKind::kMark) return Marked(RecordAt<Mark>(record), ticks);
  if (kind == RecordKind::kThreadSend) return Handed(RecordAt<ThreadSend>(record), ticks);
  if (kind == RecordKind::kThreadReceive) return Taken(RecordAt<ThreadReceive>(record), ticks);
  if (kind == RecordKind::kCounter) {
    out_.undefined_names += process_.NameOf(RecordAt<Counter>(record).name) == 0;
    return;
  }
  if (KindOf(*record) == RecordKind::kSystemCall)
    return Called(RecordAt<SystemCall>(record), ticks);
  if (!process_.in_world) return;
  switch (kind) {
    case RecordKind::kMpiSend:
      return Send(RecordAt<MpiSend>(record), ticks);
    case RecordKind::kMpiReceivePost: {
      const auto r = RecordAt<MpiReceivePost>(record);
      out_.posts.push_back({r.request, order_++, trace_.TimeNs(location_, ticks)});
      return;
    }
    case RecordKind::kMpiReceive:
      return Receive(RecordAt<MpiReceive>(record), ticks);
    case RecordKind::kMpiRequestEnd: {
      const auto r = RecordAt<MpiRequestEnd>(record);
      out_.ends.push_back({r.request, r.outcome, call_});
      return;
    }
    case RecordKind::kMpiCollective:
      return Collective(RecordAt<MpiCollective>(record), ticks);
    case RecordKind::kMpiProbe:
      return Probe(RecordAt<MpiProbe>(record), ticks);
    case RecordKind::kTransmission:
      return Transmitted(RecordAt<Transmission>(record));
    default:
      return;
  }
}

LocationActivity MpiCollector::Finish() {
  if (depth_ > 0) out_.calls[call_].end_ns = location_.end_ns;
  return std::move(out_);
}

/// The communicator of the archive, or 0, counted.
std::uint32_t MpiCollector::Defined(std::uint32_t communicator) {
  const std::uint32_t c = process_.CommunicatorOf(communicator);
  if (c == 0) ++out_.undefined_communicators;
  return c;
}

std::int64_t MpiCollector::CallBegin(std::uint64_t ticks) const {
  return call_ == kNoIndex ? trace_.TimeNs(location_, ticks) : out_.calls[call_].begin_ns;
}

void MpiCollector::Called(const SystemCall& r, std::uint64_t ticks) {
  if ((depth_ > 0 && !SystemIsInMpi(trace_)) || !location_.IsMain()) return;
  const std::uint64_t enter = std::min(std::max(r.enter_ticks, location_.first_ticks), ticks);
  out_.system_calls.push_back({trace_.TimeNs(location_, enter), trace_.TimeNs(location_, ticks)});
}

void MpiCollector::Marked(const Mark& r, std::uint64_t ticks) {
  out_.undefined_names += process_.NameOf(r.name) == 0;
  out_.marks.push_back({trace_.TimeNs(location_, ticks), process_.NameOf(r.name),
                        static_cast<std::uint32_t>(location_.index)});
}

void MpiCollector::Handed(const ThreadSend& r, std::uint64_t ticks) {
  const std::uint32_t channel = process_.ChannelOf(r.channel);
  out_.undefined_names += channel == 0;
  out_.thread_messages.push_back({channel,
                                  r.key,
                                  false,
                                  trace_.TimeNs(location_, ticks),
                                  r.bytes,
                                  static_cast<std::uint32_t>(location_.index),
                                  {}});
}

void MpiCollector::Taken(const ThreadReceive& r, std::uint64_t ticks) {
  const std::uint32_t channel = process_.ChannelOf(r.channel);
  out_.undefined_names += channel == 0;
  std::optional<std::int64_t> since_ns;
  if (r.waiting_since != 0) since_ns = trace_.TimeNs(location_, std::min(r.waiting_since, ticks));
  out_.thread_messages.push_back({channel, r.key, true, trace_.TimeNs(location_, ticks), r.bytes,
                                  static_cast<std::uint32_t>(location_.index), since_ns});
}

void MpiCollector::Send(const MpiSend& r, std::uint64_t ticks) {
  const std::uint32_t c = Defined(r.communicator);
  if (c == 0) return;
  const Channel channel{c, location_.rank, At(c).WorldRank(r.receiver), r.tag};
  out_.sends.push_back({channel, r.bytes, CallBegin(ticks), order_++, r.request, call_,
                        r.request == 0 ? call_ : kNoIndex, kNoIndex});
}

void MpiCollector::Receive(const MpiReceive& r, std::uint64_t ticks) {
  const std::uint32_t c = Defined(r.communicator);
  if (c == 0) return;
  const Channel channel{c, At(c).WorldRank(r.sender), location_.rank, r.tag};
  out_.receives.push_back({channel, r.bytes, CallBegin(ticks), trace_.TimeNs(location_, ticks),
                           call_ == kNoIndex ? order_ : call_order_, r.request, call_, kNoIndex});
  ++order_;
}

void MpiCollector::Collective(const MpiCollective& r, std::uint64_t ticks) {
  const std::uint32_t c = Defined(r.communicator);
  if (c == 0) return;
  const std::uint32_t region = r.region < process_.regions.size() ? process_.regions[r.region] : 0;
  out_.collectives.push_back({c, 0, location_.rank, At(c).WorldRank(r.root), region,
                              CallBegin(ticks), order_++, r.request,
                              r.request == 0 ? call_ : kNoIndex});
}

void MpiCollector::Probe(const MpiProbe& r, std::uint64_t ticks) {
  const std::uint32_t c = Defined(r.communicator);
  if (c == 0) return;
  out_.probes.push_back({{c, At(c).WorldRank(r.sender), location_.rank, r.tag},
                         trace_.TimeNs(location_, ticks),
                         call_});
}

void MpiCollector::Transmitted(const Transmission& r) {
  out_.transmissions.push_back({trace_.TimeNs(location_, r.begin_ticks),
                                trace_.TimeNs(location_, r.end_ticks), r.bytes, location_.rank,
                                r.receiver});
}

}  // namespace stipple
