// SPDX-License-Identifier: MIT
// Box tests that lose boxes.
//
// A ray that runs within the plane of a face has 0 * infinity = NaN as its distance to that plane.
// Every comparison with NaN is false, so what a minimum or maximum makes of it is a matter of the
// order of its operands: the same formula, written four ways, finds the box always, often, seldom
// or never. And a distance that was rounded down may lie before one that was rounded up: flat boxes
// are lost even without NaN.
// Source: Williams, Barrus, Morley, Shirley, "An Efficient and Robust Ray-Box Intersection
// Algorithm", Journal of Graphics Tools 10(1), 2005; Ize, "Robust BVH Ray Traversal", JCGT 2(2),
// 2013. What replaces them: EnterBounds in geometry/bounds.h.
#ifndef STIPPLE_RAYTRACER_CHARTS_REJECTED_SLAB_H
#define STIPPLE_RAYTRACER_CHARTS_REJECTED_SLAB_H

#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer::rejected {

template <class Real>
struct Box {
  Vec<Real> low, high;
};

/// Distances between which a ray is inside all slabs that were looked at so far.
template <class Real>
struct Span {
  Real enter = 0;
  Real leave = std::numeric_limits<Real>::infinity();
};

// How the distances a and b to the two planes of a slab narrow the span.

/// The distances are swapped if they are in the wrong order; then plain comparisons.
template <class Real>
void NarrowBySwap(Span<Real>& span, Real a, Real b) {
  if (a > b) std::swap(a, b);
  if (a > span.enter) span.enter = a;
  if (b < span.leave) span.leave = b;
}
/// The old value first: where the new one is NaN, std::max and std::min return their first operand.
template <class Real>
void NarrowOldFirst(Span<Real>& span, Real a, Real b) {
  span.enter = std::max(span.enter, std::min(a, b));
  span.leave = std::min(span.leave, std::max(a, b));
}
/// The new value first: NaN passes on, and the next slab forgets what the ones before it said.
template <class Real>
void NarrowNewFirst(Span<Real>& span, Real a, Real b) {
  span.enter = std::max(std::min(a, b), span.enter);
  span.leave = std::min(std::max(a, b), span.leave);
}
/// NaN gives way to the other operand: both planes of the slab are where the other one is, which is
/// at infinity.
template <class Real>
void NarrowByFmin(Span<Real>& span, Real a, Real b) {
  span.enter = std::fmax(span.enter, std::fmin(a, b));
  span.leave = std::fmin(span.leave, std::fmax(a, b));
}

template <class Real>
struct SlabForm {
  std::string_view name;
  void (*narrow)(Span<Real>& span, Real a, Real b);
};
template <class Real>
inline constexpr SlabForm<Real> kSlabForms[] = {{"swap", NarrowBySwap<Real>},
                                                {"old first", NarrowOldFirst<Real>},
                                                {"new first", NarrowNewFirst<Real>},
                                                {"fmin", NarrowByFmin<Real>}};

/// Does the ray meet the box? The far distance is multiplied by `widen`; 1 is the plain test.
template <class Real>
bool MeetsBox(const SlabForm<Real>& form, const Box<Real>& box, const Ray<Real>& ray, Real widen) {
  Span<Real> span;
  const auto slab = [&](Real low, Real high, Real origin, Real direction) {
    const Real inverse = 1 / direction;
    form.narrow(span, (low - origin) * inverse, (high - origin) * inverse);
  };
  slab(box.low.x, box.high.x, ray.origin.x, ray.direction.x);
  slab(box.low.y, box.high.y, ray.origin.y, ray.direction.y);
  slab(box.low.z, box.high.z, ray.origin.z, ray.direction.z);
  return span.enter <= span.leave * widen;
}

}  // namespace stipple::raytracer::rejected

#endif
