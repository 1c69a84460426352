// SPDX-License-Identifier: MIT
// A divided scene, as one rank has it: the tree's body, and the objects of the leaves that it
// holds.
#ifndef STIPPLE_RAYTRACER_PARTITION_SCENE_PARTS_H
#define STIPPLE_RAYTRACER_PARTITION_SCENE_PARTS_H

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "raytracer/geometry/copies.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/partition/holding.h"
#include "raytracer/partition/object_tree.h"
#include "raytracer/render/world.h"
#include "raytracer/scene/scene_objects.h"

namespace stipple::raytracer {

/// Objects ready for rays, by one hierarchy: those of one leaf, or of all that a rank holds.
template <class Real>
struct HeldPart {
  Model<Real> model;
  std::vector<std::uint32_t> numbers;  // in the scene, by number in the model; ascending
  Copies copies;                       // those that lie in further leaves
  std::unique_ptr<Kernel<Real>> kernel;
};

/// What lies in a leaf.
struct LeafObjects {
  std::uint64_t bytes = 0;  // that it takes until it is ready for rays, at most
  std::array<std::uint64_t, kShapeKinds> count{};
  std::uint64_t corners = 0;  // of polygons
  std::uint64_t normals = 0;  // at corners
};

template <class Real>
struct SceneParts {
  Scene scene;           // without shapes
  SceneObjects objects;  // of the whole scene, on their way
  ObjectTree tree;
  std::vector<LeafObjects> leaves;
  Holding holding;
  // By leaf; the same for all leaves of this rank, each object once, but while a pilot asks what
  // each leaf costs. Null: others hold it.
  std::vector<std::shared_ptr<HeldPart<Real>>> held;
  Real rounding = 0;                               // of distances that kernels find
  std::array<std::uint64_t, kShapeKinds> count{};  // objects of the whole scene, by kind
  std::uint64_t copies =
      0;  // objects in all leaves together; more than `objects`, as some lie in several
  std::uint64_t model_bytes = 0;  // of what this rank holds
  double load_s = 0, build_s = 0, build_cpu_s = 0;

  bool HoldsAllAsOne() const {
    return held.front() && std::ranges::adjacent_find(held, std::not_equal_to()) == held.end();
  }
};

/// What is held by whom.
struct Division {
  int holders = 1;       // ranks 0 to holders - 1 hold objects
  double replicate = 0;  // share of the leaves that each holds; 0: one leaf each
  bool fill = false;     // instead: as many leaves each as fit into memory
  bool coupled = false;  // several leaves for each rank, each by itself; Hold will change that
};

/// The chosen scene, divided. Every rank calls it. Errors: StoppedTogether.
template <class Real>
SceneParts<Real> PartsForAll(const World& world, const SceneChoice& choice,
                             const std::string& kernel, Division division);

/// What each leaf of a scene takes; its work is 0.
template <class Real>
std::vector<LeafLoad> LoadsOf(const SceneParts<Real>& parts);

/// Bytes that each rank may take for objects. Every rank calls it.
std::uint64_t AllowedBytes(const World& world, const SceneChoice& choice);

/// Another division of a coupled scene's leaves: every rank lets go of what it holds, reads the
/// scene again and builds what it is to hold. Errors: StoppedTogether.
template <class Real>
void Hold(const World& world, Holding holding, const std::string& kernel, SceneParts<Real>& parts);

}  // namespace stipple::raytracer

#endif
