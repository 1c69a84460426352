// SPDX-License-Identifier: MIT
// Critical path, phases, imbalance and efficiencies, on programs written by hand.
#include "analysis/stats/causes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <utility>

#include "analysis/stats/efficiency.h"
#include "analysis/stats/ideal_replay.h"
#include "analysis/stats/states.h"
#include "analysis/stats/tables.h"
#include "tests/analysis/mpi_ranks.h"

namespace stipple {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the ranks' regions

std::map<std::pair<int, std::string>, double> PathOf(const Written& w,
                                                     const Selection& selection = {}) {
  const Analysis analysis(w.trace);
  std::map<std::pair<int, std::string>, double> ns;
  for (const PathRow& r : CausesOf(analysis, selection).path_rows)
    ns[{r.rank, r.region == 0 ? "" : w.trace.regions()[r.region].name}] += r.seconds * 1e9;
  return ns;
}

/// Whatever the program: the path fills the run, blame fills the waiting, efficiencies multiply.
void ExpectLawsHold(const Written& w) {
  const Analysis analysis(w.trace);
  const Causes causes = CausesOf(analysis, {});
  std::int64_t at_ns = 0;
  double path_s = 0;
  for (const PathPiece& p : causes.path) {
    EXPECT_EQ(p.begin_ns, at_ns);
    EXPECT_GT(p.end_ns, p.begin_ns);
    at_ns = p.end_ns;
  }
  EXPECT_EQ(at_ns, w.trace.SpanNs());
  for (const PathRow& r : causes.path_rows) path_s += r.seconds;
  EXPECT_NEAR(path_s * 1e9, static_cast<double>(w.trace.SpanNs()), 1e-2);
  at_ns = 0;
  for (const Phase& p : causes.phases) {
    EXPECT_EQ(p.begin_ns, at_ns);
    at_ns = p.end_ns;
  }
  EXPECT_EQ(at_ns, w.trace.SpanNs());
  EXPECT_LE(causes.phases.size(), kMostPhases);
  double blamed_s = 0;
  for (const Blame& b : causes.blames)
    if (b.kind != WaitKind::kMessageOverhead) blamed_s += b.seconds;
  double idle_s = 0;
  for (const RankStates& s : StatesOf(analysis, {}))
    idle_s += static_cast<double>(s.idle_ns) * 1e-9;
  EXPECT_NEAR(blamed_s * 1e9, idle_s * 1e9, 1e-2);
  const Efficiency e = EfficiencyOf(analysis, {});
  if (e.parallel && e.load_balance) {
    EXPECT_NEAR(*e.parallel, *e.load_balance * *e.communication, 1e-12);
  }
  if (e.serialisation && e.transfer) {
    EXPECT_NEAR(*e.communication, *e.serialisation * *e.transfer, 1e-12);
    EXPECT_LE(*e.serialisation, 1 + 1e-12);
    EXPECT_LE(*e.transfer, 1 + 1e-12);
  }
}

/// Rank 0 works until 3000 and sends; rank 1 has waited since 1100, and works until the end.
std::vector<Rank> Handover() {
  std::vector<Rank> ranks = Ranks(2);
  ranks[0].Call(kWork, 1050, 2990);
  ranks[0].Send(1, 5, 3000, 3100);
  ranks[0].End(3200);
  ranks[1].Receive(0, 5, 1100, 3150);
  ranks[1].Call(kHelp, 3160, 4900);
  ranks[1].End(5000);
  return ranks;
}

TEST(CriticalPath, GoesFromTheReceiverToTheSenderItWaitedFor) {
  const Written w(Handover());
  const auto ns = PathOf(w);
  EXPECT_NEAR(ns.at({0, "work"}), 1940, 1e-3);
  EXPECT_NEAR(ns.at({0, "main"}), 60, 1e-3);       // until the send was entered
  EXPECT_NEAR(ns.at({1, "MPI_Recv"}), 150, 1e-3);  // the message, not the waiting
  EXPECT_NEAR(ns.at({1, "help"}), 1740, 1e-3);
  EXPECT_NEAR(ns.at({1, "main"}), 110, 1e-3);
  EXPECT_EQ(ns.count({0, "MPI_Send"}), 0U);
  ExpectLawsHold(w);
  const Analysis analysis(w.trace);
  const auto rows = CausesOf(analysis, {}).path_rows;
  const std::string sentence = CriticalPathSentence(analysis, rows, {});
  EXPECT_NE(sentence.find("of the run in work on rank 0; 1.84"), std::string::npos) << sentence;
}

TEST(CriticalPath, OfASpanIsAPartOfThatOfTheRun) {
  const Written w(Handover());
  const auto all = PathOf(w);
  std::map<std::pair<int, std::string>, double> sum;
  for (std::int64_t begin = 0; begin < 4000; begin += 500) {
    Selection part;
    part.begin_ns = begin;
    part.end_ns = begin + 500;
    for (const auto& [key, ns] : PathOf(w, part)) sum[key] += ns;
  }
  ASSERT_EQ(sum.size(), all.size());
  for (const auto& [key, ns] : all) EXPECT_NEAR(sum[key], ns, 1e-3) << key.second;
}

// Twice through four ranks, so the path changes rank at each turn.
TEST(CriticalPath, FollowsATokenAround) {
  std::vector<Rank> ranks = Ranks(4);
  for (int turn = 0; turn < 8; ++turn) {
    const auto begin = static_cast<std::uint64_t>(1000 + 1000 * turn);
    Rank& r = ranks[static_cast<std::size_t>(turn % 4)];
    if (turn > 0) r.Receive((turn + 3) % 4, 1, turn < 4 ? 1010 : begin - 2990, begin + 10);
    r.Call(kWork, begin + 20, begin + 980);
    if (turn < 7) r.Send((turn + 1) % 4, 1, begin + 1000, begin + 1005);
  }
  for (int r = 0; r < 4; ++r)
    ranks[static_cast<std::size_t>(r)].End(6010 + 1000 * static_cast<std::uint64_t>(r));
  const Written w(ranks);
  ExpectLawsHold(w);
  for (int r = 0; r < 4; ++r) EXPECT_NEAR(PathOf(w).at({r, "work"}), 2 * 960, 1e-3);
}

TEST(Efficiency, OfAHandoverIsComputedByHand) {
  const Written w(Handover());
  const Efficiency e = EfficiencyOf(Analysis(w.trace), {});
  // Useful: 0: 2200 - 100 of the send; 1: 4000 - 2050 of the receive. Without transfer the receive
  // ends at 3000: the run is 150 shorter.
  const double mean = (2100 + 1950) / 2.0;
  EXPECT_NEAR(*e.parallel, mean / 4000, 1e-9);
  EXPECT_NEAR(*e.load_balance, mean / 2100, 1e-9);
  EXPECT_NEAR(*e.communication, 2100 / 4000.0, 1e-9);
  EXPECT_NEAR(*e.transfer, 3850 / 4000.0, 1e-9);
  EXPECT_NEAR(*e.serialisation, 2100 / 3850.0, 1e-9);
}

// Barriers that take 500 each and ranks that are balanced: all that is lost is transfer.
TEST(Efficiency, SlowBarriersAreTransfer) {
  std::vector<Rank> ranks = Ranks(3);
  for (Rank& r : ranks) {
    r.Barrier(2000, 2500);
    r.Barrier(3500, 4000);
    r.End(5000);
  }
  const Written w(ranks);
  const Efficiency e = EfficiencyOf(Analysis(w.trace), {});
  EXPECT_NEAR(*e.load_balance, 1, 1e-9);
  EXPECT_NEAR(*e.serialisation, 1, 1e-9);
  EXPECT_NEAR(*e.transfer, 0.75, 1e-9);
  ExpectLawsHold(w);
}

// Each works as long as the other, but in turns: no network would help.
TEST(Efficiency, TurnsAreSerialisation) {
  std::vector<Rank> ranks = Ranks(2);
  ranks[0].Call(kWork, 1000, 3000);
  ranks[0].Barrier(3000, 3001);
  ranks[0].Barrier(3001, 5000);
  ranks[1].Barrier(1000, 3001);
  ranks[1].Call(kWork, 3001, 4999);
  ranks[1].Barrier(4999, 5000);
  for (Rank& r : ranks) r.End(5000);
  const Efficiency e = EfficiencyOf(Analysis(Written(ranks).trace), {});
  EXPECT_NEAR(*e.serialisation, 0.5, 0.002);
  EXPECT_NEAR(*e.transfer, 1, 0.002);
}

TEST(Efficiency, OfASerialProgramSaysNothingOfCommunication) {
  std::vector<Rank> ranks = Ranks(1);
  ranks[0].Call(kWork, 1100, 1900);
  ranks[0].End(2000);
  const Written w(ranks);
  const Efficiency e = EfficiencyOf(Analysis(w.trace), {});
  EXPECT_EQ(*e.parallel, 1);
  EXPECT_EQ(*e.load_balance, 1);
  EXPECT_FALSE(e.serialisation.has_value());
  EXPECT_FALSE(e.transfer.has_value());
  ExpectLawsHold(w);
}

std::vector<std::size_t> BeginsOf(const std::vector<double>& feature) {
  return ChangePointsOf(std::vector<std::vector<double>>(1, feature), kMostPhases);
}

TEST(Phases, AreFoundWhereTheSeriesChanges) {
  std::vector<double> series(512, 0.9);
  for (std::size_t i = 100; i < 300; ++i) series[i] = 0.2;
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += i % 2 == 0 ? 0.01 : -0.01;
  EXPECT_EQ(BeginsOf(series), (std::vector<std::size_t>{0, 100, 300}));
  EXPECT_EQ(BeginsOf(std::vector<double>(512, 0.5)).size(), 1U);
  EXPECT_EQ(BeginsOf({1}).size(), 1U);
}

// Ranks that come one after the other are one phase, not one each.
TEST(Phases, AreNoSlivers) {
  std::vector<double> series(512, 0.1);
  for (std::size_t i = 0; i < 12; ++i) series[i] = i < 4 ? 0.9 : i < 8 ? 0.3 : 0.7;
  const std::vector<std::size_t> begins = BeginsOf(series);
  ASSERT_GE(begins.size(), 2U);
  for (std::size_t i = 1; i < begins.size(); ++i) EXPECT_GE(begins[i] - begins[i - 1], 10U);
  EXPECT_EQ(begins[1], 12U);
}

TEST(Phases, StepsOfALoopAreNotHundredsOfPhases) {
  std::vector<double> series;
  for (int i = 0; i < 512; ++i) series.push_back(i / 8 % 2 == 0 ? 1 : 0);
  EXPECT_LE(BeginsOf(series).size(), 12U);
}

/// First all work alike; then rank 2 calls help three times as often as the others, between
/// barriers; then rank 1 works twice as long as the others at once.
std::vector<Rank> ThreePhases() {
  std::vector<Rank> ranks = Ranks(4);
  for (int r = 0; r < 4; ++r) {
    Rank& rank = ranks[static_cast<std::size_t>(r)];
    rank.Call(kWork, 1000, 100'990);
    rank.Barrier(100'990, 101'000);
    std::uint64_t t = 101'000;
    for (int i = 0; i < (r == 2 ? 90 : 30); ++i, t += 1000) rank.Call(kHelp, t, t + 1000);
    rank.Barrier(t, 191'010);
    rank.Call(kWork, 191'010, r == 1 ? 290'990 : 241'000);
    rank.Barrier(r == 1 ? 290'990 : 241'000, 291'000);
    rank.End(291'000);
  }
  return ranks;
}

TEST(Phases, HaveTheirBusiestRank) {
  const Written w(ThreePhases());
  ExpectLawsHold(w);
  const Causes causes = CausesOf(Analysis(w.trace), {});
  ASSERT_GE(causes.phases.size(), 3U);
  EXPECT_NEAR(causes.phases[0].max_over_mean, 1, 0.01);
  EXPECT_NEAR(static_cast<double>(causes.phases[0].end_ns), 100'000, 31'000);
  EXPECT_EQ(causes.phases.back().busiest_rank, 1);
}

TEST(ImbalanceSplit, TellsMoreWorkFromDearerWork) {
  const Written w(ThreePhases());
  const Analysis analysis(w.trace);
  const Causes causes = CausesOf(analysis, {});
  std::map<std::pair<int, std::string>, double> ns;  // by rank and what
  std::map<std::uint32_t, double> sums;
  for (const SplitPart& p : causes.split) {
    ns[{p.rank, std::string(NameOf(p.what))}] += p.seconds * 1e9;
    sums[p.phase] += p.seconds * 1e9;
    if (p.what == SplitKind::kMoreWork && p.rank == 2 && p.seconds > 1e-6) {
      EXPECT_EQ(w.trace.regions()[p.region].name, "help");
    }
  }
  for (const auto& [phase, sum] : sums) EXPECT_NEAR(sum, 0, 0.1) << phase;
  // Rank 2: 90 visits of 1000, the mean is 45. Rank 1: 100 000, the mean is 62 500.
  EXPECT_NEAR((ns[{2, "more-work"}]), 45'000, 1500);
  EXPECT_NEAR((ns[{1, "dearer-work"}]), 37'500, 1500);
  EXPECT_LT((ns[{2, "waiting"}]), -43'000);
}

TEST(Causes, OfDamagedAndEmptyArchivesAreSound) {
  std::vector<Rank> ranks = Handover();
  ranks.pop_back();  // its send has no receive, the world no rank 1
  ExpectLawsHold(Written(ranks));
  std::vector<Rank> cut = Ranks(2);
  cut[0].Barrier(1500, 2000);
  cut[0].End(3000);
  cut[1].stream.Enter(kBarrier, 1800);  // killed in it
  const Written killed(cut);
  ExpectLawsHold(killed);
  std::vector<Rank> instant = Ranks(1);
  instant[0].End(1000);
  const Written zero(instant);
  const Causes causes = CausesOf(Analysis(zero.trace), {});
  EXPECT_TRUE(causes.path.empty());
  EXPECT_TRUE(causes.phases.empty());
  EXPECT_TRUE(causes.split.empty());
  EXPECT_FALSE(EfficiencyOf(Analysis(zero.trace), {}).parallel.has_value());
}

// 1000 ranks, 1000 barriers, another rank late at each: the cost follows the calls, not their
// square. CPU time is no promise of a test; that it ends within a test's time is.
TEST(Causes, OfAThousandRanksAndBarriersAreFoundAtOnce) {
  std::vector<Rank> ranks = Ranks(1000);
  for (int r = 0; r < 1000; ++r) {
    Rank& rank = ranks[static_cast<std::size_t>(r)];
    for (int step = 0; step < 1000; ++step) {
      const auto begin = static_cast<std::uint64_t>(2000 + 1000 * step);
      const auto late = static_cast<std::uint64_t>(r == step * 7 % 1000 ? 900 : r % 100);
      rank.Barrier(begin + late, begin + 950);
    }
    rank.End(1'003'000);
  }
  const Written w(ranks);
  const Analysis analysis(w.trace);
  const std::clock_t begin = std::clock();
  const Causes causes = CausesOf(analysis, {});
  const std::clock_t blamed = std::clock();
  const Efficiency e = EfficiencyOf(analysis, {});
  RecordProperty("causes_ms", static_cast<int>(1000 * (blamed - begin) / CLOCKS_PER_SEC));
  RecordProperty("efficiency_ms",
                 static_cast<int>(1000 * (std::clock() - blamed) / CLOCKS_PER_SEC));
  EXPECT_EQ(causes.blames.size(), 1000U * 999U);
  EXPECT_TRUE(e.transfer.has_value());
}

}  // namespace
}  // namespace stipple
