// SPDX-License-Identifier: MIT
#include "analysis/trace/mpi_activity.h"

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "analysis/trace/transmissions.h"

namespace stipple {
namespace {

constexpr std::uint32_t kCancelled = 2;

template <class Item>
const Item* Find(const std::vector<Item>& sorted, std::uint32_t request) {
  const auto it = std::ranges::lower_bound(sorted, request, {}, &Item::request);
  return it != sorted.end() && it->request == request ? &*it : nullptr;
}

/// Ties requests to where they were posted and where they ended.
void JoinRequests(LocationActivity& p) {
  std::ranges::stable_sort(p.posts, {}, &ReceivePost::request);
  std::ranges::stable_sort(p.ends, {}, &RequestEnd::request);
  for (ReceiveEvent& r : p.receives) {
    if (r.request == 0) continue;
    if (const ReceivePost* post = Find(p.posts, r.request)) {
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

/// Of a ring the begin is missing, on each rank another part of it: counted from the end.
void NumberFromEnd(std::vector<CollectiveEvent>& collectives) {
  std::uint32_t number = std::numeric_limits<std::uint32_t>::max();
  for (std::size_t i = collectives.size(); i-- > 0;) {
    const bool same = i + 1 < collectives.size() &&
                      collectives[i].communicator == collectives[i + 1].communicator;
    number = same ? number - 1 : std::numeric_limits<std::uint32_t>::max();
    collectives[i].number = number;
  }
}

/// Drops the first events of each channel whose other end a ring has overwritten: at the end of the
/// run all messages had been received. Both are in order.
void DropOverwrittenEnds(std::vector<SendEvent>& sends, std::vector<ReceiveEvent>& receives) {
  std::map<Channel, std::int64_t> surplus;  // of sends
  for (const SendEvent& s : sends) ++surplus[s.channel];
  for (const ReceiveEvent& r : receives) --surplus[r.channel];
  std::erase_if(sends, [&](const SendEvent& s) {
    std::int64_t& more = surplus[s.channel];
    return more > 0 && more-- > 0;
  });
  std::erase_if(receives, [&](const ReceiveEvent& r) {
    std::int64_t& more = surplus[r.channel];
    return more < 0 && more++ < 0;
  });
}

/// Moves `more` behind `all`.
template <class Item>
void Append(std::vector<Item>& all, std::vector<Item>& more) {
  if (all.empty()) {
    all = std::move(more);
  } else {
    all.insert(all.end(), more.begin(), more.end());
  }
  more = {};
}

void Shift(std::uint32_t& call, std::uint32_t base) {
  if (call != kNoIndex) call += base;
}

/// Makes calls, counted within the location, those of all; moves all that needs no more joining.
void TakeLocation(LocationActivity& from, MpiActivity& all, LocationActivity& process) {
  const auto base = static_cast<std::uint32_t>(all.calls.size());
  for (SendEvent& s : from.sends) {
    Shift(s.call, base);
    Shift(s.end_call, base);
  }
  for (ReceiveEvent& r : from.receives) Shift(r.end_call, base);
  for (RequestEnd& e : from.ends) Shift(e.call, base);
  for (ProbeEvent& p : from.probes) Shift(p.call, base);
  for (CollectiveEvent& c : from.collectives) Shift(c.end_call, base);
  Append(all.calls.Edit(), from.calls);
  Append(all.marks.Edit(), from.marks);
  Append(all.probes.Edit(), from.probes);
  Append(all.transmissions.Edit(), from.transmissions);
  Append(process.thread_messages, from.thread_messages);
  Append(process.sends, from.sends);
  Append(process.receives, from.receives);
  Append(process.posts, from.posts);
  Append(process.ends, from.ends);
  Append(process.collectives, from.collectives);
  process.undefined_communicators += from.undefined_communicators;
  process.undefined_names += from.undefined_names;
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

MpiActivity JoinActivity(const Trace& trace, std::vector<LocationActivity> locations) {
  MpiActivity a;
  std::vector<SendEvent>& sends = a.sends.Edit();
  std::vector<ReceiveEvent>& receives = a.receives.Edit();
  std::vector<CollectiveEvent>& collectives = a.collectives.Edit();
  // Requests of one thread may end in another: they are joined by process.
  std::vector<LocationActivity> processes(trace.processes().size());
  for (const Location& l : trace.locations())
    TakeLocation(locations[l.index], a, processes[l.process_index]);
  for (std::size_t i = 0; i < processes.size(); ++i) {
    LocationActivity& p = processes[i];
    JoinRequests(p);
    NumberCollectives(p.collectives);
    if (trace.kept()) NumberFromEnd(p.collectives);
    MatchThreadMessages(std::move(p.thread_messages), a.thread_messages);
    Append(sends, p.sends);
    Append(receives, p.receives);
    Append(collectives, p.collectives);
    const std::string& where = trace.processes()[i].where;
    a.health.Add(Defect::kUndefinedName, where, p.undefined_names);
    a.health.Add(Defect::kUndefinedCommunicator, where, p.undefined_communicators);
    p = {};
  }
  std::ranges::stable_sort(
      sends, {}, [](const SendEvent& s) { return std::tuple(s.channel, s.enter_ns, s.order); });
  std::ranges::stable_sort(receives, {}, [](const ReceiveEvent& r) {
    return std::tuple(r.channel, r.post_ns, r.order);
  });
  std::ranges::stable_sort(collectives, {}, [](const CollectiveEvent& c) {
    return std::tuple(c.communicator, c.number, c.rank);
  });
  if (trace.kept()) DropOverwrittenEnds(sends, receives);
  MatchMessages(sends, receives);
  JoinTransmissions(a.transmissions.Edit(), sends, a.calls);
  CountMessages(a);
  if (!trace.kept()) CountCollectives(trace, a);
  return a;
}

}  // namespace stipple
