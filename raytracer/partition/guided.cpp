// SPDX-License-Identifier: MIT
#include "raytracer/partition/guided.h"

#include <algorithm>
#include <numeric>

namespace stipple::raytracer {
namespace {

// A pilot of about 64 x 64 rays; of a small picture at most every sixteenth.
constexpr int kTilesAcross = 64;
constexpr int kSmallestEdge = 4;

// A bundle is this part of what one rank would still have to do: small enough that a tile dearer
// than the pilot said cannot make its rank the last.
constexpr std::uint64_t kBundlesPerRankLeft = 4;

std::uint32_t Pieces(int length, int edge) {
  return static_cast<std::uint32_t>((length + edge - 1) / edge);
}

/// Tiles by number, the dearest first.
std::vector<std::uint32_t> ByCost(const std::vector<std::uint64_t>& costs) {
  std::vector<std::uint32_t> tiles(costs.size());
  std::iota(tiles.begin(), tiles.end(), 0U);
  std::ranges::stable_sort(tiles, std::ranges::greater(),
                           [&](std::uint32_t tile) { return costs[tile]; });
  return tiles;
}

}  // namespace

Tiles::Tiles(ImageSize raster)
    : raster_(raster),
      edge_(std::max(kSmallestEdge, std::max(raster.width, raster.height) / kTilesAcross)),
      across_(Pieces(raster.width, edge_)),
      down_(Pieces(raster.height, edge_)) {}

Tile Tiles::TileAt(std::uint32_t tile) const {
  const int x = static_cast<int>(tile % across_) * edge_,
            y = static_cast<int>(tile / across_) * edge_;
  return {x, std::min(x + edge_, raster_.width), y, std::min(y + edge_, raster_.height)};
}

std::vector<RasterPoint> Tiles::Points(std::uint32_t tile) const {
  return PointsIn(TileAt(tile), raster_);
}

std::size_t Tiles::Size(std::uint32_t tile) const {
  const Tile at = TileAt(tile);
  return static_cast<std::size_t>(at.x_end - at.x_begin) *
         static_cast<std::size_t>(at.y_end - at.y_begin);
}

RasterPoint Tiles::Middle(std::uint32_t tile) const {
  const Tile at = TileAt(tile);
  return static_cast<RasterPoint>((at.y_begin + at.y_end) / 2 * raster_.width +
                                  (at.x_begin + at.x_end) / 2);
}

GuidedBundles::GuidedBundles(const std::vector<std::uint64_t>& costs,
                             const std::vector<int>& ranks_of_node)
    : nodes_(ranks_of_node.size()) {
  const auto cost = [&](std::uint32_t tile) { return std::max<std::uint64_t>(costs[tile], 1); };
  // Each tile goes to the node whose ranks have least to do so far.
  std::vector<std::uint64_t> given(nodes_.size());
  for (const std::uint32_t tile : ByCost(costs)) {
    std::size_t least = 0;
    for (std::size_t node = 1; node < nodes_.size(); ++node)
      if (given[node] * static_cast<std::uint64_t>(ranks_of_node[least]) <
          given[least] * static_cast<std::uint64_t>(ranks_of_node[node]))
        least = node;
    nodes_[least].tiles.push_back(tile);
    given[least] += cost(tile);
  }
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    Share& share = nodes_[node];
    std::uint64_t left = given[node];
    for (std::size_t next = 0; next < share.tiles.size();) {
      const std::uint64_t wanted =
          left / (kBundlesPerRankLeft * static_cast<std::uint64_t>(ranks_of_node[node]));
      std::uint64_t taken = 0;
      do taken += cost(share.tiles[next++]);
      while (next < share.tiles.size() && taken + cost(share.tiles[next]) <= wanted);
      left -= taken;
      share.ends.push_back(next);
    }
  }
}

std::vector<std::uint32_t> GuidedBundles::Counts() const {
  std::vector<std::uint32_t> counts;
  for (std::uint32_t node = 0; node < Nodes(); ++node) counts.push_back(Count(node));
  return counts;
}

std::vector<std::uint32_t> GuidedBundles::TilesOf(GuidedBundle bundle) const {
  const Share& share = nodes_[bundle.node];
  const std::size_t begin = bundle.number == 0 ? 0 : share.ends[bundle.number - 1];
  return {share.tiles.begin() + static_cast<std::ptrdiff_t>(begin),
          share.tiles.begin() + static_cast<std::ptrdiff_t>(share.ends[bundle.number])};
}

}  // namespace stipple::raytracer
