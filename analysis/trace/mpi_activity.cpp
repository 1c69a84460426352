// SPDX-License-Identifier: MIT
#include "analysis/trace/mpi_activity.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace stipple {
namespace {

struct Post {
  std::uint32_t request;
  std::uint32_t order;
  std::int64_t time_ns;
};

struct RequestEnd {
  std::uint32_t request;
  std::uint32_t outcome;
  std::uint32_t call;
};

constexpr std::uint32_t kCancelled = 2;

/// What one process did; requests of one thread may end in another.
struct ProcessActivity {
  std::vector<SendEvent> sends;
  std::vector<ReceiveEvent> receives;
  std::vector<Post> posts;
  std::vector<RequestEnd> ends;
  std::vector<CollectiveEvent> collectives;
  std::uint64_t undefined_communicators = 0;
};

/// Sees the events of one location.
class Collector {
 public:
  Collector(const Trace& trace, const Location& location, MpiActivity& all, ProcessActivity& out)
      : trace_(trace),
        location_(location),
        process_(trace.ProcessOf(location)),
        calls_(all.calls),
        all_(all),
        out_(out) {
    for (const std::uint32_t region : process_.regions)
      is_mpi_.push_back(trace.regions()[region].kind == RegionKind::kMpi);
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    if (is_mpi_[region] == 0) return;
    Mpi(region, leave, ticks);
  }

  void Record(const EventWord* record, std::uint64_t ticks) {
    if (KindOf(*record) == RecordKind::kMark) return Marked(RecordAt<Mark>(record), ticks);
    if (!process_.in_world) return;
    switch (KindOf(*record)) {
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
      default:
        return;
    }
  }

  /// A call that is open at the end of the location ends there.
  void Finish() {
    if (depth_ > 0) calls_[call_].end_ns = location_.end_ns;
  }

 private:
  void Mpi(std::uint32_t region, bool leave, std::uint64_t ticks) {
    if (!leave) {
      if (depth_++ != 0) return;
      call_ = static_cast<std::uint32_t>(calls_.size());
      call_order_ = order_++;
      const std::int64_t now = trace_.TimeNs(location_, ticks);
      calls_.push_back(
          {now, now, process_.regions[region], static_cast<std::uint32_t>(location_.index)});
    } else if (depth_ > 0 && --depth_ == 0) {
      calls_[call_].end_ns = trace_.TimeNs(location_, ticks);
      call_ = kNoIndex;
    }
  }

  /// The communicator of the archive, or 0, counted.
  std::uint32_t Defined(std::uint32_t communicator) {
    const std::uint32_t c = process_.CommunicatorOf(communicator);
    if (c == 0) ++out_.undefined_communicators;
    return c;
  }
  const Communicator& At(std::uint32_t c) const { return trace_.communicators()[c]; }
  std::int64_t CallBegin(std::uint64_t ticks) const {
    return call_ == kNoIndex ? trace_.TimeNs(location_, ticks) : calls_[call_].begin_ns;
  }

  void Marked(const Mark& r, std::uint64_t ticks) {
    all_.marks.push_back({trace_.TimeNs(location_, ticks), process_.NameOf(r.name),
                          static_cast<std::uint32_t>(location_.index)});
  }

  void Send(const MpiSend& r, std::uint64_t ticks) {
    const std::uint32_t c = Defined(r.communicator);
    if (c == 0) return;
    const Channel channel{c, location_.rank, At(c).WorldRank(r.receiver), r.tag};
    out_.sends.push_back({channel, r.bytes, CallBegin(ticks), order_++, r.request, call_,
                          r.request == 0 ? call_ : kNoIndex, kNoIndex});
  }

  void Receive(const MpiReceive& r, std::uint64_t ticks) {
    const std::uint32_t c = Defined(r.communicator);
    if (c == 0) return;
    const Channel channel{c, At(c).WorldRank(r.sender), location_.rank, r.tag};
    out_.receives.push_back({channel, r.bytes, CallBegin(ticks), trace_.TimeNs(location_, ticks),
                             call_ == kNoIndex ? order_ : call_order_, r.request, call_, kNoIndex});
    ++order_;
  }

  void Collective(const MpiCollective& r, std::uint64_t ticks) {
    const std::uint32_t c = Defined(r.communicator);
    if (c == 0) return;
    const std::uint32_t region =
        r.region < process_.regions.size() ? process_.regions[r.region] : 0;
    out_.collectives.push_back({c, 0, location_.rank, At(c).WorldRank(r.root), region,
                                CallBegin(ticks), order_++, r.request,
                                r.request == 0 ? call_ : kNoIndex});
  }

  void Probe(const MpiProbe& r, std::uint64_t ticks) {
    const std::uint32_t c = Defined(r.communicator);
    if (c == 0) return;
    all_.probes.push_back({{c, At(c).WorldRank(r.sender), location_.rank, r.tag},
                           trace_.TimeNs(location_, ticks),
                           call_});
  }

  const Trace& trace_;
  const Location& location_;
  const Process& process_;
  std::vector<MpiCall>& calls_;
  MpiActivity& all_;
  ProcessActivity& out_;
  std::vector<std::uint8_t> is_mpi_;
  std::uint32_t depth_ = 0;
  std::uint32_t call_ = kNoIndex;  // open
  std::uint32_t call_order_ = 0;
  std::uint32_t order_ = 0;
};

template <class Item>
const Item* Find(const std::vector<Item>& sorted, std::uint32_t request) {
  const auto it = std::ranges::lower_bound(sorted, request, {}, &Item::request);
  return it != sorted.end() && it->request == request ? &*it : nullptr;
}

/// Ties requests to where they were posted and where they ended.
void JoinRequests(ProcessActivity& p) {
  std::ranges::stable_sort(p.posts, {}, &Post::request);
  std::ranges::stable_sort(p.ends, {}, &RequestEnd::request);
  for (ReceiveEvent& r : p.receives) {
    if (r.request == 0) continue;
    if (const Post* post = Find(p.posts, r.request)) {
      r.post_ns = post->time_ns;
      r.order = post->order;
    }
  }
  const auto cancelled = [&p](const SendEvent& s) {
    const RequestEnd* end = s.request == 0 ? nullptr : Find(p.ends, s.request);
    return end != nullptr && end->outcome == kCancelled;
  };
  std::erase_if(p.sends, cancelled);
  for (SendEvent& s : p.sends)
    if (const RequestEnd* end = s.request == 0 ? nullptr : Find(p.ends, s.request))
      s.end_call = end->call;
  for (CollectiveEvent& c : p.collectives)
    if (const RequestEnd* end = c.request == 0 ? nullptr : Find(p.ends, c.request))
      c.end_call = end->call;
}

/// Numbers a process's collectives on each communicator.
void NumberCollectives(std::vector<CollectiveEvent>& collectives) {
  std::ranges::stable_sort(collectives, {}, [](const CollectiveEvent& c) {
    return std::tuple(c.communicator, c.enter_ns, c.order);
  });
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < collectives.size(); ++i) {
    const bool same = i > 0 && collectives[i].communicator == collectives[i - 1].communicator;
    number = same ? number + 1 : 0;
    collectives[i].number = number;
  }
}

template <class Item>
void Append(std::vector<Item>& all, std::vector<Item>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void CountCollectives(const Trace& trace, MpiActivity& a) {
  std::uint64_t incomplete = 0;
  for (std::size_t i = 0; i < a.collectives.size();) {
    const CollectiveEvent& first = a.collectives[i];
    std::size_t ranks = 0;
    for (; i < a.collectives.size() && a.collectives[i].communicator == first.communicator &&
           a.collectives[i].number == first.number;
         ++i)
      ++ranks;
    if (ranks < trace.communicators()[first.communicator].world_ranks.size()) ++incomplete;
  }
  a.health.Add(Defect::kIncompleteCollective, "", incomplete);
}

void CountMessages(MpiActivity& a) {
  for (const SendEvent& s : a.sends) {
    a.bytes += s.bytes;
    if (s.receive == kNoIndex) {
      a.health.Add(Defect::kUnmatchedSend, "rank " + std::to_string(s.channel.sender));
      continue;
    }
    ++a.matched;
    if (a.receives[s.receive].complete_ns < s.enter_ns) ++a.reversed;
  }
  for (const ReceiveEvent& r : a.receives)
    if (r.send == kNoIndex)
      a.health.Add(Defect::kUnmatchedReceive, "rank " + std::to_string(r.channel.receiver));
}

}  // namespace

void MatchMessages(std::vector<SendEvent>& sends, std::vector<ReceiveEvent>& receives) {
  std::size_t r = 0;
  for (std::size_t s = 0; s < sends.size(); ++s) {
    while (r < receives.size() && receives[r].channel < sends[s].channel) ++r;
    if (r == receives.size()) break;
    if (receives[r].channel != sends[s].channel) continue;
    sends[s].receive = static_cast<std::uint32_t>(r);
    receives[r].send = static_cast<std::uint32_t>(s);
    ++r;
  }
}

MpiActivity ReadMpiActivity(const Trace& trace) {
  MpiActivity a;
  std::vector<ProcessActivity> processes(trace.processes().size());
  for (const Location& l : trace.locations()) {
    Collector collector(trace, l, a, processes[l.process_index]);
    trace.Scan(l, collector);
    collector.Finish();
  }
  for (std::size_t i = 0; i < processes.size(); ++i) {
    ProcessActivity& p = processes[i];
    JoinRequests(p);
    NumberCollectives(p.collectives);
    Append(a.sends, p.sends);
    Append(a.receives, p.receives);
    Append(a.collectives, p.collectives);
    a.health.Add(Defect::kUndefinedCommunicator, trace.processes()[i].stream->file_name,
                 p.undefined_communicators);
    p = {};
  }
  std::ranges::stable_sort(
      a.sends, {}, [](const SendEvent& s) { return std::tuple(s.channel, s.enter_ns, s.order); });
  std::ranges::stable_sort(a.receives, {}, [](const ReceiveEvent& r) {
    return std::tuple(r.channel, r.post_ns, r.order);
  });
  std::ranges::stable_sort(a.collectives, {}, [](const CollectiveEvent& c) {
    return std::tuple(c.communicator, c.number, c.rank);
  });
  MatchMessages(a.sends, a.receives);
  CountMessages(a);
  CountCollectives(trace, a);
  return a;
}

}  // namespace stipple
