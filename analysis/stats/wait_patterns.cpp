// SPDX-License-Identifier: MIT
#include "analysis/stats/wait_patterns.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace stipple {
namespace {

constexpr double kMostOthers = 2.0 / 3;
// So many later receives are looked at for messages that could have been taken first.
constexpr std::size_t kLookAhead = 64;

/// The last two events of a rank that have different partners.
class LastOfOthers {
 public:
  void Add(std::int32_t partner, std::int64_t time_ns) {
    if (partner != last_[0].partner) last_[1] = last_[0];
    last_[0] = {partner, time_ns};
  }
  /// When there was one with another partner than this; long ago if never.
  std::int64_t Not(std::int32_t partner) const {
    return (last_[0].partner == partner ? last_[1] : last_[0]).time_ns;
  }

 private:
  struct Last {
    std::int32_t partner = -1;
    std::int64_t time_ns = std::numeric_limits<std::int64_t>::min();
  };
  std::array<Last, 2> last_;
};

/// A reply and its request, both by their receives.
struct Service {
  std::uint32_t reply = kNoIndex;
  std::uint32_t request = kNoIndex;
  bool at_once = false;  // nothing was received from others in between
  bool queued = false;   // others were dealt with while the request lay there
};

class PatternFinder {
 public:
  PatternFinder(const Trace& trace, const MpiActivity& mpi, const WaitGraph& graph)
      : trace_(trace), mpi_(mpi), graph_(graph) {
    const std::size_t count = graph.All().size();
    found_.for_master.resize(count);
    found_.held_by.resize(count, kNoIndex);
    found_.order_ns.resize(count);
    message_.resize(count, kNoIndex);
  }

  WaitPatterns Find() {
    const auto for_message = [](const WaitSpan& w) {
      return w.kind == WaitKind::kLateSender || w.kind == WaitKind::kLateReceiver;
    };
    if (std::ranges::none_of(graph_.All(), for_message)) return std::move(found_);
    FindMessages();
    for (const int rank : Partners()) Serve(rank);
    FindOrder();
    return std::move(found_);
  }

 private:
  const SendEvent& SendOf(std::uint32_t receive) const {
    return mpi_.sends[mpi_.receives[receive].send];
  }

  /// The message that ended each wait.
  void FindMessages() {
    using Arrival = std::tuple<std::int32_t, std::int32_t, std::int64_t, std::size_t>;
    std::vector<Arrival> late_senders;  // waiter, partner, end of the wait
    std::vector<std::pair<std::uint32_t, std::size_t>> late_receivers;  // call
    for (int rank = 0; rank < graph_.RankEnd(); ++rank)
      for (const WaitSpan& w : graph_.OfRank(rank)) {
        if (w.kind == WaitKind::kLateSender)
          late_senders.emplace_back(rank, w.partner, w.end_ns, graph_.IdOf(w));
        if (w.kind == WaitKind::kLateReceiver) late_receivers.emplace_back(w.call, graph_.IdOf(w));
      }
    std::ranges::sort(late_senders);
    std::ranges::sort(late_receivers);
    for (std::size_t r = 0; r < mpi_.receives.size(); ++r) {
      if (mpi_.receives[r].send == kNoIndex) continue;
      const auto index = static_cast<std::uint32_t>(r);
      const SendEvent& s = SendOf(index);
      const auto waited = std::ranges::lower_bound(
          late_senders, Arrival{s.channel.receiver, s.channel.sender, s.enter_ns, 0});
      if (waited != late_senders.end() && std::get<0>(*waited) == s.channel.receiver &&
          std::get<1>(*waited) == s.channel.sender && std::get<2>(*waited) == s.enter_ns)
        message_[std::get<3>(*waited)] = index;
      const auto sent =
          std::ranges::lower_bound(late_receivers, std::pair(s.end_call, std::size_t{0}));
      if (sent == late_receivers.end() || sent->first != s.end_call) continue;
      const WaitSpan& w = graph_.All()[sent->second];
      if (w.partner == s.channel.receiver && w.end_ns == mpi_.receives[r].post_ns)
        message_[sent->second] = found_.held_by[sent->second] = index;
    }
    for (std::size_t i = 0; i < graph_.All().size(); ++i)
      if (message_[i] != kNoIndex) wait_of_.emplace_back(message_[i], i);
    std::ranges::sort(wait_of_);
  }

  /// Those that are waited for in messages.
  std::vector<int> Partners() {
    for (std::size_t i = 0; i < message_.size(); ++i)
      if (message_[i] != kNoIndex) waits_for_[graph_.All()[i].partner].push_back(i);
    std::vector<int> partners;
    for (const auto& [rank, waits] : waits_for_) partners.push_back(rank);
    if (!partners.empty()) SortByRank();
    return partners;
  }

  /// Messages by what their ranks did with them.
  struct End {
    std::int32_t rank;
    std::int64_t time_ns;
    std::int32_t partner;
    std::uint32_t receive;
    bool sends;
  };
  void SortByRank() {
    for (std::size_t r = 0; r < mpi_.receives.size(); ++r) {
      const ReceiveEvent& receive = mpi_.receives[r];
      if (receive.send == kNoIndex) continue;
      const auto index = static_cast<std::uint32_t>(r);
      const Channel& c = receive.channel;
      if (waits_for_.contains(c.receiver))
        ends_.push_back({c.receiver, receive.complete_ns, c.sender, index, false});
      if (waits_for_.contains(c.sender))
        ends_.push_back({c.sender, SendOf(index).enter_ns, c.receiver, index, true});
    }
    std::ranges::sort(
        ends_, {}, [](const End& e) { return std::tuple(e.rank, e.time_ns, e.sends, e.receive); });
  }

  std::vector<Service> ServicesOf(int rank) const {
    std::vector<Service> services;
    std::map<std::int32_t, std::uint32_t> open;  // requests by partner
    LastOfOthers dealt;
    LastOfOthers received;
    const auto begin = std::ranges::lower_bound(ends_, rank, {}, &End::rank);
    for (auto e = begin; e != ends_.end() && e->rank == rank; ++e) {
      if (!e->sends) {
        open[e->partner] = e->receive;
        received.Add(e->partner, e->time_ns);
      } else if (const auto request = open.find(e->partner); request != open.end()) {
        const std::uint32_t r = request->second;
        services.push_back({e->receive, r, received.Not(e->partner) <= mpi_.receives[r].complete_ns,
                            dealt.Not(e->partner) > SendOf(r).enter_ns});
        open.erase(request);
      }
      dealt.Add(e->partner, e->time_ns);
    }
    return services;
  }

  /// What the waits for `rank` have to do with its services.
  void Serve(int rank) {
    const std::vector<Service> services = ServicesOf(rank);
    std::map<std::int32_t, std::size_t> served;
    std::size_t at_once = 0;
    std::int64_t queued_ns = 0;
    std::int64_t alone_ns = 0;
    std::vector<std::size_t> waits;
    for (const Service& s : services) {
      ++served[mpi_.receives[s.reply].channel.receiver];
      at_once += s.at_once ? 1 : 0;
      for (auto ended = std::ranges::lower_bound(wait_of_, std::pair(s.reply, std::size_t{0}));
           ended != wait_of_.end() && ended->first == s.reply; ++ended) {
        const std::size_t i = ended->second;
        const WaitSpan& w = graph_.All()[i];
        if (w.kind != WaitKind::kLateSender) continue;
        waits.push_back(i);
        (s.queued ? queued_ns : alone_ns) += w.end_ns - w.begin_ns;
        if (s.at_once) found_.held_by[i] = s.request;
      }
    }
    const bool most = static_cast<double>(served.size()) > kMostOthers * (trace_.RankCount() - 1) ||
                      trace_.IsHost(rank);
    if (!most || served.size() < 2 || 2 * at_once < services.size() || queued_ns < alone_ns) return;
    for (const std::size_t i : waits) found_.for_master[i] = true;
    for (const std::size_t i : waits_for_.at(rank))
      if (graph_.All()[i].kind == WaitKind::kLateReceiver) found_.for_master[i] = true;
  }

  /// A location's receives in the order in which they were completed.
  struct Taken {
    std::uint32_t call;
    std::uint32_t receive;
    std::int64_t work_ns = 0;      // outside MPI until the next one
    bool collective_next = false;  // before the next one
  };

  /// Work that could have been done while waiting: that on messages which were there and taken
  /// later, for each at most as much as was done on the one that was waited for. So a rank that
  /// takes all its messages first and works then has lost nothing by their order.
  void FindOrder() {
    const std::vector<Taken> taken = TakenInOrder();
    std::vector<std::int64_t> left_ns;
    for (const Taken& t : taken) left_ns.push_back(t.work_ns);
    for (const WaitSpan& w : graph_.All()) {
      if (w.kind != WaitKind::kLateSender) continue;
      auto k = static_cast<std::size_t>(std::ranges::upper_bound(taken, w.call, {}, &Taken::call) -
                                        taken.begin());
      // A probe comes before its receive.
      const bool probe = k == 0 || taken[k - 1].call != w.call;
      if (probe && (k == taken.size() || taken[k].receive != message_[graph_.IdOf(w)])) continue;
      k += probe ? 1 : 0;
      const std::int64_t work_ns = taken[k - 1].work_ns;
      const std::uint32_t location = mpi_.calls[w.call].location;
      std::int64_t room_ns = 0;
      std::int64_t& order_ns = found_.order_ns[graph_.IdOf(w)];
      const std::size_t last = std::min(taken.size(), k + kLookAhead);
      for (; k < last && work_ns > 0 && !taken[k - 1].collective_next; ++k) {
        if (mpi_.calls[taken[k].call].location != location) break;
        const std::int64_t there_ns = SendOf(taken[k].receive).enter_ns;
        if (there_ns >= w.end_ns) continue;
        room_ns = std::max(room_ns, w.end_ns - std::max(w.begin_ns, there_ns));
        const std::int64_t used_ns = std::min({left_ns[k], work_ns, room_ns - order_ns});
        left_ns[k] -= used_ns;
        order_ns += used_ns;
      }
    }
  }

  std::vector<Taken> TakenInOrder() const {
    std::vector<Taken> taken;
    for (std::size_t r = 0; r < mpi_.receives.size(); ++r)
      if (mpi_.receives[r].send != kNoIndex && mpi_.receives[r].end_call != kNoIndex)
        taken.push_back({mpi_.receives[r].end_call, static_cast<std::uint32_t>(r)});
    std::ranges::sort(taken, {}, [](const Taken& t) { return std::pair(t.call, t.receive); });
    std::vector<bool> collective(mpi_.calls.size());
    for (const CollectiveEvent& c : mpi_.collectives)
      if (c.end_call != kNoIndex) collective[c.end_call] = true;
    for (std::size_t k = 0; k < taken.size(); ++k) {
      const std::uint32_t location = mpi_.calls[taken[k].call].location;
      const std::size_t next = k + 1 < taken.size() ? taken[k + 1].call : mpi_.calls.size();
      std::int64_t free_ns = mpi_.calls[taken[k].call].end_ns;
      for (std::size_t c = std::size_t{taken[k].call} + 1;
           c < mpi_.calls.size() && mpi_.calls[c].location == location && c <= next; ++c) {
        taken[k].work_ns += std::max<std::int64_t>(0, mpi_.calls[c].begin_ns - free_ns);
        taken[k].collective_next = taken[k].collective_next || collective[c];
        free_ns = mpi_.calls[c].end_ns;
      }
    }
    return taken;
  }

  const Trace& trace_;
  const MpiActivity& mpi_;
  const WaitGraph& graph_;
  WaitPatterns found_;
  std::vector<std::uint32_t> message_;  // by wait: the receive of what ended it
  std::vector<std::pair<std::uint32_t, std::size_t>> wait_of_;  // the other way round
  std::map<std::int32_t, std::vector<std::size_t>> waits_for_;  // by partner
  std::vector<End> ends_;
};

}  // namespace

WaitPatterns PatternsOf(const Trace& trace, const MpiActivity& mpi, const WaitGraph& graph) {
  return PatternFinder(trace, mpi, graph).Find();
}

}  // namespace stipple
