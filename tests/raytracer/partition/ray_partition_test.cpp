// SPDX-License-Identifier: MIT
#include "raytracer/partition/ray_partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace stipple::raytracer {
namespace {

bool CoversOnce(const PartitionChoice& choice, RayPartition partition, int rank_count) {
  std::vector<int> seen(PointCount(choice.raster));
  for (int rank = 0; rank < rank_count; ++rank)
    for (const RasterPoint point : partition(choice, rank, rank_count)) ++seen.at(point);
  return std::ranges::all_of(seen, [](int times) { return times == 1; });
}

TEST(RayPartition, EveryPointIsTracedExactlyOnce) {
  for (const RayPartitionEntry& partition : kRayPartitions)
    for (const TileEntry& tile : kTiles)
      for (const SelectionEntry& selection : kSelections)
        for (const std::uint32_t bundle : {1U, 7U, 13U, 26U, 1000U})
          for (const ImageSize raster : {ImageSize{13, 11}, ImageSize{1, 5}, ImageSize{64, 1}})
            for (const int rank_count : {1, 2, 3, 7, 64}) {
              const PartitionChoice choice{raster, tile.name, bundle, selection.name, 5};
              EXPECT_TRUE(CoversOnce(choice, partition.points, rank_count))
                  << partition.name << ' ' << tile.name << ' ' << selection.name << ' ' << bundle
                  << ' ' << rank_count;
            }
}

TEST(RayPartition, NoBundleIsLargerThanAskedFor) {
  for (const SelectionEntry& selection : kSelections)
    for (const std::uint32_t size : {1U, 7U, 13U, 26U, 1000U}) {
      const Bundles bundles({{13, 11}, "rows", size, selection.name, 5});
      for (std::uint32_t bundle = 0; bundle < bundles.count(); ++bundle) {
        EXPECT_LE(bundles.Points(bundle).size(), size);
        EXPECT_GE(bundles.Points(bundle).size(), 1U);
      }
    }
}

// The continuum of the study: as many bundles as ranks are the static partitions.
TEST(RayPartition, AsManyContiguousBundlesAsRanksAreTheTiledPartition) {
  const PartitionChoice choice{{32, 64}, "rows", 32 * 64 / 8, "contiguous", 1};
  for (int rank = 0; rank < 8; ++rank)
    EXPECT_EQ(BundledPoints(choice, rank, 8), TiledPoints(choice, rank, 8));
}

TEST(RayPartition, AsManyModuloBundlesAsRanksAreTheScatteredPartition) {
  const PartitionChoice choice{{32, 64}, "rows", 32 * 64 / 8, "modulo", 1};
  for (int rank = 0; rank < 8; ++rank)
    EXPECT_EQ(BundledPoints(choice, rank, 8), ScatteredPoints(choice, rank, 8));
}

TEST(RayPartition, ModuloBundlesOfPartRowsTakeEveryBthPoint) {
  const Bundles bundles({{10, 10}, "rows", 5, "modulo", 1});
  EXPECT_EQ(bundles.Points(3), (std::vector<RasterPoint>{3, 23, 43, 63, 83}));
}

TEST(RayPartition, TheSeedDecidesARandomSelection) {
  const auto points = [](std::uint64_t seed) {
    return Bundles({{20, 20}, "rows", 50, "random", seed}).Points(0);
  };
  EXPECT_EQ(points(1), points(1));
  EXPECT_NE(points(1), points(2));
  EXPECT_FALSE(std::ranges::is_sorted(points(1)));
}

TEST(RayPartition, BlocksAreAsSquareAsTheRankCountAllows) {
  const Tile tile = BlocksTile({512, 512}, 0, 16);
  EXPECT_EQ(tile.x_end - tile.x_begin, 128);
  EXPECT_EQ(tile.y_end - tile.y_begin, 128);
}

}  // namespace
}  // namespace stipple::raytracer
