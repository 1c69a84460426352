// SPDX-License-Identifier: MIT
// SPD's rings: a pyramid of groups of six interlocking five-sided rings before a wall.
#include <cmath>
#include <numbers>

#include "raytracer/scene/generate.h"
#include "raytracer/scene/matrix.h"

namespace stipple::raytracer {
namespace {

constexpr double kTubeRadius = 0.07412;
constexpr double kRingRadius = 1 / (1 + kTubeRadius);
constexpr double kPi = std::numbers::pi;

constexpr Vec3 kColors[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};

/// Distance between the pyramid's levels: with it each level just fills the view's 45 degrees.
double LevelDistance() { return 1 / std::sin(kPi / 8); }

/// The rings of a group lie in the planes through the centre of a dodecahedron parallel to its
/// faces: one level, five tilted by the angle between faces.
Matrix RingFrame(int ring) {
  if (ring == 0) return {};
  return RotationZ((72 * ring - 36) * kPi / 180) * RotationX(std::acos(1 / std::sqrt(5.0)));
}

void AddRing(ShapeStream& shapes, Vec3 center, int ring) {
  const Matrix frame = RingFrame(ring);
  const auto corner = [&](int i) {
    const double angle = 2 * kPi * i / 5;
    return center + frame * Vec3{kRingRadius * std::cos(angle), kRingRadius * std::sin(angle), 0};
  };
  const auto material = static_cast<std::uint32_t>(1 + ring);
  for (int i = 0; i < 5; ++i) {
    shapes.AddCone(corner(i), kTubeRadius, corner((i + 4) % 5), kTubeRadius, material);
    shapes.AddSphere(corner(i), kTubeRadius, material);
  }
}

void AddWall(ShapeStream& shapes, int size) {
  const double y = (size + 1) * LevelDistance();
  const double half = 1.01 * (size + 2) * LevelDistance() * std::tan(kPi / 8);
  const double left = -1 - half, right = -1 + half, low = 0.5 - half, high = 0.5 + half;
  const Vec3 wall[] = {{right, y, high}, {left, y, high}, {left, y, low}, {right, y, low}};
  shapes.AddPolygon(wall, {}, 0);
}

}  // namespace

double RingsObjects(double size) { return 1 + 10 * size * (size + 1) * (2 * size + 1); }

Scene Rings(int size, const TakeShapes& take) {
  Scene scene;
  ShapeStream shapes(scene.shapes, take);
  const double eye_y = -LevelDistance();
  scene.background = kSpdBackground;
  scene.view = {{-1, eye_y, 0.5}, {-1, eye_y + 1, 0.5}, {0, 0, 1}, 45, 1, {512, 512}};
  scene.lights = {{{3, eye_y, 3}}, {{-4, eye_y, 1}}, {{2, eye_y, -4}}};
  scene.materials = {{{1, 1, 1}, 1, 0, kMatteShine, 0, 0}};
  for (const Vec3& color : kColors) scene.materials.push_back({color, 0.5, 0.2, 3.0827, 0, 0});
  const auto half = static_cast<std::size_t>(RingsObjects(size)) / 2;
  shapes.Expect(half, half, 1);
  AddWall(shapes, size);
  for (int level = 1; level <= size; ++level)
    for (int row = 0; row < level; ++row)
      for (int column = 0; column < level; ++column)
        for (int ring = 0; ring < 6; ++ring)
          AddRing(shapes,
                  {2.0 * column - (level - 1), level * LevelDistance(), 2.0 * row - (level - 1)},
                  ring);
  return scene;
}

View RingsAboveView(int size) {
  const double y = 0.5 * (size + 1) * LevelDistance();
  const double height = 4.3 * size + 3;
  return {{0, y, height}, {0, y, 0}, {0, 1, 0}, 45, 1, {512, 512}};
}

}  // namespace stipple::raytracer
