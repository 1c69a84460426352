// SPDX-License-Identifier: MIT
// Objects of a divided scene that several ranks hold, and tests that are done again because of
// them.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_COPIES_H
#define STIPPLE_RAYTRACER_GEOMETRY_COPIES_H

#include <array>
#include <cstdint>
#include <vector>

#include "raytracer/geometry/model.h"

namespace stipple::raytracer {

/// Leaves as bits; of more than 64 leaves those that are 64 apart have one.
using LeafBits = std::uint64_t;
inline LeafBits BitOf(std::uint32_t leaf) { return LeafBits{1} << leaf % 64; }

/// The leaves that each of a model's objects lies in: whoever holds one of them has a copy.
class Copies {
 public:
  /// `leaves`: of each object, by its number in the model; 0 if nobody else has it.
  template <class Real>
  Copies(const Model<Real>& model, const std::vector<LeafBits>& leaves) {
    for (std::size_t kind = 0; kind < kShapeKinds; ++kind) {
      for (std::uint32_t slot = 0; slot < model.numbers[kind].size(); ++slot) {
        const std::uint32_t number = model.numbers[kind][slot];
        if (number == kNoObject || leaves[number] == 0) continue;
        leaves_[kind].resize(model.numbers[kind].size());
        leaves_[kind][slot] = leaves[number];
      }
    }
  }
  Copies() = default;

  /// How many of the objects from `slot` on lie in one of these leaves.
  std::uint64_t CountIn(LeafBits leaves, ShapeKind kind, std::uint32_t slot,
                        std::uint32_t objects) const {
    const std::vector<LeafBits>& of_kind = leaves_[static_cast<std::size_t>(kind)];
    if (of_kind.empty()) return 0;
    std::uint64_t count = 0;
    for (std::uint32_t i = 0; i < objects; ++i) count += (of_kind[slot + i] & leaves) != 0 ? 1U : 0;
    return count;
  }

 private:
  std::array<std::vector<LeafBits>, kShapeKinds> leaves_;  // by kind and slot
};

/// For a ray that other ranks have looked at.
struct Repeats {
  const Copies& copies;
  LeafBits seen;            // the leaves that they hold
  std::uint64_t tests = 0;  // of objects that lie in them
};

}  // namespace stipple::raytracer

#endif
