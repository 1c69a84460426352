// SPDX-License-Identifier: MIT
#include "analysis/stats/window_source.h"

#include <algorithm>
#include <map>
#include <utility>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/region_search.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/timeline_of.h"

namespace stipple {
namespace {

/// Matched messages by time of sending. What lies in a span is found without looking at the others:
/// `latest[i]` is the latest receive of the first i + 1 messages, and never falls.
class MessageIndex {
 public:
  explicit MessageIndex(const MpiActivity& mpi) : mpi_(mpi) {
    for (std::size_t i = 0; i < mpi.sends.size(); ++i)
      if (mpi.sends[i].receive != kNoIndex) by_send_.push_back(static_cast<std::uint32_t>(i));
    std::ranges::stable_sort(by_send_, {}, [&](std::uint32_t i) { return mpi.sends[i].enter_ns; });
    for (const std::uint32_t i : by_send_) {
      const std::int64_t received = ReceivedNs(i);
      receives_.push_back(received);
      latest_.push_back(latest_.empty() ? received : std::max(latest_.back(), received));
    }
    std::ranges::sort(receives_);
  }

  std::size_t SentUntil(std::int64_t time_ns) const {
    return static_cast<std::size_t>(
        std::ranges::upper_bound(by_send_, time_ns, {},
                                 [&](std::uint32_t i) { return mpi_.sends[i].enter_ns; }) -
        by_send_.begin());
  }
  std::uint64_t CountIn(std::int64_t begin_ns, std::int64_t end_ns) const {
    const std::size_t received_before =
        static_cast<std::size_t>(std::ranges::lower_bound(receives_, begin_ns) - receives_.begin());
    const std::size_t sent = SentUntil(end_ns);
    return sent > received_before ? sent - received_before : 0;
  }
  template <class Body>
  void ForEachIn(std::int64_t begin_ns, std::int64_t end_ns, Body body) const {
    auto at =
        static_cast<std::size_t>(std::ranges::lower_bound(latest_, begin_ns) - latest_.begin());
    for (const std::size_t end = SentUntil(end_ns); at < end; ++at)
      if (ReceivedNs(by_send_[at]) >= begin_ns) body(at);
  }
  const SendEvent& SendOf(std::size_t number) const { return mpi_.sends[by_send_[number]]; }
  /// The message that is this send; none: it has no match.
  std::optional<std::size_t> NumberOf(std::uint32_t send) const {
    for (auto at =
             std::ranges::lower_bound(by_send_, mpi_.sends[send].enter_ns, {},
                                      [&](std::uint32_t i) { return mpi_.sends[i].enter_ns; });
         at != by_send_.end() && mpi_.sends[*at].enter_ns == mpi_.sends[send].enter_ns; ++at)
      if (*at == send) return static_cast<std::size_t>(at - by_send_.begin());
    return std::nullopt;
  }

 private:
  std::int64_t ReceivedNs(std::uint32_t send) const {
    return mpi_.receives[mpi_.sends[send].receive].complete_ns;
  }

  const MpiActivity& mpi_;
  std::vector<std::uint32_t> by_send_;  // index of the send, by message number
  std::vector<std::int64_t> latest_;
  std::vector<std::int64_t> receives_;  // sorted
};

class AnalysisSource : public WindowSource {
 public:
  explicit AnalysisSource(const Analysis& analysis)
      : analysis_(analysis),
        title_(analysis.trace.Program()),
        ranks_(analysis.trace.RanksInOrder()),
        messages_(analysis.mpi) {
    const std::vector<Problem> problems = analysis.health.problems();
    if (!problems.empty())
      warning_ = problems.size() == 1 ? "1 problem in the archive: see stipple check"
                                      : std::to_string(problems.size()) +
                                            " problems in the archive: see stipple check";
    for (const Location& l : analysis.trace.locations())
      events_ += analysis.trace.CountsOf(l).Events();
  }

  const std::string& Title() const override { return title_; }
  const std::string& Warning() const override { return warning_; }
  double EndSeconds() const override {
    return static_cast<double>(analysis_.trace.SpanNs()) * 1e-9;
  }
  const std::string& RegionName(std::uint32_t region) const override {
    const std::vector<Region>& regions = analysis_.trace.regions();
    return regions[region < regions.size() ? region : 0].name;
  }
  const std::vector<int>& Ranks() const override { return ranks_; }
  std::uint64_t EventCount() const override { return events_; }

  Timeline StatesIn(double begin_s, double end_s, std::size_t columns) const override {
    return TimelineOf(analysis_, begin_s, end_s, columns);
  }
  std::uint64_t MessageCount(std::int64_t begin_ns, std::int64_t end_ns) const override {
    return messages_.CountIn(begin_ns, end_ns);
  }
  std::vector<RunMessage> MessagesIn(std::int64_t begin_ns, std::int64_t end_ns,
                                     std::size_t most) const override;
  VisitsOfSpan VisitsOf(int rank, std::int64_t begin_ns, std::int64_t end_ns,
                        std::size_t most) const override;
  std::optional<RunCall> CallAt(int rank, std::int64_t time_ns) const override;
  std::optional<FoundVisit> NextVisit(std::string_view text, const std::vector<int>& ranks,
                                      std::int64_t time_ns, int from_rank,
                                      Direction direction) const override;
  Table MatrixUntil(std::int64_t time_ns) const override;
  Finding FindFinding() const override {
    return FindingOf(analysis_, {}, BlameOf(analysis_, {}));
  }
  Table TableNamed(std::string_view name, bool per_rank) const override;

 private:
  RunMessage MessageOf(std::size_t number) const;
  std::string CallName(std::uint32_t call) const {
    return call == kNoIndex ? std::string() : RegionName(analysis_.mpi.calls[call].region);
  }

  const Analysis& analysis_;
  std::string title_;
  std::string warning_;
  std::vector<int> ranks_;
  std::uint64_t events_ = 0;
  MessageIndex messages_;
};

RunMessage AnalysisSource::MessageOf(std::size_t number) const {
  const SendEvent& s = messages_.SendOf(number);
  const ReceiveEvent& r = analysis_.mpi.receives[s.receive];
  return {.number = number,
          .sender = s.channel.sender,
          .receiver = s.channel.receiver,
          .tag = s.channel.tag,
          .bytes = s.bytes,
          .send_ns = s.enter_ns,
          .post_ns = r.post_ns,
          .receive_ns = r.complete_ns,
          .send_call = CallName(s.call),
          .receive_call = CallName(r.end_call)};
}

std::vector<RunMessage> AnalysisSource::MessagesIn(std::int64_t begin_ns, std::int64_t end_ns,
                                                   std::size_t most) const {
  std::vector<RunMessage> found;
  if (messages_.CountIn(begin_ns, end_ns) > most) return found;
  messages_.ForEachIn(begin_ns, end_ns,
                      [&](std::size_t number) { found.push_back(MessageOf(number)); });
  return found;
}

VisitsOfSpan AnalysisSource::VisitsOf(int rank, std::int64_t begin_ns, std::int64_t end_ns,
                                      std::size_t most) const {
  const Location* location = analysis_.trace.MainOf(rank);
  if (location == nullptr) return {};
  return VisitsIn(analysis_.trace, *location, begin_ns, end_ns, most);
}

std::optional<RunCall> AnalysisSource::CallAt(int rank, std::int64_t time_ns) const {
  const MpiActivity& mpi = analysis_.mpi;
  const Location* location = analysis_.trace.MainOf(rank);
  if (location == nullptr) return std::nullopt;
  const auto key = [](const MpiCall& c) { return std::pair(c.location, c.begin_ns); };
  const auto after = std::ranges::upper_bound(
      mpi.calls, std::pair(static_cast<std::uint32_t>(location->index), time_ns), {}, key);
  if (after == mpi.calls.begin()) return std::nullopt;
  const MpiCall& call = *std::prev(after);
  if (call.location != location->index || call.end_ns < time_ns) return std::nullopt;
  const auto index = static_cast<std::uint32_t>(&call - mpi.calls.data());
  const CallWait& wait = analysis_.waits[index];
  RunCall found{call.begin_ns, call.end_ns, wait.idle_ns, wait.idle_ns > 0 ? wait.partner : -1,
                call.region,   std::nullopt};
  std::uint32_t send = kNoIndex;
  for (std::uint32_t i = 0; i < mpi.sends.size(); ++i)
    if (mpi.sends[i].call == index) send = i;
  for (const ReceiveEvent& r : mpi.receives)
    if (r.end_call == index && r.send != kNoIndex) send = r.send;
  if (send != kNoIndex)
    if (const auto number = messages_.NumberOf(send)) found.message = MessageOf(*number);
  return found;
}

std::optional<FoundVisit> AnalysisSource::NextVisit(std::string_view text,
                                                    const std::vector<int>& ranks,
                                                    std::int64_t time_ns, int from_rank,
                                                    Direction direction) const {
  const Trace& trace = analysis_.trace;
  const RegionSearch search(trace, text);
  const bool forward = direction == Direction::kForward;
  std::optional<FoundVisit> best;
  // The same moment still counts on the ranks that come next.
  bool beyond = from_rank < 0 ? false : !forward;
  for (const int rank : ranks) {
    const bool is_from = rank == from_rank;
    if (is_from && !forward) beyond = false;
    const std::int64_t from_ns =
        time_ns - (beyond && forward ? 1 : 0) + (beyond && !forward ? 1 : 0);
    if (is_from && forward) beyond = true;
    const Location* location = trace.MainOf(rank);
    if (location == nullptr || !search.Visits(analysis_.profiles[location->index])) continue;
    const std::int64_t limit_ns = !best     ? (forward ? trace.SpanNs() + 1 : -1)
                                  : forward ? best->visit.begin_ns
                                            : best->visit.begin_ns - 1;
    if (const auto visit = search.Next(*location, from_ns, limit_ns, direction))
      best = FoundVisit{rank, *visit};
  }
  return best;
}

Table AnalysisSource::MatrixUntil(std::int64_t time_ns) const {
  std::map<int, std::size_t> place;
  Table table{"messages", TableShape::kMatrix, {{"sender"}}, {}};
  for (const int rank : ranks_) {
    place.emplace(rank, place.size());
    table.columns.push_back({analysis_.trace.RankName(rank)});
  }
  std::vector<std::int64_t> counts(ranks_.size() * ranks_.size());
  for (std::size_t i = 0, end = messages_.SentUntil(time_ns); i < end; ++i) {
    const Channel& channel = messages_.SendOf(i).channel;
    const auto row = place.find(channel.sender), column = place.find(channel.receiver);
    if (row != place.end() && column != place.end())
      ++counts[row->second * ranks_.size() + column->second];
  }
  for (std::size_t row = 0; row < ranks_.size(); ++row) {
    std::vector<Cell> cells = RowOf(analysis_.trace.RankName(ranks_[row]));
    for (std::size_t column = 0; column < ranks_.size(); ++column)
      cells.emplace_back(counts[row * ranks_.size() + column]);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table AnalysisSource::TableNamed(std::string_view name, bool per_rank) const {
  // Fine enough for a cursor that moves, coarse enough to hold for many ranks.
  constexpr std::size_t kMostRows = 100'000, kMostWindows = 400;
  const auto windows = static_cast<std::int64_t>(std::clamp<std::size_t>(
      kMostRows / std::max<std::size_t>(1, ranks_.size()), 40, kMostWindows));
  const std::int64_t window_ns = std::max<std::int64_t>(1, analysis_.trace.SpanNs() / windows);
  for (const TableEntry& entry : TableEntries())
    if (entry.name == name)
      return entry
          .make(analysis_, {}, {.per_rank = per_rank && entry.per_rank, .window_ns = window_ns})
          .table;
  return {};
}

}  // namespace

std::unique_ptr<WindowSource> MakeWindowSource(const Analysis& analysis) {
  return std::make_unique<AnalysisSource>(analysis);
}

}  // namespace stipple
