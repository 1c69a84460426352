// SPDX-License-Identifier: MIT
#include "raytracer/partition/guided.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace stipple::raytracer {
namespace {

TEST(Guided, TilesCoverTheRasterOnceAndHoldTheirMiddle) {
  for (const ImageSize raster : {ImageSize{1, 1}, {5, 3}, {48, 40}, {512, 512}, {1025, 769}}) {
    const Tiles tiles(raster);
    std::vector<int> seen(PointCount(raster));
    for (std::uint32_t tile = 0; tile < tiles.count(); ++tile) {
      const std::vector<RasterPoint> points = tiles.Points(tile);
      for (const RasterPoint point : points) ++seen.at(point);
      EXPECT_EQ(std::ranges::count(points, tiles.Middle(tile)), 1);
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
  }
}

TEST(Guided, ThePilotIsASmallPartOfThePicture) {
  for (const int edge : {64, 256, 512, 1024, 4096}) {
    const ImageSize raster{edge, edge};
    EXPECT_LE(Tiles(raster).count() * 16, PointCount(raster)) << edge;
  }
  EXPECT_EQ(Tiles({1024, 1024}).count(), 64U * 64U);
}

std::vector<std::uint64_t> SomeCosts(std::size_t count) {
  std::mt19937_64 random(3);
  std::vector<std::uint64_t> costs(count);
  for (std::uint64_t& cost : costs) cost = random() % 1000;
  return costs;
}

std::uint64_t CostOf(const std::vector<std::uint32_t>& tiles,
                     const std::vector<std::uint64_t>& costs) {
  return std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0},
                         [&](std::uint64_t sum, std::uint32_t tile) { return sum + costs[tile]; });
}

TEST(Guided, BundlesHoldEachTileOnceTheDearestFirst) {
  for (const std::vector<int>& ranks : {std::vector{1}, {2}, {8}, {3, 1}, {32, 32, 32, 7}}) {
    const std::vector<std::uint64_t> costs = SomeCosts(4096);
    const GuidedBundles bundles(costs, ranks);
    std::vector<int> seen(costs.size());
    for (std::uint32_t node = 0; node < bundles.Nodes(); ++node) {
      std::uint64_t before = 1000;
      for (std::uint32_t number = 0; number < bundles.Count(node); ++number) {
        const std::vector<std::uint32_t> tiles = bundles.TilesOf({node, number});
        EXPECT_FALSE(tiles.empty());
        for (const std::uint32_t tile : tiles) {
          ++seen.at(tile);
          EXPECT_LE(costs[tile], before);
          before = costs[tile];
        }
      }
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
  }
}

TEST(Guided, NoBundleIsMoreThanItsShareOfWhatIsLeft) {
  constexpr int kRanks = 5;
  const std::vector<std::uint64_t> costs = SomeCosts(4096);
  const GuidedBundles bundles(costs, {kRanks});
  std::uint64_t left = std::accumulate(costs.begin(), costs.end(), std::uint64_t{0});
  for (std::uint32_t number = 0; number < bundles.Count(0); ++number) {
    const std::vector<std::uint32_t> tiles = bundles.TilesOf({0, number});
    const std::uint64_t cost = CostOf(tiles, costs);
    EXPECT_TRUE(tiles.size() == 1 || cost <= left / kRanks);
    left -= cost;
  }
  EXPECT_EQ(left, 0U);
}

TEST(Guided, NodesGetWorkInProportionToTheirRanks) {
  const std::vector<std::uint64_t> costs = SomeCosts(4096);
  const std::vector<int> ranks{6, 3, 1};
  const GuidedBundles bundles(costs, ranks);
  const double all =
      static_cast<double>(std::accumulate(costs.begin(), costs.end(), std::uint64_t{0}));
  for (std::uint32_t node = 0; node < 3; ++node) {
    std::uint64_t own = 0;
    for (std::uint32_t number = 0; number < bundles.Count(node); ++number)
      own += CostOf(bundles.TilesOf({node, number}), costs);
    EXPECT_NEAR(static_cast<double>(own), all * ranks[node] / 10, 1000);
  }
}

// What makes the picture's end even: with the costs as foretold, greedy ranks finish together.
TEST(Guided, RanksThatHelpThemselvesFinishTogether) {
  for (const std::size_t ranks : {2U, 8U, 64U}) {
    std::vector<std::uint64_t> costs = SomeCosts(4096);
    costs[17] = 20000;  // one dear tile
    const GuidedBundles bundles(costs, {static_cast<int>(ranks)});
    std::vector<std::uint64_t> busy(ranks);
    for (std::uint32_t number = 0; number < bundles.Count(0); ++number)
      *std::ranges::min_element(busy) += CostOf(bundles.TilesOf({0, number}), costs);
    const auto [least, most] = std::ranges::minmax(busy);
    EXPECT_LE(most - least, 20U) << ranks;
  }
}

}  // namespace
}  // namespace stipple::raytracer
