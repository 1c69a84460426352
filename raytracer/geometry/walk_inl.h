// SPDX-License-Identifier: MIT
// The two questions a ray asks, for tests of any make. Compiled once for each set of vector
// instructions (Highway includes this file again and again), and once with the scalar tests.
//
// Children that a ray meets are visited the nearest first; the others wait on a stack as one
// integer, the distance's bits above the link's, so that comparing and skipping is one instruction.
// Nothing here depends on how the tests are done: every kernel visits the same nodes in the same
// order.
#if defined(STIPPLE_RAYTRACER_GEOMETRY_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_RAYTRACER_GEOMETRY_WALK_INL_H
#undef STIPPLE_RAYTRACER_GEOMETRY_WALK_INL_H
#else
#define STIPPLE_RAYTRACER_GEOMETRY_WALK_INL_H
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <bit>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/patch.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::raytracer {
namespace HWY_NAMESPACE {

/// Every node on the longest path leaves at most all its children but one.
inline constexpr std::size_t kStackSize = kMaxBvhDepth * (kMaxChildren - 1) + 1;

/// Distances are positive, so their bits are ordered as they are.
HWY_INLINE std::uint64_t Waiting(float enter, ChildRef child) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(enter)} << 32 | child.bits();
}
/// The last that is not skipped.
HWY_INLINE std::uint64_t LastWithin(float limit) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(limit)} << 32 | 0xffffffffU;
}

/// Relative error of the arithmetic that rays and primitives are computed in.
template <class Real>
inline constexpr double kRounding =
    std::max(static_cast<double>(std::numeric_limits<Real>::epsilon()),
             std::numeric_limits<double>::epsilon());

/// Not inline: the compiler would keep less at hand and compute the rest anew for each node.
template <class Real>
HWY_NOINLINE BoxRay ReadyForBoxes(const Frame& frame, const Ray<Real>& ray) {
  const auto in_double = [](Vec<Real> v) HWY_ATTR {
    return Vec3{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  };
  return BoxRay(frame, {in_double(ray.origin), in_double(ray.direction)}, kRounding<Real>);
}

/// Patches, one by one. They need not be met farther out than `max_t`.
template <class Real>
HWY_INLINE TriangleHit<Real> MeetPatch(const Model<Real>& model, const Ray<Real>& ray,
                                       std::uint32_t slot, Real max_t) {
  const PatchHit<Real> hit = IntersectPatch(model.patches[slot], ray, max_t);
  return {hit.t, hit.u, hit.v};
}

/// Of equal distances the lower object number wins.
template <class Real>
HWY_INLINE void Keep(const TriangleHit<Real>& met, std::uint32_t object, Hit<Real>& best) {
  if (met.t < best.t || (met.t == best.t && object < best.object && met.t != kMiss<Real>))
    best = {met.t, object, met.u, met.v};
}

/// Who is told of tests, beside the count of them: nobody, or who counts those done again.
struct NoWatch {
  HWY_INLINE void Tested(ShapeKind, std::uint32_t, std::uint32_t) {}
};
struct RepeatWatch {
  Repeats& repeats;
  HWY_INLINE void Tested(ShapeKind kind, std::uint32_t slot, std::uint32_t objects) {
    repeats.tests += repeats.copies.CountIn(repeats.seen, kind, slot, objects);
  }
};

template <class Tests, class Watch = NoWatch>
class Walk {
 public:
  using Real = typename Tests::Number;

  Walk(const Model<Real>& model, const Ray<Real>& ray, Watch watch = {})
      : model_(model), ray_(ray), box_ray_(ReadyForBoxes(model.frame[0], ray)), watch_(watch) {}

  HWY_INLINE Hit<Real> Nearest(Real farthest, TestCounts& counts) {
    Hit<Real> best;
    best.t = farthest;
    box_tests_ = 1;
    if (box_ray_.MeetsScene()) Visit(best);
    counts.box_tests += box_tests_;
    counts.primitive_tests += primitive_tests_;
    return best;
  }

  HWY_INLINE bool Any(Real max_t, TestCounts& counts) {
    box_tests_ = 1;
    const float limit = box_ray_.Limit(static_cast<double>(max_t));
    const bool found = box_ray_.MeetsScene() && limit >= 0 && VisitUntilHit(max_t, limit);
    counts.box_tests += box_tests_;
    counts.primitive_tests += primitive_tests_;
    return found;
  }

 private:
  HWY_INLINE void Visit(Hit<Real>& best) {
    const Tests tests(model_, ray_, box_ray_);
    std::uint64_t stack[kStackSize];
    std::uint64_t* top = stack;
    float limit = box_ray_.Limit(static_cast<double>(best.t));
    ChildRef at = model_.frame[0].root;
    for (;;) {
      if (!at.IsLeaf()) {
        box_tests_ += at.Children();
        if (Descend(tests, limit, top, at)) continue;
      } else {
        primitive_tests_ += at.Objects();
        watch_.Tested(at.Kind(), SlotOf(at), at.Objects());
        if (NearestInLeaf(tests, at, best)) limit = box_ray_.Limit(static_cast<double>(best.t));
      }
      const std::uint64_t last = LastWithin(limit);
      do {
        if (top == stack) return;
      } while (*--top > last);
      at = ChildRef::OfBits(static_cast<std::uint32_t>(*top));
    }
  }

  /// Goes to the nearest child and leaves the others on the stack, the nearest on top; false if the
  /// ray meets none.
  HWY_INLINE bool Descend(const Tests& tests, float limit, std::uint64_t*& top, ChildRef& at) {
    const WideNode& node = model_.nodes[at.Node()];
    HWY_ALIGN float enter[kMaxChildren];
    unsigned met = tests.Boxes(node, limit, enter);
    if (met == 0) return false;
    auto lane = static_cast<unsigned>(std::countr_zero(met));
    met &= met - 1;
    if (met == 0) {
      at = node.child[lane];
      return true;
    }
    std::uint64_t nearest = Waiting(enter[lane], node.child[lane]);
    std::uint64_t* const first = top;
    do {
      lane = static_cast<unsigned>(std::countr_zero(met));
      met &= met - 1;
      Fetch(node.child[lane]);
      const std::uint64_t other = Waiting(enter[lane], node.child[lane]);
      const std::uint64_t far = std::max(nearest, other);
      nearest = std::min(nearest, other);
      std::uint64_t* place = top++;
      for (; place != first && place[-1] < far; --place) *place = place[-1];
      *place = far;
    } while (met != 0);
    at = ChildRef::OfBits(static_cast<std::uint32_t>(nearest));
    return true;
  }

  HWY_INLINE bool NearestInLeaf(const Tests& tests, ChildRef leaf, Hit<Real>& best) {
    const Real before = best.t;
    const std::uint32_t first = leaf.First(), objects = leaf.Objects();
    const ShapeKind kind = leaf.Kind();
    const Array<std::uint32_t>& numbers = model_.numbers[static_cast<std::size_t>(kind)];
    if (kind == ShapeKind::kPatch) {
      for (std::uint32_t i = 0; i < objects; ++i)
        Keep(MeetPatch(model_, ray_, first + i, best.t), numbers[first + i], best);
    } else {
      for (std::uint32_t done = 0; done < objects; done += kLanes)
        tests.NearestInBlock(kind, first + done / kLanes, numbers.data(), best);
    }
    return best.t < before;
  }

  HWY_INLINE bool VisitUntilHit(Real max_t, float limit) {
    const Tests tests(model_, ray_, box_ray_);
    std::uint32_t stack[kStackSize];  // bits of links: an array of those would be cleared each time
    std::uint32_t* top = stack;
    ChildRef at = model_.frame[0].root;
    for (;;) {
      if (at.IsLeaf()) {
        if (AnyInLeaf(tests, at, max_t)) return true;
      } else {
        box_tests_ += at.Children();
        const WideNode& node = model_.nodes[at.Node()];
        HWY_ALIGN float enter[kMaxChildren];
        unsigned met = tests.Boxes(node, limit, enter);
        if (met != 0) {
          at = node.child[std::countr_zero(met)];
          for (met &= met - 1; met != 0; met &= met - 1) {
            const ChildRef waits = node.child[std::countr_zero(met)];
            Fetch(waits);
            *top++ = waits.bits();
          }
          continue;
        }
      }
      if (top == stack) return false;
      at = ChildRef::OfBits(*--top);
    }
  }

  /// Has a node brought to the cache while others are visited.
  HWY_INLINE void Fetch(ChildRef waits) const {
    if (waits.IsLeaf()) return;
    const auto* const node = reinterpret_cast<const char*>(model_.nodes.data() + waits.Node());
    hwy::Prefetch(node);
    hwy::Prefetch(node + 64);
    hwy::Prefetch(node + 128);
  }

  HWY_INLINE bool AnyInLeaf(const Tests& tests, ChildRef leaf, Real max_t) {
    const std::uint32_t first = leaf.First(), objects = leaf.Objects();
    const ShapeKind kind = leaf.Kind();
    if (kind == ShapeKind::kPatch) {
      for (std::uint32_t i = 0; i < objects; ++i) {
        ++primitive_tests_;
        watch_.Tested(kind, first + i, 1);
        if (MeetPatch(model_, ray_, first + i, max_t).t < max_t) return true;
      }
      return false;
    }
    for (std::uint32_t done = 0; done < objects; done += kLanes) {
      primitive_tests_ += std::min(kLanes, objects - done);
      watch_.Tested(kind, first * kLanes + done, std::min(kLanes, objects - done));
      if (tests.AnyInBlock(kind, first + done / kLanes, max_t)) return true;
    }
    return false;
  }

  HWY_INLINE static std::uint32_t SlotOf(ChildRef leaf) {
    return leaf.Kind() == ShapeKind::kPatch ? leaf.First() : leaf.First() * kLanes;
  }

  const Model<Real>& model_;
  const Ray<Real>& ray_;
  const BoxRay box_ray_;
  std::uint64_t box_tests_ = 0, primitive_tests_ = 0;
  [[no_unique_address]] Watch watch_;
};

template <class Tests>
class BvhKernel final : public Kernel<typename Tests::Number> {
 public:
  using Real = typename Tests::Number;

  explicit BvhKernel(const Model<Real>& model) : model_(model) {}

  [[gnu::noinline]] Hit<Real> Intersect(const Ray<Real>& ray, TestCounts& tests) const override {
    if (model_.frame.empty()) return {};
    return Walk<Tests>(model_, ray).Nearest(kMiss<Real>, tests);
  }

  [[gnu::noinline]] bool Occluded(const Ray<Real>& ray, Real max_t,
                                  TestCounts& tests) const override {
    return !model_.frame.empty() && Walk<Tests>(model_, ray).Any(max_t, tests);
  }

  [[gnu::noinline]] Hit<Real> IntersectAgain(const Ray<Real>& ray, Real farthest, TestCounts& tests,
                                             Repeats& repeats) const override {
    if (model_.frame.empty()) return {};
    return Walk<Tests, RepeatWatch>(model_, ray, {repeats}).Nearest(farthest, tests);
  }

  [[gnu::noinline]] bool OccludedAgain(const Ray<Real>& ray, Real max_t, TestCounts& tests,
                                       Repeats& repeats) const override {
    return !model_.frame.empty() &&
           Walk<Tests, RepeatWatch>(model_, ray, {repeats}).Any(max_t, tests);
  }

 private:
  const Model<Real>& model_;
};

}  // namespace HWY_NAMESPACE
}  // namespace stipple::raytracer
HWY_AFTER_NAMESPACE();

#endif
