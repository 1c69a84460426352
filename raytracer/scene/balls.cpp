// SPDX-License-Identifier: MIT
// SPD's sphereflake: a ball carries nine balls of a third of its size, each of which carries nine,
// and so on.
#include <array>
#include <cmath>
#include <numbers>

#include "raytracer/scene/generate.h"
#include "raytracer/scene/matrix.h"

namespace stipple::raytracer {
namespace {

constexpr double kFloorHalf = 12;
constexpr double kRootRadius = 0.5;

/// Directions to the nine children of a ball whose own direction is +z: three triples, a third of a
/// turn apart.
std::array<Vec3, 9> ChildDirections() {
  const double d = std::numbers::sqrt2 / 2;
  // Tips the corner of a cube onto the z axis.
  const Matrix tip = RotationAbout({d, -d, 0}, std::sqrt(1.0 / 3), std::sqrt(2.0 / 3));
  const std::array<Vec3, 3> triple{tip * Vec3{d, d, 0}, tip * Vec3{d, 0, -d}, tip * Vec3{0, d, -d}};
  std::array<Vec3, 9> directions;
  for (std::size_t set = 0; set < 3; ++set) {
    const Matrix turn = RotationZ(static_cast<double>(set) * 2 * std::numbers::pi / 3);
    for (std::size_t i = 0; i < 3; ++i) directions[3 * set + i] = turn * triple[i];
  }
  return directions;
}

/// Turns +z to `direction` by the shortest way; to -z, where every way is as short, about the y
/// axis as SPD does. Directions carry the rounding of all levels above, so -z means within a
/// billionth of it.
Matrix TurnTo(Vec3 direction) {
  const Vec3 axis = Cross({0, 0, 1}, direction);
  const double sine = Length(axis);
  if (sine < 1e-9) return direction.z > 0 ? Matrix{} : RotationY(std::numbers::pi);
  return RotationAbout(axis * (1 / sine), direction.z, sine);
}

struct Flake {
  ShapeStream& shapes;
  std::array<Vec3, 9> directions = ChildDirections();

  void Add(Vec3 center, double radius, Vec3 direction, int levels_left) {
    shapes.AddSphere(center, radius, 1);
    if (levels_left == 0) return;
    const Matrix turn = TurnTo(direction);
    const double child_radius = radius / 3;
    for (const Vec3& child : directions) {
      const Vec3 to_child = turn * child;
      Add(center + to_child * (radius + child_radius), child_radius, to_child, levels_left - 1);
    }
  }
};

}  // namespace

double BallsObjects(double size) { return 1 + (std::pow(9, size + 1) - 1) / 8; }

Scene Balls(int size, const TakeShapes& take) {
  Scene scene;
  ShapeStream shapes(scene.shapes, take);
  scene.background = kSpdBackground;
  scene.view = {{2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 45, 0.01, {512, 512}};
  scene.lights = {{{4, 3, 2}}, {{1, -4, 4}}, {{-3, 1, 5}}};
  scene.materials = {{{1, 0.75, 0.33}, 0.8, 0, kMatteShine, 0, 1},
                     {{1, 0.9, 0.7}, 0.5, 0.5, 3.0827, 0, 1}};
  shapes.Expect(static_cast<std::size_t>(BallsObjects(size)) - 1, 0, 1);
  const double f = kFloorHalf;
  const Vec3 floor[] = {{f, f, -0.5}, {-f, f, -0.5}, {-f, -f, -0.5}, {f, -f, -0.5}};
  shapes.AddPolygon(floor, {}, 0);
  Flake{shapes}.Add({0, 0, 0}, kRootRadius, {0, 0, 1}, size);
  return scene;
}

}  // namespace stipple::raytracer
