// SPDX-License-Identifier: MIT
// A run of four ranks that tests can foresee: rank r computes in [0, 10) but for the last tenth of
// each second, in which it sends to the next rank.
#ifndef STIPPLE_TESTS_ANALYSIS_VIEWS_WINDOW_FAKE_SOURCE_H
#define STIPPLE_TESTS_ANALYSIS_VIEWS_WINDOW_FAKE_SOURCE_H

#include <cmath>
#include <string>
#include <vector>

#include "analysis/stats/window_source.h"

namespace stipple::testing {

class FakeSource : public WindowSource {
 public:
  explicit FakeSource(int ranks = 4) {
    for (int r = 0; r < ranks; ++r) ranks_.push_back(r);
  }
  const std::string& Title() const override { return title_; }
  const std::string& Warning() const override { return empty_; }
  double EndSeconds() const override { return 10; }
  const std::string& RegionName(std::uint32_t region) const override { return names_[region % 3]; }
  const std::vector<int>& Ranks() const override { return ranks_; }
  std::uint64_t EventCount() const override { return 40 * ranks_.size(); }

  Timeline StatesIn(double begin_s, double end_s, std::size_t columns) const override {
    Timeline timeline;
    timeline.begin_s = begin_s;
    timeline.end_s = end_s;
    for (const int rank : ranks_) {
      TimelineRow row{std::to_string(rank), rank, false, {}};
      for (std::size_t c = 0; c < columns; ++c) {
        const double at = begin_s + (end_s - begin_s) * (static_cast<double>(c) + 0.5) /
                                        static_cast<double>(columns);
        StateShares shares{};
        shares[at - std::floor(at) < 0.9 ? 0 : 2] = 1;
        row.columns.push_back(shares);
      }
      timeline.rows.push_back(std::move(row));
    }
    timeline.sent_bytes.resize(columns, 100);
    return timeline;
  }
  std::uint64_t MessageCount(std::int64_t begin_ns, std::int64_t end_ns) const override {
    return All(begin_ns, end_ns).size();
  }
  std::vector<RunMessage> MessagesIn(std::int64_t begin_ns, std::int64_t end_ns,
                                     std::size_t most) const override {
    std::vector<RunMessage> all = All(begin_ns, end_ns);
    if (all.size() > most) all.clear();
    return all;
  }
  /// Region 0 all the time, and in it 1, or 2 while sending.
  VisitsOfSpan VisitsOf(int, std::int64_t begin_ns, std::int64_t end_ns,
                        std::size_t most) const override {
    VisitsOfSpan span;
    span.visits.push_back({0, kSecond * 10, 0, 0});
    for (std::int64_t s = 0; s < 10; ++s)
      for (const VisitSpan& v : {VisitSpan{s * kSecond, s * kSecond + kSend, 1, 1},
                                 VisitSpan{s * kSecond + kSend, (s + 1) * kSecond, 2, 1}})
        if (v.end_ns >= begin_ns && v.begin_ns <= end_ns) span.visits.push_back(v);
    span.complete = span.visits.size() <= most;
    return span;
  }
  std::optional<RunCall> CallAt(int rank, std::int64_t time_ns) const override {
    if (time_ns % kSecond < kSend) return std::nullopt;
    const std::int64_t begin = time_ns / kSecond * kSecond;
    RunCall call{begin + kSend, begin + kSecond, 0, -1, 2, std::nullopt};
    for (const RunMessage& m : All(call.begin_ns, call.begin_ns))
      if (m.sender == rank) call.message = m;
    return call;
  }
  std::optional<FoundVisit> NextVisit(std::string_view text, const std::vector<int>& ranks,
                                      std::int64_t time_ns, int from_rank,
                                      Direction direction) const override {
    std::optional<FoundVisit> best;
    const auto key = [](const FoundVisit& f) { return std::pair(f.visit.begin_ns, f.rank); };
    for (const int rank : ranks)
      for (const VisitSpan& v : VisitsOf(rank, 0, 10 * kSecond, 100).visits) {
        const FoundVisit found{rank, v};
        if (RegionName(v.region).find(text) == std::string::npos) continue;
        const bool forward = direction == Direction::kForward;
        const auto from = std::pair(time_ns, forward && from_rank < 0 ? 1 << 30 : from_rank);
        if (forward ? key(found) <= from : key(found) >= from) continue;
        if (!best || (forward ? key(found) < key(*best) : key(found) > key(*best))) best = found;
      }
    return best;
  }
  Table MatrixUntil(std::int64_t) const override { return {}; }
  Finding FindFinding() const override { return {}; }
  Table TableNamed(std::string_view, bool) const override { return {}; }

  static constexpr std::int64_t kSecond = 1'000'000'000, kSend = 900'000'000;

 private:
  std::vector<RunMessage> All(std::int64_t begin_ns, std::int64_t end_ns) const {
    std::vector<RunMessage> found;
    std::size_t number = 0;
    for (std::int64_t s = 0; s < 10; ++s)
      for (const int rank : ranks_) {
        const int to = (rank + 1) % static_cast<int>(ranks_.size());
        RunMessage m{number++,    rank,
                     to,          7,
                     100,         s * kSecond + kSend,
                     s * kSecond, s * kSecond + kSend + 50'000'000,
                     "MPI_Send",  "MPI_Recv"};
        if (m.receive_ns >= begin_ns && m.send_ns <= end_ns) found.push_back(m);
      }
    return found;
  }

  std::string title_ = "program", empty_;
  std::string names_[3] = {"main", "Compute(int)", "MPI_Send"};
  std::vector<int> ranks_;
};

}  // namespace stipple::testing

#endif
