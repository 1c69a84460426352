// SPDX-License-Identifier: MIT
#include "raytracer/partition/ray_partition.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "raytracer/partition/find_row.h"

namespace stipple::raytracer {
namespace {

/// Where part `part` of `parts` begins among `count` things.
int Begin(int count, int part, int parts) {
  return static_cast<int>(static_cast<long>(count) * part / parts);
}

/// SplitMix64 (Steele, Lea, Flood, 2014): the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// A number below `limit`; the bias of the scaling is below limit / 2^64.
  std::uint32_t Below(std::uint32_t limit) {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    z ^= z >> 31;
    return static_cast<std::uint32_t>(((z >> 32) * limit) >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::vector<RasterPoint> PointsIn(const Tile& tile, ImageSize raster) {
  std::vector<RasterPoint> points;
  for (int y = tile.y_begin; y < tile.y_end; ++y)
    for (int x = tile.x_begin; x < tile.x_end; ++x)
      points.push_back(static_cast<RasterPoint>(y) * static_cast<RasterPoint>(raster.width) +
                       static_cast<RasterPoint>(x));
  return points;
}

Tile RowsTile(ImageSize raster, int rank, int rank_count) {
  return {0, raster.width, Begin(raster.height, rank, rank_count),
          Begin(raster.height, rank + 1, rank_count)};
}

Tile ColumnsTile(ImageSize raster, int rank, int rank_count) {
  return {Begin(raster.width, rank, rank_count), Begin(raster.width, rank + 1, rank_count), 0,
          raster.height};
}

Tile BlocksTile(ImageSize raster, int rank, int rank_count) {
  // The factorisation whose blocks have the shortest border.
  int across = 1;
  double shortest = 0;
  for (int columns = 1; columns <= rank_count; ++columns) {
    if (rank_count % columns != 0) continue;
    const double border = static_cast<double>(raster.width) / columns +
                          static_cast<double>(raster.height) * columns / rank_count;
    if (columns == 1 || border < shortest) {
      shortest = border;
      across = columns;
    }
  }
  const int down = rank_count / across;
  const int column = rank % across, row = rank / across;
  return {Begin(raster.width, column, across), Begin(raster.width, column + 1, across),
          Begin(raster.height, row, down), Begin(raster.height, row + 1, down)};
}

std::vector<RasterPoint> TiledPoints(const PartitionChoice& choice, int rank, int rank_count) {
  const Tile tile = FindRow(kTiles, choice.tile).tile(choice.raster, rank, rank_count);
  return PointsIn(tile, choice.raster);
}

std::vector<RasterPoint> ScatteredPoints(const PartitionChoice& choice, int rank, int rank_count) {
  std::vector<RasterPoint> points;
  for (int y = rank; y < choice.raster.height; y += rank_count) {
    const std::vector<RasterPoint> row =
        PointsIn({0, choice.raster.width, y, y + 1}, choice.raster);
    points.insert(points.end(), row.begin(), row.end());
  }
  return points;
}

std::vector<RasterPoint> BundledPoints(const PartitionChoice& choice, int rank, int rank_count) {
  const Bundles bundles(choice);
  std::vector<RasterPoint> points;
  for (auto bundle = static_cast<std::uint32_t>(rank); bundle < bundles.count();
       bundle += static_cast<std::uint32_t>(rank_count)) {
    const std::vector<RasterPoint> some = bundles.Points(bundle);
    points.insert(points.end(), some.begin(), some.end());
  }
  return points;
}

std::vector<RasterPoint> ShuffledPoints(const PartitionChoice& choice) {
  std::vector<RasterPoint> points(PointCount(choice.raster));
  std::iota(points.begin(), points.end(), RasterPoint{0});
  Random random(choice.seed);
  for (auto left = static_cast<std::uint32_t>(points.size()); left > 1; --left)
    std::swap(points[left - 1], points[random.Below(left)]);
  return points;
}

Bundles::Bundles(const PartitionChoice& choice)
    : point_count_(PointCount(choice.raster)),
      bundle_points_(std::min(choice.bundle, point_count_)),
      count_((point_count_ - 1) / bundle_points_ + 1),
      unit_(1) {
  const auto width = static_cast<std::uint32_t>(choice.raster.width);
  if (bundle_points_ % width == 0) unit_ = width;
  const SelectionEntry& selection = FindRow(kSelections, choice.select);
  strided_ = selection.strided;
  if (selection.order != nullptr) order_ = selection.order(choice);
}

std::vector<RasterPoint> Bundles::Points(std::uint32_t bundle) const {
  std::vector<RasterPoint> points;
  points.reserve(bundle_points_);
  const auto take = [&](std::uint64_t position) {
    const auto point = static_cast<RasterPoint>(position);
    points.push_back(order_.empty() ? point : order_[point]);
  };
  if (strided_) {
    const std::uint64_t stride = std::uint64_t{count_} * unit_;
    for (std::uint64_t unit = std::uint64_t{bundle} * unit_; unit < point_count_; unit += stride)
      for (std::uint64_t i = 0; i < unit_; ++i) take(unit + i);
  } else {
    const std::uint64_t begin = std::uint64_t{bundle} * bundle_points_;
    const std::uint64_t end = std::min<std::uint64_t>(begin + bundle_points_, point_count_);
    for (std::uint64_t position = begin; position < end; ++position) take(position);
  }
  return points;
}

}  // namespace stipple::raytracer
