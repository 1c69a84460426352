// SPDX-License-Identifier: MIT
// Rotations and scalings of the generated scenes.
#ifndef STIPPLE_RAYTRACER_SCENE_MATRIX_H
#define STIPPLE_RAYTRACER_SCENE_MATRIX_H

#include "raytracer/geometry/vec.h"

namespace stipple::raytracer {

/// A linear map by the images of the three axes.
struct Matrix {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

inline Vec3 operator*(const Matrix& m, Vec3 v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
inline Matrix operator*(const Matrix& a, const Matrix& b) { return {a * b.x, a * b.y, a * b.z}; }

inline Matrix RotationX(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{1, 0, 0}, {0, c, s}, {0, -s, c}};
}
inline Matrix RotationY(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}
inline Matrix RotationZ(double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}
inline Matrix Scaling(double factor) { return {{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}}; }

/// Rotation about `axis` (unit length) by the angle with this cosine and sine.
inline Matrix RotationAbout(Vec3 axis, double cosine, double sine) {
  const auto turn = [&](Vec3 v) {
    return v * cosine + Cross(axis, v) * sine + axis * (Dot(axis, v) * (1 - cosine));
  };
  return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

}  // namespace stipple::raytracer

#endif
