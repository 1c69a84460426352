// SPDX-License-Identifier: MIT
// A scene's objects made ready for tracing: shapes in the kernel's kind of number and the bounding
// hierarchy over them, in flat arrays that are written once and then only read. So one copy can
// serve all ranks of a node, and can be stored as it is.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_MODEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_MODEL_H

#include <array>
#include <cstdint>
#include <span>

#include "raytracer/geometry/array.h"
#include "raytracer/geometry/blocks.h"
#include "raytracer/geometry/shapes.h"
#include "raytracer/geometry/wide_node.h"

namespace stipple::raytracer {

/// The number of an object where there is none.
inline constexpr std::uint32_t kNoObject = 0xffffffff;

inline constexpr std::size_t kShapeKinds = 5;

/// Nodes on the longest path of any tree that BuildModel makes; the traversal's stack relies on it.
inline constexpr std::size_t kMaxBvhDepth = 112;

/// Shapes lie in blocks, in the order of the hierarchy's leaves: each leaf begins a block. A
/// shape's slot is its lane among all of its kind. Only patches lie one by one; a patch's slot is
/// its index.
template <class Real>
struct Model {
  Array<Object> objects;  // by object number; `index` is the slot
  Array<SphereBlock<Real>> spheres;
  Array<ConeBlock<Real>> cones;
  Array<TriangleBlock<Real>> triangles;
  Array<PolygonBlock<Real>> polygons;
  Array<Patch<Real>> patches;
  std::array<Array<std::uint32_t>, kShapeKinds> numbers;  // by kind and slot: object or kNoObject
  Array<Vec<Real>> vertices;
  Array<OutlinePoint<Real>> outlines;
  Array<Vec<Real>> normals;
  Array<WideNode> nodes;
  Array<Frame> frame;  // one; none for a scene without objects, or without a hierarchy

  Sphere<Real> SphereAt(std::uint32_t slot) const {
    return spheres[slot / kLanes].At(slot % kLanes);
  }
  Cone<Real> ConeAt(std::uint32_t slot) const { return cones[slot / kLanes].At(slot % kLanes); }
  Triangle<Real> TriangleAt(std::uint32_t slot) const {
    return triangles[slot / kLanes].At(slot % kLanes);
  }
  Polygon<Real> PolygonAt(std::uint32_t slot) const {
    return polygons[slot / kLanes].At(slot % kLanes);
  }
  std::span<const OutlinePoint<Real>> OutlineOf(const Polygon<Real>& polygon) const {
    return {outlines.data() + polygon.first_vertex, polygon.vertex_count};
  }

  /// Calls visit(array) for each array, always in the same order: who copies, shares or stores a
  /// model needs to know no more of it. Each array wants the alignment of its element.
  template <class Visit>
  void ForEachArray(Visit visit) {
    visit(objects);
    visit(spheres);
    visit(cones);
    visit(triangles);
    visit(polygons);
    visit(patches);
    for (Array<std::uint32_t>& of_kind : numbers) visit(of_kind);
    visit(vertices);
    visit(outlines);
    visit(normals);
    visit(nodes);
    visit(frame);
  }
};

/// Who brings the hierarchy: the model, or a kernel that makes its own.
enum class Hierarchy { kOfModel, kOfKernel };

/// Builds the hierarchy (none if the kernel makes its own) and lays the shapes out in the order of
/// its leaves; object numbers stay. `shapes` is used up, so that a large scene is not in memory
/// twice. The same objects in the same order give the same model on every machine.
///
/// Errors: InputError for more objects than links of the hierarchy can count, 2^25 of a kind.
template <class Real>
Model<Real> BuildModel(Shapes&& shapes, Hierarchy hierarchy = Hierarchy::kOfModel);

}  // namespace stipple::raytracer

#endif
