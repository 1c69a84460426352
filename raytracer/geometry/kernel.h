// SPDX-License-Identifier: MIT
// What finds the hits of rays. A kernel is read-only: any number of threads or ranks may ask it.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_KERNEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_KERNEL_H

#include <cstdint>
#include <memory>
#include <string_view>

#include "raytracer/geometry/copies.h"
#include "raytracer/geometry/model.h"
#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

template <class Real>
struct Hit {
  Real t = std::numeric_limits<Real>::infinity();
  std::uint32_t object = kNoObject;
  Real u = 0, v = 0;  // of a triangle: weights of its second and third corner; of a patch: u, v
};

/// Tests done for rays: the unit in which this program counts its work.
struct TestCounts {
  std::uint64_t box_tests = 0;
  std::uint64_t primitive_tests = 0;
};

template <class Real>
class Kernel {
 public:
  virtual ~Kernel() = default;

  /// Nearest object along the ray. Of objects at exactly the same distance the one with the lower
  /// number is hit, so that the answer does not depend on the order of traversal.
  virtual Hit<Real> Intersect(const Ray<Real>& ray, TestCounts& tests) const = 0;

  /// Is any object nearer than max_t?
  virtual bool Occluded(const Ray<Real>& ray, Real max_t, TestCounts& tests) const = 0;

  /// The same for a ray that others have looked at before; `repeats` counts tests that are theirs,
  /// too. They have met something no farther than `farthest`: what is farther need not be found.
  virtual Hit<Real> IntersectAgain(const Ray<Real>& ray, Real /*farthest*/, TestCounts& tests,
                                   Repeats&) const {
    return Intersect(ray, tests);
  }
  virtual bool OccludedAgain(const Ray<Real>& ray, Real max_t, TestCounts& tests, Repeats&) const {
    return Occluded(ray, max_t, tests);
  }

  /// Relative error of the distances found, from which rays' offsets from surfaces follow.
  virtual Real Rounding() const { return std::numeric_limits<Real>::epsilon(); }
};

/// Kernels by the names of --kernel: "bvh", "scalar" (the same without vector instructions: the
/// same hits, bit for bit), "embree" (float inside; counts no tests). The model must outlive the
/// kernel. Errors: UsageError for a kernel that cannot trace this model.
template <class Real>
std::unique_ptr<Kernel<Real>> MakeKernel(std::string_view name, const Model<Real>& model);

/// Who brings the hierarchy that this kernel walks.
inline Hierarchy HierarchyFor(std::string_view kernel) {
  return kernel == "embree" ? Hierarchy::kOfKernel : Hierarchy::kOfModel;
}

}  // namespace stipple::raytracer

#endif
