// SPDX-License-Identifier: MIT
// A scene's objects made ready for tracing: shapes in the kernel's kind of number and the bounding
// hierarchy over them, in flat arrays that are written once and then only read. So one copy can
// serve all ranks of a node, and can be stored as it is.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_MODEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_MODEL_H

#include <cstdint>

#include "raytracer/geometry/array.h"
#include "raytracer/geometry/bounds.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Inner node: `count` is 0, its children stand at `first` and `first + 1`. Leaf: `count` entries
/// from `first`.
struct BvhNode {
  Bounds bounds;
  std::uint32_t first;
  std::uint32_t count;
};

/// One object in a leaf; what the traversal needs to find it without a detour over Model::objects.
struct BvhEntry {
  ShapeKind kind;
  std::uint32_t index;
  std::uint32_t object;
};

/// Nodes on the longest path of any tree that BuildModel makes; the traversal's stack relies on it.
inline constexpr int kMaxBvhDepth = 112;

template <class Real>
struct Model {
  Array<Object> objects;  // by object number; `index` is into the arrays below
  Array<Sphere<Real>> spheres;
  Array<Cone<Real>> cones;
  Array<Triangle<Real>> triangles;
  Array<Polygon<Real>> polygons;
  Array<Patch<Real>> patches;
  Array<Vec<Real>> vertices;
  Array<OutlinePoint<Real>> outlines;
  Array<Vec<Real>> normals;
  Array<BvhNode> nodes;  // nodes[0] is the root; empty for a scene without objects
  Array<BvhEntry> entries;

  /// Calls visit(array) for each array, always in the same order: who copies, shares or stores a
  /// model needs to know no more of it.
  template <class Visit>
  void ForEachArray(Visit visit) {
    visit(objects);
    visit(spheres);
    visit(cones);
    visit(triangles);
    visit(polygons);
    visit(patches);
    visit(vertices);
    visit(outlines);
    visit(normals);
    visit(nodes);
    visit(entries);
  }
};

/// Who brings the hierarchy: the model, or a kernel that makes its own.
enum class Hierarchy { kOfModel, kOfKernel };

/// Builds the hierarchy (none if the kernel makes its own) and lays the shapes out in the order of its leaves; object numbers stay.
/// `shapes` is used up, so that a large scene is not in memory twice.
///
/// Binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007); the same objects in the same order give the same model on every machine.
template <class Real>
Model<Real> BuildModel(Shapes&& shapes, Hierarchy hierarchy = Hierarchy::kOfModel);

}  // namespace stipple::raytracer

#endif
