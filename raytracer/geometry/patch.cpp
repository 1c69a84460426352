// SPDX-License-Identifier: MIT
// A ray is where two planes meet, so it hits the patch where both distances from these planes are
// zero: two bicubic polynomials in (u, v), whose Bezier coefficients are the distances of the
// control points. Their roots are found by dividing the patch:
//
// 1. A part whose coefficients are all on one side of a plane, behind the ray's origin or beyond
//    max_t is dropped: it lies within the hull of its coefficients.
// 2. If the derivatives of a part, seen through the inverse of their mean, are within q = 1/4 of
//    the unit matrix everywhere (their own coefficients bound them), the part has at most one root,
//    and Newton's method from its middle, kept inside the part, converges to it: each step leaves
//    at most 2 q / (1 - q) = 2/3 of the distance, and soon its square. A step that ends farther
//    outside than that allows proves that there is no root.
// 3. Else it is halved along its longer direction, the nearer half first.
//
// Rays that touch the patch, or go through a point where it has no tangent plane, end at parts so
// small that their place is known to rounding; these count as met. Both plane distances of points
// on an edge come from that edge's control points alone, so neighbours agree about rays there up to
// rounding, and a part reaches out by that much: the seam has no gap. Why not Newton's method from
// seeds: from the middles of boxes 8 x 8 to a patch it goes to a farther sheet for 0.02 % of rays.
#include "raytracer/geometry/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple::raytracer {
namespace {

/// Bezier coefficients of one coordinate, [row][column]: rows along v, columns along u.
template <class Real>
using Net = std::array<std::array<Real, 4>, 4>;

/// A part of the patch seen along the ray: distances from the two planes, and along the ray.
template <class Real>
struct Part {
  Net<Real> a, b, t;
  Real u, v;            // where it begins in the patch's parameters
  Real u_size, v_size;  // and how far it reaches
  Real nearest;         // smallest coefficient of t
};

/// Parts smaller than this in u and v are places: the square root of rounding, since a ray that
/// touches the patch has a double root.
template <class Real>
constexpr Real SmallestPart() {
  Real size = 1;
  while (size * size > std::numeric_limits<Real>::epsilon()) size /= 2;
  return size;
}

constexpr int kMostPending = 72;  // each halving leaves one part waiting: 2 x 32 in long double
/// Only surfaces that fold into a line as the ray sees them need so many.
constexpr int kMostParts = 4096;

template <class Real>
struct Range {
  Real low, high;
};

template <class Real>
Range<Real> RangeOf(const Net<Real>& net) {
  std::array<Real, 4> low = net[0], high = net[0];
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      low[j] = net[i][j] < low[j] ? net[i][j] : low[j];
      high[j] = net[i][j] > high[j] ? net[i][j] : high[j];
    }
  }
  return {std::min(std::min(low[0], low[1]), std::min(low[2], low[3])),
          std::max(std::max(high[0], high[1]), std::max(high[2], high[3]))};
}

/// de Casteljau at 1/2, along v.
template <class Real>
void HalveRows(const Net<Real>& net, Net<Real>& first, Net<Real>& second) {
  for (std::size_t j = 0; j < 4; ++j) {
    const Real p0 = net[0][j], p1 = net[1][j], p2 = net[2][j], p3 = net[3][j];
    const Real p01 = (p0 + p1) / 2, p12 = (p1 + p2) / 2, p23 = (p2 + p3) / 2;
    const Real p012 = (p01 + p12) / 2, p123 = (p12 + p23) / 2;
    const Real middle = (p012 + p123) / 2;
    first[0][j] = p0, first[1][j] = p01, first[2][j] = p012, first[3][j] = middle;
    second[0][j] = middle, second[1][j] = p123, second[2][j] = p23, second[3][j] = p3;
  }
}

template <class Real>
void HalveColumns(const Net<Real>& net, Net<Real>& first, Net<Real>& second) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Real p0 = net[i][0], p1 = net[i][1], p2 = net[i][2], p3 = net[i][3];
    const Real p01 = (p0 + p1) / 2, p12 = (p1 + p2) / 2, p23 = (p2 + p3) / 2;
    const Real p012 = (p01 + p12) / 2, p123 = (p12 + p23) / 2;
    const Real middle = (p012 + p123) / 2;
    first[i] = {p0, p01, p012, middle};
    second[i] = {middle, p123, p23, p3};
  }
}

/// A cubic's value and slope at t.
template <class Real>
struct CubicAt {
  Real weight[4], slope[4];

  explicit CubicAt(Real t) {
    const Real s = 1 - t;
    weight[0] = s * s * s, weight[1] = 3 * s * s * t, weight[2] = 3 * s * t * t;
    weight[3] = t * t * t;
    slope[0] = -3 * s * s, slope[1] = 3 * s * (s - 2 * t), slope[2] = 3 * t * (2 * s - t);
    slope[3] = 3 * t * t;
  }
};

template <class Real>
struct Value {
  Real f = 0, du = 0, dv = 0;
};

template <class Real>
Value<Real> ValueOf(const Net<Real>& net, const CubicAt<Real>& u, const CubicAt<Real>& v) {
  Value<Real> value;
  for (std::size_t i = 0; i < 4; ++i) {
    Real along = 0, slope = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      along += net[i][j] * u.weight[j];
      slope += net[i][j] * u.slope[j];
    }
    value.f += along * v.weight[i];
    value.du += slope * v.weight[i];
    value.dv += along * v.slope[i];
  }
  return value;
}

/// A matrix of two rows.
template <class Real>
struct Matrix2 {
  Real xx, xy, yx, yy;
};

/// Not finite if the matrix has no inverse.
template <class Real>
Matrix2<Real> Inverse(const Matrix2<Real>& m) {
  const Real scale = 1 / (m.xx * m.yy - m.xy * m.yx);
  return {m.yy * scale, -m.xy * scale, -m.yx * scale, m.xx * scale};
}

/// The mean derivative of (a, b) by (u, v) over a part.
template <class Real>
Matrix2<Real> MeanSlope(const Part<Real>& part) {
  Matrix2<Real> mean{};
  for (std::size_t i = 0; i < 4; ++i) {
    mean.xx += part.a[i][3] - part.a[i][0];
    mean.xy += part.a[3][i] - part.a[0][i];
    mean.yx += part.b[i][3] - part.b[i][0];
    mean.yy += part.b[3][i] - part.b[0][i];
  }
  return {mean.xx / 4, mean.xy / 4, mean.yx / 4, mean.yy / 4};
}

/// How far from linear a part may be, as the largest sum of a row.
template <class Real>
constexpr Real kBend = Real{1} / 4;

/// Are the derivatives of the part, times `inverse`, within kBend of the unit matrix? False if
/// `inverse` is not finite.
template <class Real>
bool IsNearlyLinear(const Part<Real>& part, const Matrix2<Real>& inverse) {
  Real along_x = 0, along_y = 0, across_x = 0, across_y = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Real au = 3 * (part.a[i][j + 1] - part.a[i][j]);
      const Real bu = 3 * (part.b[i][j + 1] - part.b[i][j]);
      along_x = std::max(along_x, std::abs(inverse.xx * au + inverse.xy * bu - 1));
      along_y = std::max(along_y, std::abs(inverse.yx * au + inverse.yy * bu));
      const Real av = 3 * (part.a[j + 1][i] - part.a[j][i]);
      const Real bv = 3 * (part.b[j + 1][i] - part.b[j][i]);
      across_x = std::max(across_x, std::abs(inverse.xx * av + inverse.xy * bv));
      across_y = std::max(across_y, std::abs(inverse.yx * av + inverse.yy * bv - 1));
    }
    // Written so that NaN is no.
    if (!(along_x + across_x < kBend<Real> && along_y + across_y < kBend<Real>)) return false;
  }
  return true;
}

template <class Real>
class PatchWalk {
 public:
  PatchWalk(const Patch<Real>& patch, const Ray<Real>& ray, Real max_t) : best_{max_t, 0, 0} {
    const ShearRay<Real> shear(ray);
    Part<Real>& whole = pending_[0];
    Real farthest = 0;
    for (std::size_t k = 0; k < 16; ++k) {
      const Vec<Real>& control = patch.control[k];
      const Real point[3] = {control.x - shear.origin[0], control.y - shear.origin[1],
                             control.z - shear.origin[2]};
      const Real z = point[shear.kz];
      whole.a[k / 4][k % 4] = point[shear.kx] - shear.sx * z;
      whole.b[k / 4][k % 4] = point[shear.ky] - shear.sy * z;
      whole.t[k / 4][k % 4] = z * shear.sz;
      farthest = std::max(
          farthest, std::max(std::abs(point[0]), std::max(std::abs(point[1]), std::abs(point[2]))));
    }
    slack_ = 8 * std::numeric_limits<Real>::epsilon() * farthest;
    whole.u = whole.v = 0;
    whole.u_size = whole.v_size = 1;
    if (Prepare(whole)) count_ = 1;
  }

  PatchHit<Real> Nearest() {
    for (int parts = 0; count_ > 0 && parts < kMostParts; ++parts) {
      const Part<Real> part = pending_[static_cast<std::size_t>(--count_)];
      if (part.nearest > best_.t + slack_) continue;
      const Matrix2<Real> inverse = Inverse(MeanSlope(part));
      if (IsNearlyLinear(part, inverse))
        Solve(part, inverse);
      else if (std::max(part.u_size, part.v_size) <= SmallestPart<Real>())
        Meet(part, Real{0.5}, Real{0.5});
      else
        Divide(part);
    }
    return met_ ? best_ : PatchHit<Real>{};
  }

 private:
  /// False if the ray certainly does not meet this part.
  bool Prepare(Part<Real>& part) const {
    const Range<Real> a = RangeOf(part.a);
    if (a.low > slack_ || a.high < -slack_) return false;
    const Range<Real> b = RangeOf(part.b);
    if (b.low > slack_ || b.high < -slack_) return false;
    const Range<Real> t = RangeOf(part.t);
    part.nearest = t.low;
    return t.high > 0 && t.low <= best_.t + slack_;
  }

  void Divide(const Part<Real>& part) {
    Part<Real>& first = pending_[static_cast<std::size_t>(count_)];
    Part<Real>& second = pending_[static_cast<std::size_t>(count_ + 1)];
    first.u = second.u = part.u;
    first.v = second.v = part.v;
    first.u_size = second.u_size = part.u_size;
    first.v_size = second.v_size = part.v_size;
    if (IsLongerAlongU(part)) {
      HalveColumns(part.a, first.a, second.a);
      HalveColumns(part.b, first.b, second.b);
      HalveColumns(part.t, first.t, second.t);
      first.u_size = second.u_size = part.u_size / 2;
      second.u = part.u + second.u_size;
    } else {
      HalveRows(part.a, first.a, second.a);
      HalveRows(part.b, first.b, second.b);
      HalveRows(part.t, first.t, second.t);
      first.v_size = second.v_size = part.v_size / 2;
      second.v = part.v + second.v_size;
    }
    const bool first_met = Prepare(first), second_met = Prepare(second);
    if (first_met && second_met) {
      if (first.nearest < second.nearest) std::swap(first, second);  // the last is taken next
      count_ += 2;
    } else if (first_met) {
      ++count_;
    } else if (second_met) {
      first = second;
      ++count_;
    }
  }

  /// As the ray sees it, by the lengths of the control net.
  static bool IsLongerAlongU(const Part<Real>& part) {
    Real u = 0, v = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        u += std::abs(part.a[i][j + 1] - part.a[i][j]) + std::abs(part.b[i][j + 1] - part.b[i][j]);
        v += std::abs(part.a[j + 1][i] - part.a[j][i]) + std::abs(part.b[j + 1][i] - part.b[j][i]);
      }
    }
    if (part.u_size <= SmallestPart<Real>()) return false;
    if (part.v_size <= SmallestPart<Real>()) return true;
    return u > v;
  }

  /// Newton's method in a part with at most one root, kept within it and a margin for rounding.
  void Solve(const Part<Real>& part, const Matrix2<Real>& inverse) {
    constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();
    const Real margin_u = (std::abs(inverse.xx) + std::abs(inverse.xy)) * slack_ + 4 * kEpsilon;
    const Real margin_v = (std::abs(inverse.yx) + std::abs(inverse.yy)) * slack_ + 4 * kEpsilon;
    Real u = Real{0.5}, v = Real{0.5};
    Real reach = Real{0.5};  // the root is no farther from (u, v)
    for (int step = 0; step < 64; ++step) {
      const CubicAt<Real> at_u(u), at_v(v);
      const Value<Real> a = ValueOf(part.a, at_u, at_v), b = ValueOf(part.b, at_u, at_v);
      const Matrix2<Real> back = Inverse(Matrix2<Real>{a.du, a.dv, b.du, b.dv});
      const Real free_u = u - (back.xx * a.f + back.xy * b.f);
      const Real free_v = v - (back.yx * a.f + back.yy * b.f);
      const Real next_u = std::clamp(free_u, -margin_u, 1 + margin_u);
      const Real next_v = std::clamp(free_v, -margin_v, 1 + margin_v);
      reach *= 2 * kBend<Real> / (1 - kBend<Real>);
      if (std::max(std::abs(free_u - next_u), std::abs(free_v - next_v)) > reach) return;
      const Real moved = std::max(std::abs(next_u - u), std::abs(next_v - v));
      u = next_u;
      v = next_v;
      if (moved <= 16 * kEpsilon) break;
    }
    const CubicAt<Real> at_u(u), at_v(v);
    const Real a = ValueOf(part.a, at_u, at_v).f, b = ValueOf(part.b, at_u, at_v).f;
    if (std::abs(a) <= 2 * slack_ && std::abs(b) <= 2 * slack_) Meet(part, u, v);
  }

  /// (u, v) within the part: keeps it if it is the nearest so far.
  void Meet(const Part<Real>& part, Real u, Real v) {
    const Real t = ValueOf(part.t, CubicAt<Real>(u), CubicAt<Real>(v)).f;
    if (!(t > 0 && t <= best_.t)) return;
    const Real whole_u = part.u + part.u_size * u, whole_v = part.v + part.v_size * v;
    best_ = {t, std::clamp(whole_u, Real{0}, Real{1}), std::clamp(whole_v, Real{0}, Real{1})};
    met_ = true;
  }

  std::array<Part<Real>, kMostPending> pending_;
  int count_ = 0;
  Real slack_;  // rounding error of plane distances
  PatchHit<Real> best_;
  bool met_ = false;
};

/// Symmetric: the same bits if the points and the parameter are turned around.
template <class Real>
Vec<Real> CurvePoint(const Vec<Real>* p, Parameter<Real> at) {
  if (p[0] == p[1] && p[0] == p[2] && p[0] == p[3]) return p[0];
  const Real t = at.value, s = at.complement;
  return (p[0] * (s * s * s) + p[3] * (t * t * t)) +
         (p[1] * (3 * (s * s * t)) + p[2] * (3 * (t * t * s)));
}

/// A third of the derivative; exact zero where the points are equal.
template <class Real>
Vec<Real> CurveSlope(const Vec<Real>* p, Parameter<Real> at) {
  const Real t = at.value, s = at.complement;
  return (p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * (s * t)) + (p[3] - p[2]) * (t * t);
}

/// Any direction across, for patches that have no tangent plane at a place.
template <class Real>
Vec<Real> NetNormal(const Patch<Real>& patch) {
  const Vec<Real> across =
      Cross(patch.control[15] - patch.control[0], patch.control[12] - patch.control[3]);
  const Real length = Length(across);
  return length > 0 ? across * (1 / length) : Vec<Real>{0, 0, 1};
}

}  // namespace

template <class Real>
PatchHit<Real> IntersectPatch(const Patch<Real>& patch, const Ray<Real>& ray, Real max_t) {
  return PatchWalk<Real>(patch, ray, max_t).Nearest();
}

template <class Real>
PatchPoint<Real> PointOn(const Patch<Real>& patch, Parameter<Real> u, Parameter<Real> v) {
  Vec<Real> row[4], row_slope[4];
  for (std::size_t i = 0; i < 4; ++i) {
    row[i] = CurvePoint(patch.control + 4 * i, u);
    row_slope[i] = CurveSlope(patch.control + 4 * i, u);
  }
  Vec<Real> along_u = CurvePoint(row_slope, v), along_v = CurveSlope(row, v);
  // On an edge that is one point the tangent grows from zero as the edge is left: its direction is
  // that of the mixed derivative.
  if (MaxNorm(along_u) == 0)
    along_u = CurveSlope(row_slope, v) * (v.value < v.complement ? Real{1} : Real{-1});
  else if (MaxNorm(along_v) == 0)
    along_v = CurveSlope(row_slope, v) * (u.value < u.complement ? Real{1} : Real{-1});
  const Vec<Real> across = Cross(along_u, along_v);
  const Real length = Length(across);
  return {CurvePoint(row, v), length > 0 ? across * (1 / length) : NetNormal(patch)};
}

template PatchHit<float> IntersectPatch(const Patch<float>&, const Ray<float>&, float);
template PatchPoint<float> PointOn(const Patch<float>&, Parameter<float>, Parameter<float>);
template PatchHit<double> IntersectPatch(const Patch<double>&, const Ray<double>&, double);
template PatchPoint<double> PointOn(const Patch<double>&, Parameter<double>, Parameter<double>);
template PatchHit<long double> IntersectPatch(const Patch<long double>&, const Ray<long double>&,
                                              long double);
template PatchPoint<long double> PointOn(const Patch<long double>&, Parameter<long double>,
                                         Parameter<long double>);

}  // namespace stipple::raytracer
