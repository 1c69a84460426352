// SPDX-License-Identifier: MIT
// Kinds of waits and who is to blame, on programs written by hand.
#include "analysis/stats/blame.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "analysis/stats/causes.h"
#include "analysis/stats/states.h"
#include "tests/analysis/mpi_ranks.h"

namespace stipple {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the ranks' regions

/// Nanoseconds by kind, waiter and culprit.
using Sums = std::map<std::tuple<std::string, int, int>, double>;

Sums SumsOf(const Written& w, const Selection& selection = {}) {
  const Analysis analysis(w.trace);
  Sums sums;
  for (const Blame& b : BlameOf(w.trace, analysis.mpi, analysis.waits, selection))
    sums[{std::string(NameOf(b.kind)), b.waiter, b.culprit}] += b.seconds * 1e9;
  return sums;
}

std::set<std::string> KindsOf(const Sums& sums) {
  std::set<std::string> kinds;
  for (const auto& [key, ns] : sums)
    if (ns > 0.5) kinds.insert(std::get<0>(key));
  return kinds;
}

/// Waits are blamed on somebody to the last nanosecond, whatever their kinds.
void ExpectAllIdleTimeIsCharged(const Written& w) {
  const Analysis analysis(w.trace);
  std::map<int, double> blamed;
  for (const Blame& b : BlameOf(w.trace, analysis.mpi, analysis.waits, {}))
    if (b.kind != WaitKind::kMessageOverhead) blamed[b.waiter] += b.seconds * 1e9;
  for (const RankStates& s : StatesOf(analysis, {}))
    EXPECT_NEAR(blamed[s.rank], static_cast<double>(s.idle_ns), 1e-3) << "rank " << s.rank;
}

/// Each rank computes for 1000 when it gets the token, and hands it on.
std::vector<Rank> Ring(int count) {
  std::vector<Rank> ranks = Ranks(count);
  for (int r = 0; r < count; ++r) {
    const auto begin = static_cast<std::uint64_t>(1000 + 1000 * r);
    if (r > 0) ranks[r].Receive(r - 1, 1, 1000, begin + 10);
    ranks[r].Call(kWork, begin + 20, begin + 980);
    if (r + 1 < count) ranks[r].Send(r + 1, 1, begin + 1000, begin + 1005);
    ranks[r].Finalize(begin + 1010, static_cast<std::uint64_t>(1000 * count) + 1100);
  }
  return ranks;
}

TEST(Blame, TokenInARingIsSerialisation) {
  for (const int count : {3, 4, 16}) {
    const Written w(Ring(count));
    const Sums sums = SumsOf(w);
    EXPECT_EQ(KindsOf(sums), std::set<std::string>{"serialisation"}) << count;
    // Everyone waits for the turn of everyone else, about as long as it takes.
    for (int waiter = 0; waiter < count; ++waiter)
      for (int culprit = 0; culprit < count; ++culprit) {
        if (waiter == culprit) continue;
        const auto found = sums.find({"serialisation", waiter, culprit});
        ASSERT_NE(found, sums.end()) << count << ": " << waiter << " for " << culprit;
        EXPECT_NEAR(found->second, 1000, 30);
      }
    ExpectAllIdleTimeIsCharged(w);
  }
}

// With work of its own, 400, besides its turn of 500 no rank waits for three whole turns.
TEST(Blame, TokenIsSerialisationAlsoAmongRanksThatWorkMeanwhile) {
  std::vector<Rank> ranks = Ranks(4);
  std::vector<std::uint64_t> free_at(4, 1400);
  std::uint64_t token_at = 1400;
  for (int turn = 0; turn < 20; ++turn) {
    const int r = turn % 4;
    Rank& rank = ranks[static_cast<std::size_t>(r)];
    std::uint64_t& now = free_at[static_cast<std::size_t>(r)];
    if (turn > 0) rank.Receive((r + 3) % 4, 1, now, token_at + 1);
    rank.Call(kWork, token_at + 2, token_at + 490);
    token_at += 500;
    if (turn < 19) rank.Send((r + 1) % 4, 1, token_at, token_at + 5);
    now = token_at + 400;
  }
  for (Rank& r : ranks) r.End(12'000);
  const Written w(ranks);
  double turns = 0;
  double all = 0;
  for (const auto& [key, ns] : SumsOf(w)) {
    all += ns;
    if (std::get<0>(key) == "serialisation") turns += ns;
  }
  EXPECT_GT(turns, 0.8 * all);
  ExpectAllIdleTimeIsCharged(w);
}

TEST(Blame, TurnsBetweenBarriersAreSerialisation) {
  std::vector<Rank> ranks = Ranks(4);
  for (int r = 0; r < 4; ++r) {
    for (int turn = 0; turn < 4; ++turn) {
      const auto begin = static_cast<std::uint64_t>(1000 + 1000 * turn);
      if (turn == r) ranks[r].Call(kWork, begin + 10, begin + 980);
      ranks[r].Barrier(turn == r ? begin + 990 : begin + 10, begin + 1000);
    }
    ranks[r].Call(kHelp, 5000, 6900);
    ranks[r].End(7000);
  }
  EXPECT_EQ(KindsOf(SumsOf(Written(ranks))), std::set<std::string>{"serialisation"});
}

// The nodes end one after the other, then the host puts the picture together. What it does is not
// the last of their turns.
TEST(Blame, HostThatWorksAloneAtTheEndTakesNoTurn) {
  std::vector<Rank> ranks = Ranks(5);
  Rank& host = ranks[4];
  host.stream.Define(DefineHost{});
  std::uint64_t now = 1001;
  for (int r = 0; r < 4; ++r) {
    const auto done = static_cast<std::uint64_t>(2000 + 600 * r);
    if (r > 0) {
      host.Send(r, 1, now, now + 2);
      ranks[r].Receive(4, 1, 1010, now + 4);
    }
    ranks[r].Call(kWork, now + 6, done - 5);
    ranks[r].Send(4, 2, done, done + 5);
    ranks[r].Barrier(done + 10, 6005);
    ranks[r].Finalize(6010, 6020);
    host.Receive(r, 2, now + 5, done + 5);
    now = done + 10;
  }
  host.Call(kHelp, now, 5990);
  host.Barrier(6000, 6005);
  host.Finalize(6010, 6020);
  const Written w(ranks);
  double at_the_end = 0;
  for (const auto& [key, ns] : SumsOf(w)) {
    if (std::get<2>(key) != 4) continue;
    EXPECT_NE(std::get<0>(key), "serialisation") << ns;
    if (std::get<0>(key) == "end-imbalance") at_the_end += ns;
  }
  EXPECT_GT(at_the_end, 4 * 2100);
  const Analysis analysis(w.trace);
  const Blame first = BlameOf(w.trace, analysis.mpi, analysis.waits, {}).front();
  EXPECT_EQ(first.culprit, 4);
  EXPECT_EQ(w.trace.regions()[first.region].name, "help");
  ExpectAllIdleTimeIsCharged(w);
}

// The same rank is late at each barrier, the others work half as long.
TEST(Blame, OneSlowRankIsNotSerialisation) {
  std::vector<Rank> ranks = Ranks(4);
  for (int r = 0; r < 4; ++r) {
    for (int step = 0; step < 5; ++step) {
      const auto begin = static_cast<std::uint64_t>(1000 + 1000 * step);
      ranks[r].Call(kWork, begin + 10, begin + (r == 2 ? 900 : 450));
      ranks[r].Barrier(begin + (r == 2 ? 910 : 460), begin + 950);
    }
    ranks[r].Call(kHelp, 6000, 6990);
    ranks[r].End(7000);
  }
  const Written w(ranks);
  const Sums sums = SumsOf(w);
  EXPECT_EQ(KindsOf(sums), std::set<std::string>{"wait-at-barrier"});
  for (const auto& [key, ns] : sums) EXPECT_EQ(std::get<2>(key), 2);
  ExpectAllIdleTimeIsCharged(w);
}

/// Workers ask rank 0 for work, which takes `service` for each, one after the other.
std::vector<Rank> MasterOf(int workers, std::uint64_t service) {
  std::vector<Rank> ranks = Ranks(workers + 1);
  const auto count = static_cast<std::uint64_t>(workers);
  const std::uint64_t round = service * count;
  for (std::uint64_t step = 0; step < 4; ++step)
    for (int r = 1; r <= workers; ++r) {
      const std::uint64_t asked = 1000 + step * round + 100 * step + static_cast<std::uint64_t>(r);
      const std::uint64_t served =
          1100 + step * round + 100 * step + service * (static_cast<std::uint64_t>(r) - 1);
      ranks[0].Receive(r, 1, served, served + 5);
      ranks[0].Call(kHelp, served + 6, served + service - 10);
      ranks[0].Send(r, 2, served + service - 8, served + service - 2);
      ranks[r].Send(0, 1, asked, asked + 2);
      ranks[r].Receive(0, 2, asked + 3, served + service);
    }
  for (Rank& r : ranks) r.End(8000 + 4 * round);
  return ranks;
}

TEST(Blame, MasterThatCannotKeepUpStarvesItsWorkers) {
  const Written w(MasterOf(5, 200));
  const Sums sums = SumsOf(w);
  double starved = 0;
  double all = 0;
  for (const auto& [key, ns] : sums) {
    all += ns;
    if (std::get<0>(key) != "master-starvation") continue;
    starved += ns;
    EXPECT_EQ(std::get<2>(key), 0);
    EXPECT_NE(std::get<1>(key), 0);
  }
  EXPECT_GT(starved, 0.9 * all);
  ExpectAllIdleTimeIsCharged(w);
  const Analysis analysis(w.trace);
  const Blame first = BlameOf(w.trace, analysis.mpi, analysis.waits, {}).front();
  EXPECT_EQ(w.trace.regions()[first.region].name, "help");
}

// One rank sends to all, unasked: they wait for a late sender, not for a master.
TEST(Blame, SenderWhomNobodyAsksIsNoMaster) {
  std::vector<Rank> ranks = Ranks(5);
  ranks[0].Call(kWork, 1010, 2990);
  for (int r = 1; r < 5; ++r) {
    const auto sent = static_cast<std::uint64_t>(3000 + 10 * r);
    ranks[0].Send(r, 1, sent, sent + 5);
    ranks[r].Receive(0, 1, 1100, sent + 8);
  }
  for (Rank& r : ranks) r.End(4000);
  EXPECT_EQ(KindsOf(SumsOf(Written(ranks))), std::set<std::string>{"late-sender"});
}

// Rank 0 takes from 1, which is late, then from 2 and 3, which were there, working 500 on each.
TEST(Blame, WorkThatWasThereIsLostToTheOrderOfReceives) {
  std::vector<Rank> ranks = Ranks(4);
  ranks[0].Receive(1, 1, 1100, 2110);
  ranks[0].Call(kWork, 2110, 2600);
  ranks[0].Receive(2, 1, 2610, 2620);
  ranks[0].Call(kWork, 2620, 2920);
  ranks[0].Receive(3, 1, 2930, 2940);
  ranks[0].Call(kWork, 2940, 3140);
  ranks[1].Call(kWork, 1010, 2090);
  ranks[1].Send(0, 1, 2100, 2110);
  ranks[2].Send(0, 1, 1050, 1060);
  ranks[3].Send(0, 1, 1200, 1210);
  ranks[0].Barrier(3150, 3200);
  for (int r = 1; r < 4; ++r) ranks[r].Barrier(3100, 3200);
  for (Rank& r : ranks) r.End(4000);
  const Written w(ranks);
  const Sums sums = SumsOf(w);
  // 310 of work on 2's message and 210 on 3's, both there during the wait of 1000.
  EXPECT_NEAR(sums.at({"head-of-line", 0, 1}), 520, 1);
  EXPECT_NEAR(sums.at({"late-sender", 0, 1}), 480, 1);
  ExpectAllIdleTimeIsCharged(w);
}

TEST(Blame, TakingAllBeforeWorkingLosesNothingToTheOrder) {
  std::vector<Rank> ranks = Ranks(4);
  ranks[0].Receive(1, 1, 1100, 2110);
  ranks[0].Receive(2, 1, 2110, 2120);
  ranks[0].Receive(3, 1, 2120, 2130);
  ranks[0].Call(kWork, 2140, 3900);
  ranks[1].Call(kWork, 1010, 2090);
  ranks[1].Send(0, 1, 2100, 2110);
  ranks[2].Send(0, 1, 1050, 1060);
  ranks[3].Send(0, 1, 1200, 1210);
  for (Rank& r : ranks) r.End(4000);
  EXPECT_EQ(KindsOf(SumsOf(Written(ranks))), std::set<std::string>{"late-sender"});
}

// Rank 2 cannot get rid of its message: rank 0 waits for rank 1 first.
TEST(Blame, SenderBehindTheHeadOfTheLineIsHeldUpByIt) {
  std::vector<Rank> ranks = Ranks(3);
  ranks[0].Receive(1, 1, 1100, 2110);
  ranks[0].Receive(2, 1, 2120, 2140);
  ranks[1].Call(kWork, 1010, 2090);
  ranks[1].Send(0, 1, 2100, 2110);
  ranks[2].Send(0, 1, 1200, 2140, 1'000'000);
  for (Rank& r : ranks) r.End(4000);
  const Written w(ranks);
  const Sums sums = SumsOf(w);
  EXPECT_NEAR(sums.at({"head-of-line", 2, 1}), 900, 1);
  // That rank 0 was not there then, either, is because it had waited before.
  EXPECT_NEAR(sums.at({"late-receiver", 2, 1}), 20, 1);
  ExpectAllIdleTimeIsCharged(w);
}

// A line of ranks that work 1000 in each step, but rank 3 twice that. Its neighbours' neighbours
// wait for its neighbours, which work no longer than anybody: what made them late is one step back.
TEST(Blame, DelayThatWandersIsChargedToWhereItBegan) {
  constexpr int kRanks = 6;
  constexpr int kSteps = 8;
  std::vector<Rank> ranks = Ranks(kRanks);
  std::vector<std::uint64_t> now(kRanks, 1000);
  for (int step = 0; step < kSteps; ++step) {
    std::vector<std::uint64_t> sent(kRanks);
    for (int r = 0; r < kRanks; ++r) {
      const auto i = static_cast<std::size_t>(r);
      ranks[i].Call(kWork, now[i] + 1, now[i] + (r == 3 ? 1999 : 999));
      sent[i] = now[i] + (r == 3 ? 2000 : 1000);
      if (r > 0) ranks[i].Send(r - 1, 1, sent[i], sent[i] + 1);
      if (r + 1 < kRanks) ranks[i].Send(r + 1, 1, sent[i], sent[i] + 1);
      now[i] = sent[i] + 2;
    }
    for (int r = 0; r < kRanks; ++r) {
      const auto i = static_cast<std::size_t>(r);
      for (const int from : {r - 1, r + 1}) {
        if (from < 0 || from >= kRanks) continue;
        const std::uint64_t end = std::max(now[i], sent[static_cast<std::size_t>(from)]) + 2;
        ranks[i].Receive(from, 1, now[i], end);
        now[i] = end;
      }
    }
  }
  for (int r = 0; r < kRanks; ++r) ranks[static_cast<std::size_t>(r)].End(30'000);
  const Written w(ranks);
  std::map<int, double> charged;
  double all = 0;
  for (const auto& [key, ns] : SumsOf(w)) {
    charged[std::get<2>(key)] += ns;
    all += ns;
  }
  EXPECT_GT(all, 4000 * (kSteps - 3));
  EXPECT_GT(charged[3], 0.98 * all);
  ExpectAllIdleTimeIsCharged(w);
  // Of some ranks only: the same.
  Selection last;
  last.ranks = {0};
  for (const auto& [key, ns] : SumsOf(w, last)) {
    EXPECT_EQ(std::get<1>(key), 0);
    EXPECT_TRUE(ns <= 100 || std::get<2>(key) == 3) << ns;
  }
}

// What ends with MPI_Finalize, or with a barrier and nothing behind it, ends the run.
TEST(Blame, WaitingAtTheEndIsEndImbalance) {
  std::vector<Rank> ranks = Ranks(3);
  for (int r = 0; r < 3; ++r) {
    const std::uint64_t done = r == 1 ? 5000 : 3000;
    ranks[r].Call(kWork, 1010, 1200);
    ranks[r].Barrier(r == 0 ? 1500 : 1210, 1510);
    ranks[r].Call(kWork, 1520, done - 10);
    ranks[r].Barrier(done, 5010);
    ranks[r].Finalize(5015, 5050);
  }
  const Written w(ranks);
  const Sums sums = SumsOf(w);
  EXPECT_NEAR(sums.at({"end-imbalance", 0, 1}), 2000, 1);
  EXPECT_NEAR(sums.at({"end-imbalance", 2, 1}), 2000, 1);
  EXPECT_NEAR(sums.at({"wait-at-barrier", 1, 0}), 290, 1);
  ExpectAllIdleTimeIsCharged(w);
}

TEST(Blame, ManySmallMessagesAreOverheadOfTheirSender) {
  std::vector<Rank> ranks = Ranks(2);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const std::uint64_t t = 1010 + 20 * i;
    ranks[0].stream.Enter(kHelp, t);
    ranks[0].Send(1, 1, t + 1, t + 13);
    ranks[0].stream.Leave(kHelp, t + 14);
    ranks[1].Receive(0, 1, t + 1, t + 13);
  }
  for (Rank& r : ranks) r.End(6000);
  const Written w(ranks);
  const Analysis analysis(w.trace);
  double overhead = 0;
  for (const Blame& b : BlameOf(w.trace, analysis.mpi, analysis.waits, {})) {
    ASSERT_EQ(b.kind, WaitKind::kMessageOverhead);
    EXPECT_EQ(b.waiter, b.culprit);
    EXPECT_EQ(w.trace.regions()[b.region].name, b.waiter == 0 ? "help" : "main");
    overhead += b.seconds * 1e9;
  }
  EXPECT_NEAR(overhead, 200 * 12 * 2, 1);
  EXPECT_EQ(analysis.mpi.Unmatched(), 0U);
}

// 0 and 1 wait for each other's receive as in a deadlock that a buffer resolved: the walk ends.
TEST(Blame, CirclesOfWaitsEnd) {
  std::vector<Rank> ranks = Ranks(3);
  for (int r = 0; r < 3; ++r) {
    const auto to = (r + 1) % 3;
    const auto from = (r + 2) % 3;
    const auto begin = static_cast<std::uint64_t>(1100 + 10 * r);
    ranks[r].Send(to, 1, begin, 2500);
    ranks[r].Receive(from, 1, 2000 + begin, 4000);
    ranks[r].End(5000);
  }
  ExpectAllIdleTimeIsCharged(Written(ranks));
}

// Two waiters of one culprit at different times: each learns what it was doing in its own.
TEST(Blame, EachWaiterIsToldWhatTheCulpritDidInItsWait) {
  std::vector<Rank> ranks = Ranks(3);
  ranks[0].Call(kWork, 1010, 2990);
  ranks[0].Send(1, 1, 3000, 3010);
  ranks[0].Call(kHelp, 3020, 4990);
  ranks[0].Send(2, 1, 5000, 5010);
  ranks[1].Receive(0, 1, 1100, 3020);
  ranks[2].Call(kWork, 1010, 3090);
  ranks[2].Receive(0, 1, 3100, 5020);
  for (Rank& r : ranks) r.End(6000);
  const Written w(ranks);
  const Analysis analysis(w.trace);
  std::map<int, std::string> regions;
  for (const Blame& b : BlameOf(w.trace, analysis.mpi, analysis.waits, {}))
    regions[b.waiter] = w.trace.regions()[b.region].name;
  EXPECT_EQ(regions[1], "work");
  EXPECT_EQ(regions[2], "help");
}

}  // namespace
}  // namespace stipple
