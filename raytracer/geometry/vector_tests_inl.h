// SPDX-License-Identifier: MIT
// Eight boxes and four primitives at a time. Each function is one of intersect.h, operation by
// operation in the same order, and never a fused multiply-add: the bits are the same.
#if defined(STIPPLE_RAYTRACER_GEOMETRY_VECTOR_TESTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_RAYTRACER_GEOMETRY_VECTOR_TESTS_INL_H
#undef STIPPLE_RAYTRACER_GEOMETRY_VECTOR_TESTS_INL_H
#else
#define STIPPLE_RAYTRACER_GEOMETRY_VECTOR_TESTS_INL_H
#endif

#include <hwy/highway.h>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/walk_inl.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::raytracer {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Three vectors of one number per lane.
template <class V>
struct Three {
  V x, y, z;
};

template <class V>
HWY_INLINE V Dot(const Three<V>& a, const Three<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Three<V> Sub(const Three<V>& a, const Three<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Three<V> Add(const Three<V>& a, const Three<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Three<V> Mul(const Three<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

template <class D, class Mask>
HWY_INLINE unsigned BitsOf(D d, Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

/// What a block's primitives answer: a bit for each that is met, and its distance.
template <class Real>
struct Met {
  unsigned lanes = 0;
  HWY_ALIGN Real t[kLanes];
};

template <class Real>
class VectorTests {
  using Lanes = hn::CappedTag<Real, kLanes>;
  using V = hn::Vec<Lanes>;
  using BoxLanes = hn::CappedTag<float, kMaxChildren>;
  using BoxV = hn::Vec<BoxLanes>;

 public:
  using Number = Real;

  HWY_INLINE VectorTests(const Model<Real>& model, const Ray<Real>& ray, const BoxRay& box_ray)
      : model_(model), ray_(ray), box_ray_(box_ray) {
    const BoxLanes d;
    near_x_ = hn::Set(d, box_ray.near_origin[0]);
    near_y_ = hn::Set(d, box_ray.near_origin[1]);
    near_z_ = hn::Set(d, box_ray.near_origin[2]);
    far_x_ = hn::Set(d, box_ray.far_origin[0]);
    far_y_ = hn::Set(d, box_ray.far_origin[1]);
    far_z_ = hn::Set(d, box_ray.far_origin[2]);
    if (!model.triangles.empty()) shear_ = ShearRay<Real>(ray);
  }

  HWY_INLINE unsigned Boxes(const WideNode& node, float limit, float (&enter)[kMaxChildren]) const {
    const BoxLanes d;
    const float* const near_x = node.side + box_ray_.near_side[0];
    const float* const near_y = node.side + box_ray_.near_side[1];
    const float* const near_z = node.side + box_ray_.near_side[2];
    const float* const far_x = node.side + box_ray_.far_side[0];
    const float* const far_y = node.side + box_ray_.far_side[1];
    const float* const far_z = node.side + box_ray_.far_side[2];
    unsigned met = 0;
    for (std::size_t i = 0; i < kMaxChildren; i += hn::MaxLanes(d)) {
      const BoxV x0 = Slab(near_x + i, near_x_, box_ray_.near_inverse[0]);
      const BoxV y0 = Slab(near_y + i, near_y_, box_ray_.near_inverse[1]);
      const BoxV z0 = Slab(near_z + i, near_z_, box_ray_.near_inverse[2]);
      const BoxV x1 = Slab(far_x + i, far_x_, box_ray_.far_inverse[0]);
      const BoxV y1 = Slab(far_y + i, far_y_, box_ray_.far_inverse[1]);
      const BoxV z1 = Slab(far_z + i, far_z_, box_ray_.far_inverse[2]);
      const BoxV begin = hn::Max(hn::Max(x0, y0), hn::Max(z0, hn::Set(d, kEarliest)));
      const BoxV end = hn::Min(hn::Min(x1, y1), hn::Min(z1, hn::Set(d, limit)));
      hn::Store(begin, d, enter + i);
      met |= BitsOf(d, hn::Le(begin, end)) << i;
    }
    return met;
  }

  HWY_INLINE void NearestInBlock(ShapeKind kind, std::uint32_t block, const std::uint32_t* numbers,
                                 Hit<Real>& best) const {
    if (kind == ShapeKind::kTriangle) return NearestTriangle(block, numbers, best);
    Met<Real> met;
    if (kind == ShapeKind::kSphere)
      MeetSpheres(model_.spheres[block], best.t, met);
    else if (kind == ShapeKind::kCone)
      MeetCones(model_.cones[block], best.t, met);
    else
      MeetPolygons(model_.polygons[block], best.t, met);
    for (; met.lanes != 0; met.lanes &= met.lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(met.lanes));
      Keep<Real>({met.t[lane], 0, 0}, numbers[block * kLanes + lane], best);
    }
  }

  HWY_INLINE bool AnyInBlock(ShapeKind kind, std::uint32_t block, Real max_t) const {
    Met<Real> met;
    if (kind == ShapeKind::kSphere)
      MeetSpheres(model_.spheres[block], max_t, met);
    else if (kind == ShapeKind::kCone)
      MeetCones(model_.cones[block], max_t, met);
    else if (kind == ShapeKind::kTriangle)
      return AnyTriangle(block, max_t);
    else
      MeetPolygons(model_.polygons[block], max_t, met);
    for (; met.lanes != 0; met.lanes &= met.lanes - 1)
      if (met.t[std::countr_zero(met.lanes)] < max_t) return true;
    return false;
  }

 private:
  HWY_INLINE BoxV Slab(const float* side, BoxV origin, float inverse) const {
    const BoxLanes d;
    return hn::Mul(hn::Sub(hn::Load(d, side), origin), hn::Set(d, inverse));
  }

  HWY_INLINE Three<V> LoadThree(const Real (&numbers)[3][kLanes], std::size_t i) const {
    const Lanes d;
    return {hn::Load(d, numbers[0] + i), hn::Load(d, numbers[1] + i), hn::Load(d, numbers[2] + i)};
  }
  HWY_INLINE Three<V> SetThree(Vec<Real> v) const {
    const Lanes d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
  }

  /// Those no farther than `max_t`.
  HWY_INLINE void MeetSpheres(const SphereBlock<Real>& block, Real max_t, Met<Real>& met) const {
    const Lanes d;
    const V zero = hn::Zero(d);
    const Three<V> direction = SetThree(ray_.direction);
    for (std::size_t i = 0; i < kLanes; i += hn::MaxLanes(d)) {
      const Three<V> f = Sub(SetThree(ray_.origin), LoadThree(block.center, i));
      const V b = hn::Neg(Dot(f, direction));
      const Three<V> nearest = Add(f, Mul(direction, b));
      const V radius = hn::Load(d, block.radius + i);
      const V r2 = hn::Mul(radius, radius);
      const V discriminant = hn::Sub(r2, Dot(nearest, nearest));
      const auto real = hn::Ge(discriminant, zero);
      if (hn::AllFalse(d, real)) continue;
      const V q = hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b));
      const V other = hn::IfThenZeroElse(hn::Eq(q, zero), hn::Div(hn::Sub(Dot(f, f), r2), q));
      const V near_t = hn::Min(q, other), far_t = hn::Max(q, other);
      const V t = hn::IfThenElse(hn::Gt(near_t, zero), near_t, far_t);
      const auto ahead = hn::And(hn::Gt(t, zero), hn::Le(t, hn::Set(d, max_t)));
      met.lanes |= BitsOf(d, hn::And(real, ahead)) << i;
      hn::Store(t, d, met.t + i);
    }
  }

  HWY_INLINE void MeetCones(const ConeBlock<Real>& block, Real max_t, Met<Real>& met) const {
    const Lanes d;
    const V zero = hn::Zero(d);
    const Three<V> direction = SetThree(ray_.direction);
    for (std::size_t i = 0; i < kLanes; i += hn::MaxLanes(d)) {
      const Three<V> axis = LoadThree(block.axis, i);
      const V height = hn::Load(d, block.height + i), slope = hn::Load(d, block.slope + i);
      const Three<V> from_base = Sub(SetThree(ray_.origin), LoadThree(block.base, i));
      const V half = hn::Mul(height, hn::Set(d, Real{0.5}));
      const V shift = Dot(Sub(Mul(axis, half), from_base), direction);
      const Three<V> o = Add(from_base, Mul(direction, shift));
      const V oz = Dot(o, axis);
      const V dz = Dot(direction, axis);
      const Three<V> op = Sub(o, Mul(axis, oz));
      const Three<V> dp = Sub(direction, Mul(axis, dz));
      const V radius = hn::Add(hn::Load(d, block.base_radius + i), hn::Mul(slope, oz));
      const V a = hn::Sub(Dot(dp, dp), hn::Mul(hn::Mul(hn::Mul(slope, slope), dz), dz));
      const V b = hn::Sub(Dot(op, dp), hn::Mul(hn::Mul(slope, radius), dz));
      const V c = hn::Sub(Dot(op, op), hn::Mul(radius, radius));
      const V discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(a, c));
      const auto real = hn::Ge(discriminant, zero);
      if (hn::AllFalse(d, real)) continue;
      const V q = hn::Neg(hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b)));
      const V first = hn::Div(q, a), second = hn::Div(c, q);
      const auto swapped = hn::Lt(second, first);
      const V t0 = hn::IfThenElse(swapped, second, first);
      const V t1 = hn::IfThenElse(swapped, first, second);
      const auto on_side = [&](V t) HWY_ATTR {
        const V z = hn::Add(oz, hn::Mul(t, dz));
        return hn::And(hn::Gt(hn::Add(t, shift), zero),
                       hn::And(hn::Ge(z, zero), hn::Le(z, height)));
      };
      const auto first_met = on_side(t0);
      const V t = hn::Add(hn::IfThenElse(first_met, t0, t1), shift);
      const auto any_met = hn::And(real, hn::Or(first_met, on_side(t1)));
      met.lanes |= BitsOf(d, hn::And(any_met, hn::Le(t, hn::Set(d, max_t)))) << i;
      hn::Store(t, d, met.t + i);
    }
  }

  /// Planes four at a time; then the outlines of those that are met there.
  HWY_INLINE void MeetPolygons(const PolygonBlock<Real>& block, Real max_t, Met<Real>& met) const {
    const Lanes d;
    const V farthest = hn::Set(d, std::min(max_t, std::numeric_limits<Real>::max()));
    const Three<V> origin = SetThree(ray_.origin), direction = SetThree(ray_.direction);
    HWY_ALIGN Real p[3][kLanes];
    unsigned ahead = 0;
    for (std::size_t i = 0; i < kLanes; i += hn::MaxLanes(d)) {
      const Three<V> normal = LoadThree(block.normal, i);
      const V slope = Dot(normal, direction);
      const V height = hn::Sub(hn::Load(d, block.offset + i), Dot(normal, origin));
      // A plane that the ray leaves needs no division.
      if (hn::AllTrue(d, hn::Lt(hn::Xor(height, slope), hn::Zero(d)))) continue;
      const V t = hn::Div(height, slope);
      const unsigned lanes = BitsOf(d, hn::And(hn::Gt(t, hn::Zero(d)), hn::Le(t, farthest)));
      if (lanes == 0) continue;
      ahead |= lanes << i;
      const Three<V> at = Add(origin, Mul(direction, t));
      hn::Store(t, d, met.t + i);
      hn::Store(at.x, d, p[0] + i);
      hn::Store(at.y, d, p[1] + i);
      hn::Store(at.z, d, p[2] + i);
    }
    for (; ahead != 0; ahead &= ahead - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(ahead));
      const int axis = block.dropped_axis[lane];
      const OutlinePoint<Real> q{p[axis == 2 ? 0 : axis + 1][lane],
                                 p[axis == 0 ? 2 : axis - 1][lane]};
      if (Inside(block.first_vertex[lane], block.vertex_count[lane], q)) met.lanes |= 1U << lane;
    }
  }

  /// As `InsideOutline`; outlines with as many edges as a vector has lanes all at once.
  HWY_INLINE bool Inside(std::uint32_t first, std::uint32_t count, OutlinePoint<Real> p) const {
    const OutlinePoint<Real>* const outline = model_.outlines.data() + first;
    const Lanes d;
    if (count != hn::MaxLanes(d)) return InsideOutline(std::span(outline, count), p);
    V a_u, a_v;
    hn::LoadInterleaved2(d, &outline->u, a_u, a_v);
    // Each edge's other end is that of the next lane.
    alignas(32) static constexpr hwy::MakeSigned<Real> kNext[4] = {1, 2, 3, 0};
    const auto next = hn::SetTableIndices(d, kNext);
    const V b_u = hn::TableLookupLanes(a_u, next), b_v = hn::TableLookupLanes(a_v, next);
    const V p_u = hn::Set(d, p.u), p_v = hn::Set(d, p.v);
    const auto a_above = hn::Gt(a_v, p_v), b_above = hn::Gt(b_v, p_v);
    // Of an edge that crosses, the lower end is the one not above.
    const V low_u = hn::IfThenElse(a_above, b_u, a_u), low_v = hn::IfThenElse(a_above, b_v, a_v);
    const V high_u = hn::IfThenElse(a_above, a_u, b_u), high_v = hn::IfThenElse(a_above, a_v, b_v);
    const auto right = hn::Gt(hn::Mul(hn::Sub(high_u, low_u), hn::Sub(p_v, low_v)),
                              hn::Mul(hn::Sub(p_u, low_u), hn::Sub(high_v, low_v)));
    return std::popcount(BitsOf(d, hn::And(hn::Xor(a_above, b_above), right))) % 2 != 0;
  }

  struct MetTriangles : Met<Real> {
    HWY_ALIGN Real u[kLanes], v[kLanes];
  };

  HWY_INLINE void MeetTriangles(const TriangleBlock<Real>& block, Real max_t,
                                MetTriangles& met) const {
    const Lanes d;
    const V zero = hn::Zero(d);
    const V ox = hn::Set(d, shear_.origin[shear_.kx]), oy = hn::Set(d, shear_.origin[shear_.ky]),
            oz = hn::Set(d, shear_.origin[shear_.kz]);
    const V sx = hn::Set(d, shear_.sx), sy = hn::Set(d, shear_.sy);
    for (std::size_t i = 0; i < kLanes; i += hn::MaxLanes(d)) {
      const auto corner = [&](int number) HWY_ATTR {
        const Real(&from)[3][kLanes] = block.corner[number];
        const V z = hn::Sub(hn::Load(d, from[shear_.kz] + i), oz);
        const V x = hn::Sub(hn::Sub(hn::Load(d, from[shear_.kx] + i), ox), hn::Mul(sx, z));
        const V y = hn::Sub(hn::Sub(hn::Load(d, from[shear_.ky] + i), oy), hn::Mul(sy, z));
        return Three<V>{x, y, z};
      };
      const Three<V> p0 = corner(0), p1 = corner(1), p2 = corner(2);
      const V u = hn::Sub(hn::Mul(p2.x, p1.y), hn::Mul(p2.y, p1.x));
      const V v = hn::Sub(hn::Mul(p0.x, p2.y), hn::Mul(p0.y, p2.x));
      const V w = hn::Sub(hn::Mul(p1.x, p0.y), hn::Mul(p1.y, p0.x));
      const auto negative = hn::Or(hn::Or(hn::Lt(u, zero), hn::Lt(v, zero)), hn::Lt(w, zero));
      const auto positive = hn::Or(hn::Or(hn::Gt(u, zero), hn::Gt(v, zero)), hn::Gt(w, zero));
      // Not all zero, not of both signs: exactly one of the two.
      const auto inside = hn::Xor(negative, positive);
      if (hn::AllFalse(d, inside)) continue;
      const V sum = hn::Add(hn::Add(u, v), w);
      const V scale = hn::Div(hn::Set(d, Real{1}), sum);
      const V dot = hn::Add(hn::Add(hn::Mul(u, p0.z), hn::Mul(v, p1.z)), hn::Mul(w, p2.z));
      const V t = hn::Mul(hn::Mul(dot, hn::Set(d, shear_.sz)), scale);
      const auto ahead = hn::And(hn::Gt(t, zero), hn::Le(t, hn::Set(d, max_t)));
      const unsigned lanes = BitsOf(d, hn::And(inside, ahead));
      if (lanes == 0) continue;
      met.lanes |= lanes << i;
      hn::Store(t, d, met.t + i);
      hn::Store(hn::Mul(v, scale), d, met.u + i);
      hn::Store(hn::Mul(w, scale), d, met.v + i);
    }
  }

  HWY_INLINE void NearestTriangle(std::uint32_t block, const std::uint32_t* numbers,
                                  Hit<Real>& best) const {
    MetTriangles met;
    MeetTriangles(model_.triangles[block], best.t, met);
    for (; met.lanes != 0; met.lanes &= met.lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(met.lanes));
      Keep<Real>({met.t[lane], met.u[lane], met.v[lane]}, numbers[block * kLanes + lane], best);
    }
  }

  HWY_INLINE bool AnyTriangle(std::uint32_t block, Real max_t) const {
    MetTriangles met;
    MeetTriangles(model_.triangles[block], max_t, met);
    for (; met.lanes != 0; met.lanes &= met.lanes - 1)
      if (met.t[std::countr_zero(met.lanes)] < max_t) return true;
    return false;
  }

  const Model<Real>& model_;
  const Ray<Real>& ray_;
  const BoxRay& box_ray_;
  BoxV near_x_, near_y_, near_z_, far_x_, far_y_, far_z_;
  ShearRay<Real> shear_;
};

}  // namespace HWY_NAMESPACE
}  // namespace stipple::raytracer
HWY_AFTER_NAMESPACE();

#endif
