// SPDX-License-Identifier: MIT
// Vectors of three numbers: points, directions and colours of the ray tracer. Everything here is
// inline and small. `Real` is float, double or long double: scenes are double, kernels are any.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_VEC_H
#define STIPPLE_RAYTRACER_GEOMETRY_VEC_H

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace stipple::raytracer {

template <class Real>
struct Vec {
  Real x = 0, y = 0, z = 0;

  friend bool operator==(const Vec&, const Vec&) = default;
};
using Vec3 = Vec<double>;

/// A scalar beside a vector: converts to the vector's kind of number and does not decide it.
template <class Real>
using Scalar = std::type_identity_t<Real>;

template <class Real>
inline Vec<Real> operator+(Vec<Real> a, Vec<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
inline Vec<Real> operator-(Vec<Real> a, Vec<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
inline Vec<Real> operator-(Vec<Real> a) {
  return {-a.x, -a.y, -a.z};
}
template <class Real>
inline Vec<Real> operator*(Vec<Real> a, Scalar<Real> s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
inline Vec<Real> operator*(Scalar<Real> s, Vec<Real> a) {
  return a * s;
}
/// Component by component, as colours are filtered.
template <class Real>
inline Vec<Real> operator*(Vec<Real> a, Vec<Real> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

template <class Real>
inline Real Dot(Vec<Real> a, Vec<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
inline Vec<Real> Cross(Vec<Real> a, Vec<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
inline Real Length(Vec<Real> a) {
  return std::sqrt(Dot(a, a));
}
template <class Real>
inline Vec<Real> Normalized(Vec<Real> a) {
  return a * (1 / Length(a));
}

/// The largest magnitude among the components.
template <class Real>
inline Real MaxNorm(Vec<Real> a) {
  return std::max(std::abs(a.x), std::max(std::abs(a.y), std::abs(a.z)));
}
template <class Real>
inline Vec<Real> Min(Vec<Real> a, Vec<Real> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class Real>
inline Vec<Real> Max(Vec<Real> a, Vec<Real> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class Real>
inline bool IsFinite(Vec<Real> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// A half line; `direction` has length 1, so distances along it are distances in the scene.
template <class Real>
struct Ray {
  Vec<Real> origin;
  Vec<Real> direction;
};

}  // namespace stipple::raytracer

#endif
