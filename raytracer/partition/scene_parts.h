// SPDX-License-Identifier: MIT
// A divided scene, as one rank has it: the tree's body, and the objects of the leaves that it
// holds.
#ifndef STIPPLE_RAYTRACER_PARTITION_SCENE_PARTS_H
#define STIPPLE_RAYTRACER_PARTITION_SCENE_PARTS_H

#include <array>
#include <cstdint>
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

/// All objects that a rank holds, each once, ready for rays; without a kernel if it holds none.
template <class Real>
struct HeldPart {
  Model<Real> model;
  std::vector<std::uint32_t> numbers;  // in the scene, by number in the model; ascending
  Copies copies;                       // that others may have
  std::unique_ptr<Kernel<Real>> kernel;
};

/// What lies in a leaf.
struct LeafObjects {
  std::uint64_t bytes = 0;  // that it takes until it is ready for rays, at most
  std::array<std::uint64_t, kShapeKinds> count{};
  std::uint64_t corners = 0;  // of polygons
  std::uint64_t normals = 0;  // at corners
};

/// By leaf.
std::vector<std::uint64_t> BytesOf(const std::vector<LeafObjects>& leaves);

template <class Real>
struct SceneParts {
  Scene scene;           // without shapes
  SceneObjects objects;  // of the whole scene, on their way
  ObjectTree tree;
  std::vector<LeafObjects> leaves;
  Holding holding;
  std::unique_ptr<HeldPart<Real>> here;
  std::uint64_t most_bytes = 0;                    // that a rank may hold of a coupled scene
  Real rounding = 0;                               // of distances that kernels find
  std::array<std::uint64_t, kShapeKinds> count{};  // objects of the whole scene, by kind
  std::uint64_t copies =
      0;  // objects in all leaves together; more than `objects`, as some lie in several
  std::uint64_t model_bytes = 0;  // of what this rank holds
  double load_s = 0, build_s = 0, build_cpu_s = 0;
};

/// What is held by whom.
struct Division {
  int holders = 1;       // ranks 0 to holders - 1 hold objects
  double replicate = 0;  // share of the leaves that each holds; 0: one leaf each
  bool fill = false;     // instead: as many leaves each as fit into memory
  bool coupled = false;  // several leaves for each rank; Hold will change who holds which
};

/// The chosen scene, divided. Every rank calls it. Errors: StoppedTogether.
template <class Real>
SceneParts<Real> PartsForAll(const World& world, const SceneChoice& choice,
                             const std::string& kernel, Division division);

/// Another division of a coupled scene's leaves: every rank lets go of what it holds, reads the
/// scene again and builds what it is to hold. Errors: StoppedTogether.
template <class Real>
void Hold(const World& world, Holding holding, const std::string& kernel, SceneParts<Real>& parts);

}  // namespace stipple::raytracer

#endif
