// SPDX-License-Identifier: MIT
// The hierarchy without vector instructions: the meaning of the other kernel, and all that long
// double has.
#include "raytracer/geometry/bvh_kernel.h"
#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/walk_inl.h"

namespace stipple::raytracer {
namespace {

template <class Real>
class ScalarTests {
 public:
  using Number = Real;

  ScalarTests(const Model<Real>& model, const Ray<Real>& ray, const BoxRay& box_ray)
      : model_(model),
        ray_(ray),
        box_ray_(box_ray),
        shear_(model.triangles.empty() ? ShearRay<Real>() : ShearRay<Real>(ray)) {}

  /// One bit for each child whose box the ray meets at `enter`, not behind `limit`.
  unsigned Boxes(const WideNode& node, float limit, float (&enter)[kMaxChildren]) const {
    unsigned met = 0;
    for (unsigned child = 0; child < kMaxChildren; ++child) {
      float begin = kEarliest, end = limit;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float near_side = node.side[box_ray_.near_side[axis] + child];
        const float far_side = node.side[box_ray_.far_side[axis] + child];
        begin =
            std::max(begin, (near_side - box_ray_.near_origin[axis]) * box_ray_.near_inverse[axis]);
        end = std::min(end, (far_side - box_ray_.far_origin[axis]) * box_ray_.far_inverse[axis]);
      }
      enter[child] = begin;
      met |= begin <= end ? 1U << child : 0U;
    }
    return met;
  }

  void NearestInBlock(ShapeKind kind, std::uint32_t block, const std::uint32_t* numbers,
                      Hit<Real>& best) const {
    for (std::uint32_t slot = block * kLanes; slot < (block + 1) * kLanes; ++slot)
      if (numbers[slot] != kNoObject) HWY_NAMESPACE::Keep(Meet(kind, slot), numbers[slot], best);
  }

  bool AnyInBlock(ShapeKind kind, std::uint32_t block, Real max_t) const {
    for (std::uint32_t slot = block * kLanes; slot < (block + 1) * kLanes; ++slot)
      if (Meet(kind, slot).t < max_t) return true;
    return false;
  }

 private:
  TriangleHit<Real> Meet(ShapeKind kind, std::uint32_t slot) const {
    if (kind == ShapeKind::kSphere) return {IntersectSphere(model_.SphereAt(slot), ray_), 0, 0};
    if (kind == ShapeKind::kCone) return {IntersectCone(model_.ConeAt(slot), ray_), 0, 0};
    if (kind == ShapeKind::kTriangle) return IntersectTriangle(model_.TriangleAt(slot), shear_);
    const Polygon<Real> polygon = model_.PolygonAt(slot);
    return {IntersectPolygon(polygon, model_.OutlineOf(polygon), ray_), 0, 0};
  }

  const Model<Real>& model_;
  const Ray<Real>& ray_;
  const BoxRay& box_ray_;
  ShearRay<Real> shear_;
};

}  // namespace

template <class Real>
std::unique_ptr<Kernel<Real>> MakeScalarKernel(const Model<Real>& model) {
  return std::make_unique<HWY_NAMESPACE::BvhKernel<ScalarTests<Real>>>(model);
}

template std::unique_ptr<Kernel<float>> MakeScalarKernel(const Model<float>&);
template std::unique_ptr<Kernel<double>> MakeScalarKernel(const Model<double>&);
template std::unique_ptr<Kernel<long double>> MakeScalarKernel(const Model<long double>&);

}  // namespace stipple::raytracer
