// SPDX-License-Identifier: MIT
// A scene with its model as one block of bytes: what the ranks of a node share and what the cache
// keeps. A header holds what is small and says where each part lies; parts are arrays of plain
// elements, each aligned to a cache line, and are used where they lie.
#ifndef STIPPLE_RAYTRACER_SCENE_PACKED_SCENE_H
#define STIPPLE_RAYTRACER_SCENE_PACKED_SCENE_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raytracer/geometry/model.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// A scene whose shapes are in the model.
template <class Real>
struct BuiltScene {
  Scene scene;
  Model<Real> model;
};

struct PackedHeader {
  static constexpr std::size_t kMostParts = 32;
  struct Part {
    std::uint64_t offset = 0;  // in the block, a multiple of 64
    std::uint64_t bytes = 0;
  };

  std::uint64_t magic = 0;   // also tells the byte order
  std::uint64_t layout = 0;  // LayoutOf
  std::uint64_t key = 0;     // in the cache: what the block was made of
  std::uint64_t hash = 0;    // in the cache: of the block with a 0 here
  std::uint64_t bytes = 0;   // of the block, this header included
  std::uint64_t part_count = 0;
  Vec3 background;
  View view;
  Part parts[kMostParts];
};

/// Where the first part begins.
inline constexpr std::size_t kHeaderBytes = (sizeof(PackedHeader) + 63) / 64 * 64;

/// Names the layout of a block: the size of every element, the kind of number, and the sources that
/// give the elements their meaning.
template <class Real>
std::uint64_t LayoutOf();

/// The bytes of each part, in their order in the block.
template <class Real>
std::vector<std::span<const std::byte>> PartsOf(BuiltScene<Real>& built);

template <class Real>
PackedHeader HeaderOf(BuiltScene<Real>& built);

/// Moves `built` into a block of HeaderOf(built).bytes: each array is copied, freed and looked at
/// in its new place, so that only one at a time is in memory twice. The block must outlive it.
template <class Real>
void PackInto(std::byte* block, BuiltScene<Real>& built);

/// A view into a block, which must outlive it; nothing if the header does not fit the block or this
/// program. Only the header is looked at.
template <class Real>
std::optional<BuiltScene<Real>> Unpack(std::span<const std::byte> block);

}  // namespace stipple::raytracer

#endif
