// SPDX-License-Identifier: MIT
#include "raytracer/partition/coupling.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace stipple::raytracer {
namespace {

std::vector<std::uint64_t> SomeBytes(std::size_t leaves) {
  std::mt19937_64 random(6);
  std::vector<std::uint64_t> bytes(leaves);
  for (std::uint64_t& one : bytes) one = 50 + random() % 100;
  return bytes;
}

/// From anywhere a few leaves on, as rays that cross neighbouring leaves do; then one that lies on
/// the way of all, as a floor does.
Ways SomeWays(std::uint32_t leaves, std::size_t count) {
  std::mt19937_64 random(8);
  Ways ways(count);
  for (std::vector<std::uint32_t>& way : ways) {
    const auto first = static_cast<std::uint32_t>(random() % leaves);
    const auto length = static_cast<std::uint32_t>(1 + random() % 4);
    for (std::uint32_t i = 0; i < length; ++i) way.push_back((first + 5 * i) % leaves);
    if (std::ranges::find(way, 3U) == way.end()) way.push_back(3);
  }
  return ways;
}

std::uint64_t Sum(const std::vector<std::uint64_t>& bytes) {
  return std::reduce(bytes.begin(), bytes.end());
}

Holding HoldingOf(const Coupling& coupling, int ranks, std::size_t leaves) {
  Holding holding(ranks, static_cast<std::uint32_t>(leaves));
  for (int rank = 0; rank < ranks; ++rank)
    for (const std::uint32_t leaf : coupling.LeavesOf(rank)) holding.Give(leaf, rank);
  return holding;
}

TEST(Coupling, EachLeafIsHeldWithinTheLimitWhateverRaysDo) {
  for (const std::size_t leaves : {8U, 32U, 33U}) {
    const std::vector<std::uint64_t> bytes = SomeBytes(leaves);
    for (const Ways& ways : {Ways(), Ways{{}}, Ways{{1}}, SomeWays(8, 500)})
      for (const double share : {0.2, 0.3, 0.5, 0.75, 1.0}) {
        const auto most = static_cast<std::uint64_t>(share * static_cast<double>(Sum(bytes)));
        const Coupling coupling(8, bytes, ways, most);
        ASSERT_TRUE(coupling.Fits());
        std::vector<int> holders(leaves);
        for (int rank = 0; rank < 8; ++rank) {
          std::uint64_t held = 0;
          for (const std::uint32_t leaf : coupling.LeavesOf(rank)) {
            held += bytes[leaf];
            ++holders[leaf];
          }
          EXPECT_LE(held, most);
          EXPECT_GT(held + 150, most);  // no room is left that a leaf would fill
        }
        EXPECT_EQ(std::ranges::count(holders, 0), 0);
      }
  }
}

TEST(Coupling, WhatCannotFitIsSaidWithWhatItTakes) {
  const std::vector<std::uint64_t> bytes = SomeBytes(32);
  const Coupling coupling(8, bytes, {}, Sum(bytes) / 16);
  EXPECT_FALSE(coupling.Fits());
  EXPECT_GE(coupling.LeastBytes(), Sum(bytes) / 8);
  EXPECT_TRUE(Coupling(8, bytes, {}, coupling.LeastBytes()).Fits());
}

TEST(Coupling, RaysTravelLessThanWhereRanksHoldRunsOfNeighbours) {
  const std::vector<std::uint64_t> bytes(32, 100);
  const Ways all = SomeWays(32, 8000);
  Ways pilot;
  for (std::size_t i = 0; i < all.size(); i += 16) pilot.push_back(all[i]);
  for (const int each : {8, 16, 24}) {
    const Coupling coupling(32, bytes, pilot, static_cast<std::uint64_t>(each) * 100);
    const Forecast coupled = Foretell(HoldingOf(coupling, 32, 32), all);
    const Forecast even = Foretell(Holding::Even(32, each), all);
    EXPECT_LT(coupled.journeys, 0.7 * even.journeys) << each;
    EXPECT_LT(coupled.balance, 1.3) << each;
  }
}

TEST(Coupling, WhoHoldsAllForetellsThatNothingTravels) {
  const Ways ways = SomeWays(8, 1000);
  const Forecast forecast = Foretell(Holding::Even(8, 8), ways);
  EXPECT_EQ(forecast.journeys, 0);
  EXPECT_NEAR(forecast.balance, 1, 0.01);
}

TEST(Coupling, OneLeafOnEachRankForetellsAJourneyForEachFurtherLeaf) {
  const Forecast forecast = Foretell(Holding::Even(4, 1), {{0, 1, 2}, {3}, {2, 1}, {}});
  EXPECT_EQ(forecast.journeys, 3.0 / 4);
  EXPECT_EQ(forecast.balance, 2.0 * 4 / 6);
}

}  // namespace
}  // namespace stipple::raytracer
