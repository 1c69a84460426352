// SPDX-License-Identifier: MIT
// Which rank traces which ray. Pure functions of sizes and names: every rank computes its own
// answer and no message is needed to agree.
//
// The raster is what a partition divides: one point per pixel, or per pixel corner when rays go
// through corners. A point is numbered row by row from the upper left.
#ifndef STIPPLE_RAYTRACER_PARTITION_RAY_PARTITION_H
#define STIPPLE_RAYTRACER_PARTITION_RAY_PARTITION_H

#include <cstdint>
#include <string_view>
#include <vector>

#include "raytracer/scene/view.h"

namespace stipple::raytracer {

using RasterPoint = std::uint32_t;

inline RasterPoint PointCount(ImageSize raster) {
  return static_cast<RasterPoint>(raster.width) * static_cast<RasterPoint>(raster.height);
}

/// What the user chose; each partition reads what concerns it.
struct PartitionChoice {
  ImageSize raster;
  std::string_view tile = "rows";
  std::uint32_t bundle = 512;  // points in a bundle; the last one may have fewer
  std::string_view select = "contiguous";
  std::uint64_t seed = 1;
};

/// Contiguous rows, columns or blocks, one tile per rank. Blocks: as square as the rank count's
/// factors allow.
std::vector<RasterPoint> TiledPoints(const PartitionChoice& choice, int rank, int rank_count);
/// Row i belongs to rank i mod rank_count.
std::vector<RasterPoint> ScatteredPoints(const PartitionChoice& choice, int rank, int rank_count);
/// Bundle i belongs to rank i mod rank_count; on more than one rank a host hands bundles out on
/// demand instead.
std::vector<RasterPoint> BundledPoints(const PartitionChoice& choice, int rank, int rank_count);

/// Over all ranks each point of the raster appears exactly once.
using RayPartition = std::vector<RasterPoint> (*)(const PartitionChoice& choice, int rank,
                                                  int rank_count);
/// How a rank, if it is not alone, comes by its points.
enum class Supply {
  kBeforehand,  // it computes them
  kHost,        // the last world rank hands them out and traces nothing
  kCounter      // it takes them itself, by counting up (guided.h)
};
struct RayPartitionEntry {
  std::string_view name;
  RayPartition points;  // of kHost and kCounter those of a rank that is alone
  Supply supply;
};
inline constexpr RayPartitionEntry kRayPartitions[] = {
    {"tiled", TiledPoints, Supply::kBeforehand},
    {"scattered", ScatteredPoints, Supply::kBeforehand},
    {"bundles", BundledPoints, Supply::kHost},
    {"guided", ScatteredPoints, Supply::kCounter}};

/// The shape of a tile: the part of a raster that belongs to `rank`.
struct Tile {
  int x_begin, x_end, y_begin, y_end;
};
struct TileEntry {
  std::string_view name;
  Tile (*tile)(ImageSize raster, int rank, int rank_count);
};
Tile RowsTile(ImageSize raster, int rank, int rank_count);
Tile ColumnsTile(ImageSize raster, int rank, int rank_count);
Tile BlocksTile(ImageSize raster, int rank, int rank_count);
inline constexpr TileEntry kTiles[] = {
    {"rows", RowsTile}, {"columns", ColumnsTile}, {"blocks", BlocksTile}};
/// Row by row.
std::vector<RasterPoint> PointsIn(const Tile& tile, ImageSize raster);

/// How the points of bundles are chosen; row of the table by name.
struct SelectionEntry {
  std::string_view name;
  /// The order in which bundles take points; null: as they are numbered.
  std::vector<RasterPoint> (*order)(const PartitionChoice& choice);
  bool strided;  // bundle b of B takes every B-th unit instead of the next ones
};
std::vector<RasterPoint> ShuffledPoints(const PartitionChoice& choice);
inline constexpr SelectionEntry kSelections[] = {
    {"contiguous", nullptr, false}, {"modulo", nullptr, true}, {"random", ShuffledPoints, false}};

/// The bundles of a picture, by number.
///
/// `contiguous` takes the next points in the raster's order; `modulo` takes, of B bundles, every
/// B-th point, or every B-th row if a bundle is a whole number of rows (so that as many bundles as
/// ranks are the scattered partition); `random` takes the next points of a shuffled raster.
class Bundles {
 public:
  explicit Bundles(const PartitionChoice& choice);

  std::uint32_t count() const { return count_; }
  std::vector<RasterPoint> Points(std::uint32_t bundle) const;

 private:
  std::uint32_t point_count_;
  std::uint32_t bundle_points_;
  std::uint32_t count_;
  std::uint32_t unit_;  // points that stay together when strided
  bool strided_;
  std::vector<RasterPoint> order_;
};

}  // namespace stipple::raytracer

#endif
