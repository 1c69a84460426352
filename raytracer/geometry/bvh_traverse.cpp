// SPDX-License-Identifier: MIT
// The two questions a ray asks. Both walk the tree with a small stack, the nearer child first;
// boxes that begin behind the best hit so far are skipped.
#include <array>

#include "raytracer/errors.h"
#include "raytracer/geometry/embree_kernel.h"
#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/patch.h"

namespace stipple::raytracer {
namespace {

/// What one walk needs of its ray, prepared once.
template <class Real>
struct Walk {
  const Model<Real>& model;
  const Ray<Real>& ray;
  ShearRay<Real> shear;

  Walk(const Model<Real>& all, const Ray<Real>& with)
      : model(all),
        ray(with),
        shear(all.triangles.empty() ? ShearRay<Real>() : ShearRay<Real>(with)) {}

  /// `max_t`: patches need not be met farther out.
  TriangleHit<Real> Meet(const BvhEntry& entry, Real max_t) const {
    switch (entry.kind) {
      case ShapeKind::kSphere:
        return {IntersectSphere(model.spheres[entry.index], ray), 0, 0};
      case ShapeKind::kCone:
        return {IntersectCone(model.cones[entry.index], ray), 0, 0};
      case ShapeKind::kTriangle:
        return IntersectTriangle(model.triangles[entry.index], shear);
      case ShapeKind::kPolygon: {
        const Polygon<Real>& polygon = model.polygons[entry.index];
        const std::span outline(model.outlines.data() + polygon.first_vertex, polygon.vertex_count);
        return {IntersectPolygon(polygon, outline, ray), 0, 0};
      }
      case ShapeKind::kPatch: {
        const PatchHit<Real> hit = IntersectPatch(model.patches[entry.index], ray, max_t);
        return {hit.t, hit.u, hit.v};
      }
    }
    return {kMiss<Real>, 0, 0};
  }
};

/// Boxes are tested in double, whatever the kernel computes in.
template <class Real>
Ray<double> InDouble(const Ray<Real>& ray) {
  const auto rounded = [](Vec<Real> v) {
    return Vec3{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  };
  return {rounded(ray.origin), rounded(ray.direction)};
}

/// Wider than the roundings of box tests and of intersections in `Real`.
template <class Real>
constexpr double kWiden = 1 +
                          16 * std::max(std::numeric_limits<double>::epsilon(),
                                        static_cast<double>(std::numeric_limits<Real>::epsilon()));

/// A distance for box tests: no box that begins where an object at `t` lies is behind it. (Objects
/// at the same distance are decided by their numbers, so all have to be looked at.)
template <class Real>
double Far(Real t) {
  return static_cast<double>(t) * kWiden<Real>;
}

struct Pending {
  std::uint32_t node;
  double enter;
};

/// Pops until a node is found that begins no later than max_t; false when none is left.
inline bool NextNode(std::array<Pending, kMaxBvhDepth>& stack, int& depth, double max_t,
                     std::uint32_t& node) {
  while (depth > 0) {
    const Pending& top = stack[static_cast<std::size_t>(--depth)];
    if (top.enter <= max_t) {
      node = top.node;
      return true;
    }
  }
  return false;
}

/// Chooses the nearer child and remembers the other; false if the ray meets neither.
template <class Model>
inline bool Descend(const Model& model, const SlabRay& slab, double max_t,
                    std::array<Pending, kMaxBvhDepth>& stack, int& depth, std::uint32_t& node) {
  const std::uint32_t left = model.nodes[node].first;
  const double left_enter = EnterBounds(model.nodes[left].bounds, slab, max_t);
  const double right_enter = EnterBounds(model.nodes[left + 1].bounds, slab, max_t);
  const bool left_first = left_enter <= right_enter;
  const double near_enter = left_first ? left_enter : right_enter;
  const double far_enter = left_first ? right_enter : left_enter;
  if (near_enter == kMiss<double>) return false;
  node = left_first ? left : left + 1;
  if (far_enter != kMiss<double>)
    stack[static_cast<std::size_t>(depth++)] = {left_first ? left + 1 : left, far_enter};
  return true;
}

template <class Real>
class ScalarKernel final : public Kernel<Real> {
 public:
  explicit ScalarKernel(const Model<Real>& model) : model_(model) {}

  [[gnu::noinline]] Hit<Real> Intersect(const Ray<Real>& ray, TestCounts& tests) const override {
    Hit<Real> best;
    if (model_.nodes.empty()) return best;
    const SlabRay slab(InDouble(ray), kWiden<Real>);
    const Walk<Real> walk(model_, ray);
    std::array<Pending, kMaxBvhDepth> stack;
    int depth = 0;
    std::uint32_t node = 0;
    std::uint64_t box_tests = 1, primitive_tests = 0;
    bool more = EnterBounds(model_.nodes[0].bounds, slab, kMiss<double>) != kMiss<double>;
    while (more) {
      if (model_.nodes[node].count == 0) {
        box_tests += 2;
        more = Descend(model_, slab, Far(best.t), stack, depth, node) ||
               NextNode(stack, depth, Far(best.t), node);
        continue;
      }
      const BvhEntry* const entries = model_.entries.data() + model_.nodes[node].first;
      for (std::uint32_t i = 0; i < model_.nodes[node].count; ++i) {
        const TriangleHit<Real> met = walk.Meet(entries[i], best.t);
        if (met.t < best.t ||
            (met.t == best.t && entries[i].object < best.object && met.t != kMiss<Real>))
          best = {met.t, entries[i].object, met.u, met.v};
      }
      primitive_tests += model_.nodes[node].count;
      more = NextNode(stack, depth, Far(best.t), node);
    }
    tests.box_tests += box_tests;
    tests.primitive_tests += primitive_tests;
    return best;
  }

  [[gnu::noinline]] bool Occluded(const Ray<Real>& ray, Real max_t,
                                  TestCounts& tests) const override {
    if (model_.nodes.empty()) return false;
    const SlabRay slab(InDouble(ray), kWiden<Real>);
    const Walk<Real> walk(model_, ray);
    std::array<Pending, kMaxBvhDepth> stack;
    int depth = 0;
    std::uint32_t node = 0;
    std::uint64_t box_tests = 1, primitive_tests = 0;
    bool found = false;
    bool more = EnterBounds(model_.nodes[0].bounds, slab, Far(max_t)) != kMiss<double>;
    while (more && !found) {
      if (model_.nodes[node].count == 0) {
        box_tests += 2;
        more = Descend(model_, slab, Far(max_t), stack, depth, node) ||
               NextNode(stack, depth, Far(max_t), node);
        continue;
      }
      const BvhEntry* const entries = model_.entries.data() + model_.nodes[node].first;
      for (std::uint32_t i = 0; i < model_.nodes[node].count && !found; ++i) {
        found = walk.Meet(entries[i], max_t).t < max_t;
        ++primitive_tests;
      }
      more = NextNode(stack, depth, Far(max_t), node);
    }
    tests.box_tests += box_tests;
    tests.primitive_tests += primitive_tests;
    return found;
  }

 private:
  const Model<Real>& model_;
};

}  // namespace

template <class Real>
std::unique_ptr<Kernel<Real>> MakeKernel(std::string_view name, const Model<Real>& model) {
  if (name == "bvh" || name == "scalar") return std::make_unique<ScalarKernel<Real>>(model);
  if constexpr (!std::is_same_v<Real, long double>)
    if (name == "embree") return MakeEmbreeKernel(model);
  throw UsageError("--kernel " + std::string(name) + ": cannot compute in this kind of number");
}

template std::unique_ptr<Kernel<float>> MakeKernel(std::string_view, const Model<float>&);
template std::unique_ptr<Kernel<double>> MakeKernel(std::string_view, const Model<double>&);
template std::unique_ptr<Kernel<long double>> MakeKernel(std::string_view,
                                                         const Model<long double>&);

}  // namespace stipple::raytracer
