// SPDX-License-Identifier: MIT
// From shapes to a model: boxes are taken into the frame, the hierarchy is built over them, and the
// shapes are laid out in the order of its leaves.
#include <limits>

#include "raytracer/geometry/bvh_build.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/model.h"

namespace stipple::raytracer {
namespace {

/// Bounds for shapes rounded to `Real`: what they gain by that is a few of its roundings.
template <class Real>
Bounds BoundsIn(const Shapes& shapes, const Object& object) {
  Bounds box = BoundsOf(shapes, object);
  if constexpr (std::numeric_limits<Real>::digits < std::numeric_limits<double>::digits) {
    const double slack = 16 * static_cast<double>(std::numeric_limits<Real>::epsilon()) *
                         std::max(MaxNorm(box.low), MaxNorm(box.high));
    box.low = box.low - Vec3{slack, slack, slack};
    box.high = box.high + Vec3{slack, slack, slack};
  }
  return box;
}

Frame FrameOf(const Bounds& box) {
  Frame frame{box, box.low * 0.5 + box.high * 0.5, 1, {}};
  const double extent = MaxNorm(box.high * 0.5 - box.low * 0.5);
  if (extent > 0) frame.scale = std::ldexp(1.0, -std::ilogb(extent) - 1);
  return frame;
}

float RoundedDown(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) > x
             ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
             : rounded;
}

BoxedObject Boxed(const Frame& frame, const Bounds& box, std::uint32_t number, ShapeKind kind) {
  const Vec3 low = (box.low - frame.middle) * frame.scale;
  const Vec3 high = (box.high - frame.middle) * frame.scale;
  return {{RoundedDown(low.x), RoundedDown(low.y), RoundedDown(low.z)},
          number,
          {-RoundedDown(-high.x), -RoundedDown(-high.y), -RoundedDown(-high.z)},
          kind};
}

/// Boxes of all objects; `frame` becomes that of all of them.
template <class Real>
std::vector<BoxedObject> BoxObjects(const Shapes& shapes, Frame& frame) {
  Bounds all;
  for (const Object& object : shapes.objects) all.Include(BoundsIn<Real>(shapes, object));
  frame = FrameOf(all);
  std::vector<BoxedObject> boxes;
  boxes.reserve(shapes.objects.size());
  for (std::uint32_t number = 0; number < shapes.objects.size(); ++number) {
    const Object& object = shapes.objects[number];
    boxes.push_back(Boxed(frame, BoundsIn<Real>(shapes, object), number, object.kind));
  }
  return boxes;
}

/// Without a hierarchy: each kind in file order, block by block.
std::array<std::vector<std::uint32_t>, kShapeKinds> NumbersInOrder(
    const std::vector<Object>& objects) {
  std::array<std::vector<std::uint32_t>, kShapeKinds> numbers;
  for (std::uint32_t number = 0; number < objects.size(); ++number)
    numbers[static_cast<std::size_t>(objects[number].kind)].push_back(number);
  for (const ShapeKind kind :
       {ShapeKind::kSphere, ShapeKind::kCone, ShapeKind::kTriangle, ShapeKind::kPolygon}) {
    auto& of_kind = numbers[static_cast<std::size_t>(kind)];
    while (of_kind.size() % kLanes != 0) of_kind.push_back(kNoObject);
  }
  return numbers;
}

// Shapes that nothing hits, for lanes without an object.

template <class Real>
constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

template <class Real>
Sphere<Real> NoShape(const Sphere<double>&) {
  return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>};
}
template <class Real>
Cone<Real> NoShape(const Cone<double>&) {
  const Vec<Real> nowhere{kNan<Real>, kNan<Real>, kNan<Real>};
  return {nowhere, nowhere, kNan<Real>, kNan<Real>, nowhere, kNan<Real>};
}
template <class Real>
Triangle<Real> NoShape(const Triangle<double>&) {
  constexpr Real n = kNan<Real>;
  return {{{n, n, n}, {n, n, n}, {n, n, n}}, kNoNormals};
}
template <class Real>
Polygon<Real> NoShape(const Polygon<double>&) {
  const Vec<Real> nowhere{kNan<Real>, kNan<Real>, kNan<Real>};
  return {nowhere, kNan<Real>, 0, 0, kNoNormals, 0};
}

/// The shapes of one kind by slot, in blocks; uses `shapes` up and tells the objects.
template <class Real, template <class> class Block, class Shape>
std::vector<Block<Real>> InBlocks(std::vector<Shape>& shapes,
                                  const std::vector<std::uint32_t>& numbers,
                                  std::vector<Object>& objects) {
  std::vector<Block<Real>> blocks(numbers.size() / kLanes);
  for (std::uint32_t slot = 0; slot < numbers.size(); ++slot) {
    Block<Real>& block = blocks[slot / kLanes];
    if (numbers[slot] == kNoObject) {
      block.Put(slot % kLanes, NoShape<Real>(Shape()));
      continue;
    }
    Object& object = objects[numbers[slot]];
    block.Put(slot % kLanes, Converted<Real>(shapes[object.index]));
    object.index = slot;
  }
  shapes = {};
  return blocks;
}

/// The same for shapes that are tested one by one.
template <class Real, class Shape>
auto InRow(std::vector<Shape>& shapes, const std::vector<std::uint32_t>& numbers,
           std::vector<Object>& objects) {
  std::vector<decltype(Converted<Real>(shapes[0]))> row;
  row.reserve(numbers.size());
  for (std::uint32_t slot = 0; slot < numbers.size(); ++slot) {
    Object& object = objects[numbers[slot]];
    row.push_back(Converted<Real>(shapes[object.index]));
    object.index = slot;
  }
  shapes = {};
  return row;
}

template <class Real, class From>
auto AllConverted(std::vector<From>& elements) {
  std::vector<decltype(Converted<Real>(elements[0]))> converted;
  converted.reserve(elements.size());
  for (const From& element : elements) converted.push_back(Converted<Real>(element));
  elements = {};
  return converted;
}

}  // namespace

template <class Real>
Model<Real> BuildModel(Shapes&& shapes, Hierarchy hierarchy) {
  Model<Real> model;
  std::array<std::vector<std::uint32_t>, kShapeKinds> numbers;
  if (hierarchy == Hierarchy::kOfModel && !shapes.objects.empty()) {
    Frame frame;
    std::vector<BoxedObject> boxes = BoxObjects<Real>(shapes, frame);
    Hierarchy8 tree = BuildHierarchy(boxes);
    frame.root = tree.root;
    numbers = std::move(tree.numbers);
    model.nodes = std::move(tree.nodes);
    model.frame = std::vector<Frame>{frame};
  } else {
    numbers = NumbersInOrder(shapes.objects);
  }
  const auto of = [&](ShapeKind kind) -> auto& { return numbers[static_cast<std::size_t>(kind)]; };
  std::vector<Object>& objects = shapes.objects;
  model.spheres = InBlocks<Real, SphereBlock>(shapes.spheres, of(ShapeKind::kSphere), objects);
  model.cones = InBlocks<Real, ConeBlock>(shapes.cones, of(ShapeKind::kCone), objects);
  model.triangles =
      InBlocks<Real, TriangleBlock>(shapes.triangles, of(ShapeKind::kTriangle), objects);
  model.polygons = InBlocks<Real, PolygonBlock>(shapes.polygons, of(ShapeKind::kPolygon), objects);
  model.patches = InRow<Real>(shapes.patches, of(ShapeKind::kPatch), objects);
  model.vertices = AllConverted<Real>(shapes.vertices);
  model.outlines = AllConverted<Real>(shapes.outlines);
  model.normals = AllConverted<Real>(shapes.normals);
  model.objects = std::move(shapes.objects);
  for (std::size_t kind = 0; kind < kShapeKinds; ++kind)
    model.numbers[kind] = std::move(numbers[kind]);
  shapes = {};
  return model;
}

template Model<float> BuildModel(Shapes&&, Hierarchy);
template Model<double> BuildModel(Shapes&&, Hierarchy);
template Model<long double> BuildModel(Shapes&&, Hierarchy);

}  // namespace stipple::raytracer
