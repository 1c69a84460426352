// SPDX-License-Identifier: MIT
// Random rays for trials: the same numbers on every machine, which the distributions of the
// standard library do not promise. Everything is long double; a trial rounds it to what it tries.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_RANDOM_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_RANDOM_H

#include <random>

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

using WideVec = Vec<long double>;

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  /// At least `low`, below `high`.
  long double Between(long double low, long double high) {
    return low + (high - low) * static_cast<long double>(bits_() >> 11) * 0x1p-53L;
  }
  int Below(int count) { return static_cast<int>(Between(0, count)); }

  /// Of length 1, all directions alike.
  WideVec Direction() {
    for (;;) {
      const WideVec v{Between(-1, 1), Between(-1, 1), Between(-1, 1)};
      const long double square = Dot(v, v);
      if (square > 0.01L && square <= 1) return v * (1 / std::sqrt(square));
    }
  }
  /// Of length 1, at least `cosine` of the way along `axis`.
  WideVec DirectionAround(WideVec axis, long double cosine) {
    for (;;) {
      const WideVec v = Direction();
      if (Dot(v, axis) > cosine) return v;
    }
  }

 private:
  std::mt19937_64 bits_;
};

template <class To, class From>
Vec<To> Rounded(Vec<From> v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
}

/// Three directions at right angles.
struct Axes {
  WideVec x, y, z;

  explicit Axes(WideVec up) : z(up) {
    x = Normalized(Cross(std::abs(z.x) < 0.5L ? WideVec{1, 0, 0} : WideVec{0, 1, 0}, z));
    y = Cross(z, x);
  }
  WideVec At(WideVec local) const { return x * local.x + y * local.y + z * local.z; }
};

/// A ray whose numbers are all of kind `Real`; its direction's length is as near to 1 as that
/// allows.
template <class Real>
Ray<Real> RoundedRay(WideVec from, WideVec to) {
  const Vec<Real> origin = Rounded<Real>(from);
  return {origin, Rounded<Real>(Normalized(to - Rounded<long double>(origin)))};
}

}  // namespace stipple::raytracer

#endif
