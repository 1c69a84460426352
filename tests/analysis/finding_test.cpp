// SPDX-License-Identifier: MIT
// What is said of programs written by hand: golden sentences, and where naming begins.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/message_cost.h"
#include "tests/analysis/mpi_ranks.h"

namespace stipple {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace): the ranks' regions

/// One number a rank: for so long it works in this step, then all meet in a barrier.
using Steps = std::vector<std::vector<std::uint64_t>>;

std::vector<Rank> InSteps(const Steps& steps) {
  std::vector<Rank> ranks = Ranks(static_cast<int>(steps.front().size()));
  std::uint64_t begin = 1000;
  for (const auto& work : steps) {
    const std::uint64_t met = begin + *std::ranges::max_element(work);
    for (std::size_t r = 0; r < ranks.size(); ++r) {
      ranks[r].Call(kWork, begin, begin + work[r]);
      ranks[r].Barrier(begin + work[r], met);
    }
    begin = met;
  }
  for (Rank& r : ranks) r.Finalize(begin, begin);
  return ranks;
}

Finding FindingOf(const Steps& steps) { return stipple::FindingOf(Written(InSteps(steps)).trace); }

TEST(Finding, OneIsLate) {
  const Finding f =
      FindingOf({{2000, 1000, 1000, 1000}, {2000, 1000, 1000, 1000}, {1000, 1000, 1000, 1000}});
  EXPECT_EQ(f.sentence,
            "Ranks 1-3 spend 40% of the run waiting for rank 0: it comes last to barriers");
  EXPECT_EQ(
      f.detail,
      "Rank 0 was mostly in work meanwhile; at most 1.50 µs of 5.00 µs (30%) could be gained if "
      "the work were spread evenly.");
  EXPECT_EQ(f.cause, "wait-at-barrier");
  EXPECT_EQ(f.culprit, 0);
  // Spread evenly, each step takes the mean: 1250.
  EXPECT_NEAR(f.gain_s, 2 * (2000 - 1250) * 1e-9, 1e-12);
}

TEST(Finding, ThoseThatAreAsLateAreNamedWithIt) {
  const Finding f =
      FindingOf({{1000, 2000, 1990, 1000}, {1000, 1990, 2000, 1000}, {1000, 1000, 1000, 1000}});
  EXPECT_EQ(f.sentence,
            "Ranks 0 and 3 spend 40% of the run waiting for ranks 1 and 2: they come last to "
            "barriers");
}

TEST(Finding, NowOneIsLateNowAnother) {
  const Finding f = FindingOf({{2000, 1000, 1000}, {1000, 2000, 1000}, {1000, 1000, 2000}});
  EXPECT_EQ(f.sentence,
            "The ranks spend 33% of the run waiting for each other: now one is late, now another");
  EXPECT_EQ(f.cause, "imbalance");
  EXPECT_EQ(f.culprit, -1);
  EXPECT_NEAR(f.gain_s, 2000e-9, 1e-12);
}

// Each of two is waited for half of the time: more than any share by which one would be named.
TEST(Finding, WhoWaitsAsLongAsTheOtherIsNotToBlame) {
  EXPECT_EQ(FindingOf({{2000, 1000}, {1000, 2000}, {2000, 1000}, {1000, 2000}}).cause, "imbalance");
  EXPECT_EQ(FindingOf({{2000, 1000}, {1000, 2000}, {2000, 1000}, {2000, 1000}}).culprit, 0);
}

TEST(Finding, TurnsAreNobodysFault) {
  std::vector<Rank> ranks = Ranks(4);
  for (std::uint64_t r = 0; r < 4; ++r) {
    const std::uint64_t begin = 1000 + 1000 * r;
    const int rank = static_cast<int>(r);
    if (r > 0) ranks[r].Receive(rank - 1, 1, 1000, begin + 10);
    ranks[r].Call(kWork, begin + 20, begin + 980);
    if (r < 3) ranks[r].Send(rank + 1, 1, begin + 1000, begin + 1005);
    ranks[r].Barrier(begin + 1010, 5100);
    ranks[r].Call(kHelp, 5100, 5400);
    ranks[r].Finalize(5400, 5410);
  }
  const Finding f = stipple::FindingOf(Written(ranks).trace);
  EXPECT_EQ(f.cause, "serialisation");
  EXPECT_EQ(f.sentence.substr(f.sentence.find(" of the run")),
            " of the run waiting for each other: they take turns");
}

TEST(Finding, SmallMessagesCost) {
  std::vector<Rank> ranks = Ranks(2);
  for (std::uint64_t i = 0; i < 200; ++i) {
    ranks[0].Send(1, 1, 2000 + 10 * i, 2009 + 10 * i, 8);
    ranks[1].Receive(0, 1, 2000 + 10 * i, 2009 + 10 * i, 8);
  }
  for (Rank& r : ranks) r.Finalize(5000, 5000);
  const Written w(ranks);
  const Finding f = stipple::FindingOf(w.trace);
  EXPECT_EQ(f.cause, "message-overhead");
  EXPECT_EQ(f.sentence,
            "The ranks spend 45% of the run in MPI without waiting, most of it in MPI_Send: they "
            "send 200 messages of 8 B");
  // One message of 1600 bytes would do.
  EXPECT_NEAR(f.gain_s, 1800e-9 * 199 / 200, 1e-12);
  EXPECT_EQ(CostOfMessages(Analysis(w.trace), {}).packed, 1U);
}

// From a twentieth of all ranks' time one is named, from a tenth the waiting itself.
TEST(Finding, BeginsAtAShareOfTheTime) {
  const auto one_late = [](std::uint64_t by) {
    return FindingOf({{10000 + by, 10000, 10000, 10000}}).cause;
  };
  EXPECT_EQ(one_late(690), "none");  // 3/4 of 690 of 10690: 4.8 %
  EXPECT_EQ(one_late(740), "end-imbalance");
  const auto all_late = [](std::uint64_t by) {
    const std::uint64_t late = 1000 + by;
    return FindingOf({{late, 1000, 1000}, {1000, late, 1000}, {1000, 1000, late}});
  };
  EXPECT_EQ(all_late(150).cause, "none");  // 2/3 of 150 of 1150: 8.7 %
  EXPECT_EQ(all_late(150).sentence,
            "No rank holds the others up for long: 91% of the time is computation, most of it in "
            "work, 8.7% waiting");
  EXPECT_EQ(all_late(150).gain_s, 0);
  EXPECT_EQ(all_late(200).cause, "imbalance");
}

TEST(Finding, GainIsNeverMoreThanTheLongestWait) {
  for (std::uint64_t others = 1000; others < 10000; others += 1000)
    for (int count = 2; count < 6; ++count) {
      std::vector<std::uint64_t> work(static_cast<std::size_t>(count), others);
      work[1] = 10000;
      const Finding f = FindingOf({work, work});
      EXPECT_GT(f.gain_s, 0);
      EXPECT_LT(f.gain_s, static_cast<double>(2 * (10000 - others)) * 1e-9);
    }
}

}  // namespace
}  // namespace stipple
