// SPDX-License-Identifier: MIT
// The scan of a thread's events, on streams made at random: taken up again at any place it goes on
// as if it had not stopped; and what the profile makes of it by the block is what it makes event by
// event, and what another way of counting makes of it.
#include "analysis/trace/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/stats/estimate_visitor.h"
#include "analysis/stats/profile_visitor.h"
#include "analysis/trace/call_stack.h"
#include "analysis/trace/chunk_code.h"
#include "tests/analysis/random_stream.h"

namespace stipple {
namespace {

using testing::RandomStream;

constexpr std::uint64_t kSeeds = 60;
constexpr std::size_t kWords = 20'000;

/// From none to many.
int OddsOf(std::uint64_t seed) { return static_cast<int>(seed % 4 == 0 ? 0 : 3 << (seed % 11)); }

/// Writes down what it sees.
struct Recorder {
  using Seen = std::tuple<std::uint32_t, bool, std::uint64_t, const EventWord*>;
  std::vector<Seen> seen;
  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    seen.emplace_back(region, leave, ticks, nullptr);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    seen.emplace_back(0, false, ticks, record);
  }
};

TEST(Scan, GoesOnFromAnyPlace) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomStream stream(seed, OddsOf(seed), kWords);
    Recorder whole;
    std::vector<std::pair<ScanPlace, std::size_t>> places;
    ScanThread(
        stream.thread, RandomStream::kRegions, whole, [](std::uint64_t) {}, 500,
        [&](const ScanPosition& at) { places.emplace_back(at.Place(), whole.seen.size()); });
    ASSERT_GT(places.size(), kWords / 2000);
    for (std::size_t i = 0; i < places.size(); i += 1 + places.size() / 7) {
      Recorder rest;
      ScanPosition at(places[i].first);
      ScanCounts counts;
      while (ScanSome(stream.thread, RandomStream::kRegions, 777, at, counts, rest)) {
      }
      const auto from = whole.seen.begin() + static_cast<std::ptrdiff_t>(places[i].second);
      ASSERT_EQ(std::vector(from, whole.seen.end()), rest.seen) << "seed " << seed;
    }
  }
}

template <class Visitor>
std::vector<std::uint32_t> OpenRegionsOf(const Visitor& visitor) {
  std::vector<std::uint32_t> regions;
  for (const OpenVisit& v : visitor.OpenVisits())
    regions.push_back(static_cast<std::uint32_t>(v.region));
  return regions;
}

TEST(Scan, TellsTheOpenStackBetweenParts) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomStream stream(seed, 0, kWords);  // every event is in its place
    Recorder recorder;
    std::vector<std::size_t> seen;
    const auto ignore = [](std::uint64_t) {};
    ScanThread(stream.thread, RandomStream::kRegions, recorder, ignore, 500,
               [&](const ScanPosition&) { seen.push_back(recorder.seen.size()); });
    ProfileVisitor visitor(RandomStream::kRegions, 0, kNoTickLimit, nullptr);
    std::vector<std::uint32_t> open;
    std::size_t part = 0;
    std::size_t event = 0;
    ScanThread(stream.thread, RandomStream::kRegions, visitor, ignore, 500,
               [&](const ScanPosition&) {
                 for (; event < seen[part]; ++event) {
                   const auto& [region, leave, ticks, record] = recorder.seen[event];
                   if (leave)
                     open.pop_back();
                   else
                     open.push_back(region);
                 }
                 ++part;
                 ASSERT_EQ(open, OpenRegionsOf(visitor));
                 ASSERT_TRUE(visitor.IsPlain());
               });
    EXPECT_EQ(part, seen.size());
  }
}

/// The same visitor, to which all events come one by one.
template <class Visitor>
struct OneByOne {
  struct Hot {
    typename Visitor::Hot hot;
    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      hot.Function(region, leave, ticks);
    }
    void Run(const EventWord* first,
             const UnclockedRun& run) requires HasRuns<typename Visitor::Hot> {
      hot.Run(first, run);
    }
    void Unclocked(std::uint32_t region, bool leave,
                   std::uint64_t ticks) requires HasUnclocked<typename Visitor::Hot> {
      hot.Unclocked(region, leave, ticks);
    }
    void Counted(const EventWord* record, std::uint32_t region,
                 std::uint64_t ticks) requires HasCounted<typename Visitor::Hot> {
      hot.Counted(record, region, ticks);
    }
    void Record(const EventWord* record, std::uint64_t ticks) { hot.Record(record, ticks); }
  };
  Visitor& visitor;
  void BeginChunk() requires HasChunks<Visitor> { visitor.BeginChunk(); }
  Hot Begin() const { return {visitor.Begin()}; }
  void End(const Hot& hot) { visitor.End(hot.hot); }
};

/// Counts by looking at the whole stack at each event.
class WholeStack {
 public:
  WholeStack(std::uint64_t begin, std::uint64_t end)
      : begin_(begin), end_(end), last_(begin), times_(RandomStream::kRegions) {}

  struct Time {
    std::uint64_t calls, inclusive, exclusive;
    bool operator==(const Time&) const = default;
  };
  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Charge(ticks);
    if (!leave && ticks >= begin_ && ticks <= end_) ++times_[region].calls;
    stack_.Function(region, leave);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    Charge(ticks);
    stack_.Record(record);
  }
  void Charge(std::uint64_t ticks) {
    const std::uint64_t now = std::clamp(ticks, begin_, end_);
    std::set<std::uint32_t> open(stack_.frames().begin(), stack_.frames().end());
    for (const std::uint32_t region : open) times_[region].inclusive += now - last_;
    if (!stack_.frames().empty()) times_[stack_.top()].exclusive += now - last_;
    last_ = now;
  }
  std::uint64_t last() const { return last_; }
  const std::vector<Time>& times() const { return times_; }

 private:
  std::uint64_t begin_, end_, last_;
  std::vector<Time> times_;
  CallStack stack_;
};

/// All that a profile says.
using Said = std::tuple<std::vector<WholeStack::Time>, std::vector<std::uint64_t>, std::uint64_t,
                        std::uint64_t, std::vector<std::uint32_t>>;
Said SaidBy(const ProfileVisitor& visitor, const std::vector<std::uint32_t>& open) {
  std::vector<WholeStack::Time> times;
  for (const VisitSums& r : visitor.regions())
    times.push_back({r.Calls(), r.Inclusive(), r.Exclusive()});
  std::vector<std::uint64_t> slack;
  for (const RegionSlack& s : visitor.slacks()) {
    slack.push_back(s.guessed);
    slack.push_back(s.possible);
  }
  return {times, slack, visitor.leaves_without_enter(), visitor.enters_without_leave(), open};
}

class Profile : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Profile, IsTheSameByTheBlockAndEventByEvent) {
  const std::uint64_t seed = GetParam();
  const RandomStream stream(seed, OddsOf(seed), kWords);
  const std::uint64_t first = stream.thread.chunks.front().ticks;
  const std::uint64_t span = stream.last_ticks() - first;
  const auto ignore = [](std::uint64_t) {};
  for (const auto& [begin, end] :
       {std::pair{std::uint64_t{0}, kNoTickLimit}, std::pair{first + span / 3, kNoTickLimit},
        std::pair{first + span / 4, first + span / 2}}) {
    ProfileVisitor fast(RandomStream::kRegions, begin, end, nullptr);
    ProfileVisitor slow(RandomStream::kRegions, begin, end, nullptr);
    OneByOne<ProfileVisitor> one_by_one{slow};
    WholeStack whole(begin, end);
    const auto scan = [&](auto& visitor, std::uint64_t part_words) {
      return ScanThread(stream.thread, RandomStream::kRegions, visitor, ignore, part_words,
                        [](const ScanPosition&) {});
    };
    const ScanCounts fast_counts = scan(fast, seed % 3 == 0 ? 100 : kNoTickLimit);
    const ScanCounts slow_counts = scan(one_by_one, kNoTickLimit);
    scan(whole, kNoTickLimit);
    const std::vector<std::uint32_t> fast_open = OpenRegionsOf(fast);
    const std::vector<std::uint32_t> slow_open = OpenRegionsOf(slow);
    fast.Finish(stream.last_ticks());
    slow.Finish(stream.last_ticks());
    whole.Charge(std::max(stream.last_ticks(), whole.last()));
    EXPECT_EQ(SaidBy(fast, fast_open), SaidBy(slow, slow_open));
    EXPECT_EQ(whole.times(), std::get<0>(SaidBy(fast, {})));
    EXPECT_EQ(fast_counts.function_events, slow_counts.function_events);
    EXPECT_EQ(fast_counts.records, slow_counts.records);
    EXPECT_EQ(fast_counts.undefined_regions, slow_counts.undefined_regions);
    EXPECT_EQ(fast_counts.uncommitted, slow_counts.uncommitted);
    EXPECT_EQ(fast_counts.bad_records, slow_counts.bad_records);
  }
}

/// All that a scan for estimates says.
std::vector<double> SaidBy(const EstimateVisitor& visitor) {
  std::vector<double> said;
  const auto say = [&said](auto... values) { (said.push_back(static_cast<double>(values)), ...); };
  for (const RegionTally& r : visitor.regions()) {
    say(r.Calls(), r.Inclusive(), r.Exclusive(), r.InclusiveCost(), r.timed_children, r.other_cost,
        r.other_visits, r.other_events, r.pending, r.recursive);
    for (const VisitSample& s : r.samples)
      say(s.around, s.nested, s.visits, s.inclusive, s.exclusive, s.inside);
  }
  say(visitor.unclocked_events(), visitor.leaves_without_enter(), visitor.enters_without_leave());
  return said;
}

/// The same thread with each chunk compacted that can be.
struct CompactedThread {
  explicit CompactedThread(const ThreadStream& of) : thread(of) {
    ChunkCoder coder;
    for (Chunk& c : thread.chunks) {
      frames.push_back(coder.Code({c.begin, c.end}).frame);
      if (frames.back().empty()) continue;
      c.code = std::as_bytes(std::span(frames.back()));
      c.coded_words = static_cast<std::uint64_t>(c.end - c.begin);
      c.begin = c.end = nullptr;
    }
  }
  ThreadStream thread;
  std::deque<std::string> frames;
};

class Estimate : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Estimate, IsTheSameByTheBlockAndEventByEvent) {
  const std::uint64_t seed = GetParam();
  const RandomStream stream(seed, OddsOf(seed), kWords);
  const CompactedThread compacted(stream.thread);
  const std::uint64_t first = stream.thread.chunks.front().ticks;
  const std::uint64_t span = stream.last_ticks() - first;
  const EventPrices prices{4000, 1500, 9000, 2000, 700, 300, 2500};
  for (const auto& [begin, end] :
       {std::pair{first, kNoTickLimit}, std::pair{first + span / 4, first + span / 2}}) {
    const auto said = [&, begin = begin, end = end](const ThreadStream& thread, bool by_block,
                                                    std::uint64_t part_words) {
      EstimateVisitor visitor(RandomStream::kRegions, begin, end, prices, seed % 5 == 0, nullptr);
      OneByOne<EstimateVisitor> one_by_one{visitor};
      std::vector<std::vector<std::uint32_t>> open;
      const auto scan = [&](auto& as) {
        ScanThread(
            thread, RandomStream::kRegions, as,
            [&](std::uint64_t) { open.push_back(OpenRegionsOf(visitor)); }, part_words,
            [](const ScanPosition&) {});
      };
      by_block ? scan(visitor) : scan(one_by_one);
      visitor.Finish(stream.last_ticks(), {}, 0);
      return std::pair(SaidBy(visitor), open);
    };
    const auto expected = said(stream.thread, false, kNoTickLimit);
    EXPECT_EQ(expected, said(stream.thread, true, kNoTickLimit));
    EXPECT_EQ(expected, said(stream.thread, true, 3 + seed * 7));
    EXPECT_EQ(expected, said(compacted.thread, true, kNoTickLimit));
    EXPECT_EQ(expected, said(compacted.thread, true, 100 + seed));
    const auto sum = [](const auto& numbers) {
      return std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0});
    };
    EstimateVisitor whole(RandomStream::kRegions, begin, end, prices, true, nullptr);
    ScanThread(
        stream.thread, RandomStream::kRegions, whole, [](std::uint64_t) {}, kNoTickLimit,
        [](const ScanPosition&) {});
    whole.Finish(stream.last_ticks(), {}, 0);
    std::vector<std::uint64_t> exclusive;
    for (const RegionTally& r : whole.regions()) exclusive.push_back(r.Exclusive());
    EXPECT_EQ(std::clamp(stream.last_ticks(), begin, end) - begin, sum(exclusive));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Estimate, ::testing::Range(std::uint64_t{0}, kSeeds));
INSTANTIATE_TEST_SUITE_P(Seeds, Profile, ::testing::Range(std::uint64_t{0}, kSeeds));

}  // namespace
}  // namespace stipple
