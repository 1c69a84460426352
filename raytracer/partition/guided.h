// SPDX-License-Identifier: MIT
// Bundles for ranks that help themselves: dear ones first, so that what is left to the end is
// small. Pure functions of sizes and costs: every rank computes the same bundles, and only their
// numbers have to be handed out.
//
// The raster is cut into square tiles; the ray through each tile's middle point, traced beforehand,
// says what the tile costs (the pilot). Tiles in decreasing order of cost are dealt to the nodes
// and bundled: each bundle is a share of what is left when it is taken, so bundles shrink towards
// the end. Source: C. Polychronopoulos, D. Kuck, "Guided Self-Scheduling", IEEE Transactions on
// Computers C-36(12), 1987.
#ifndef STIPPLE_RAYTRACER_PARTITION_GUIDED_H
#define STIPPLE_RAYTRACER_PARTITION_GUIDED_H

#include <cstdint>
#include <vector>

#include "raytracer/partition/ray_partition.h"

namespace stipple::raytracer {

/// The raster in squares, row by row; those at the right and the lower edge may be smaller.
class Tiles {
 public:
  explicit Tiles(ImageSize raster);

  std::uint32_t count() const { return across_ * down_; }
  /// Row by row.
  std::vector<RasterPoint> Points(std::uint32_t tile) const;
  std::size_t Size(std::uint32_t tile) const;
  /// The point whose cost stands for the tile's.
  RasterPoint Middle(std::uint32_t tile) const;

 private:
  Tile TileAt(std::uint32_t tile) const;

  ImageSize raster_;
  int edge_;
  std::uint32_t across_, down_;
};

/// Whom a bundle was meant for, and which of that node's it is.
struct GuidedBundle {
  std::uint32_t node = 0, number = 0;
};

class GuidedBundles {
 public:
  /// `costs`: of each tile, in any unit; a tile that costs nothing is still traced.
  /// `ranks_of_node`: how many ranks each node has.
  GuidedBundles(const std::vector<std::uint64_t>& costs, const std::vector<int>& ranks_of_node);

  std::uint32_t Count(std::uint32_t node) const {
    return static_cast<std::uint32_t>(nodes_[node].ends.size());
  }
  /// Of each node.
  std::vector<std::uint32_t> Counts() const;
  std::uint32_t Nodes() const { return static_cast<std::uint32_t>(nodes_.size()); }
  /// In the order in which they are to be traced.
  std::vector<std::uint32_t> TilesOf(GuidedBundle bundle) const;

 private:
  struct Share {
    std::vector<std::uint32_t> tiles;
    std::vector<std::size_t> ends;  // of bundles, in `tiles`
  };
  std::vector<Share> nodes_;
};

}  // namespace stipple::raytracer

#endif
