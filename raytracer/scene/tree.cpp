// SPDX-License-Identifier: MIT
// SPD's tree, grown as M. Aono and T. Kunii describe ("Botanical Tree Image Generation", IEEE CG&A
// 4(5), 1984): each branch is a cone with a ball at its tip and carries two shorter, thinner
// branches.
#include <cmath>
#include <numbers>

#include "raytracer/scene/generate.h"
#include "raytracer/scene/matrix.h"

namespace stipple::raytracer {
namespace {

constexpr double kTrunkRadius = 0.15;
constexpr double kThinning =
    0.67;  // radius of a branch over that of its parent, and of its tip over its base
constexpr double kFieldHalf = 50;

struct Fork {
  double turn_deg;  // about the parent, before leaning
  double lean_deg;
  double length;  // over the parent's
};
constexpr Fork kForks[] = {{0, 40, 0.65}, {140, 25, 0.70}};

struct Grower {
  ShapeStream& shapes;
  Matrix fork[2];  // the frame of a child in that of its parent

  explicit Grower(ShapeStream& all) : shapes(all) {
    constexpr double kRadians = std::numbers::pi / 180;
    for (int i = 0; i < 2; ++i)
      fork[i] = RotationZ(kForks[i].turn_deg * kRadians) *
                RotationY(kForks[i].lean_deg * kRadians) * Scaling(kForks[i].length) *
                RotationZ(std::numbers::pi / 2);
  }

  void Grow(const Matrix& frame, Vec3 base, double radius, int levels_left) {
    const Vec3 tip = base + frame.z;
    shapes.AddCone(base, radius, tip, radius * kThinning, 1);
    shapes.AddSphere(tip, radius * kThinning, 1);
    if (levels_left == 0) return;
    for (const Matrix& child : fork) Grow(frame * child, tip, radius * kThinning, levels_left - 1);
  }
};

}  // namespace

double TreeObjects(double size) { return 1 + 2 * (std::pow(2, size + 1) - 1); }

Scene Tree(int size, const TakeShapes& take) {
  Scene scene;
  ShapeStream shapes(scene.shapes, take);
  scene.background = kSpdBackground;
  scene.view = {{4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1}, 45, 1, {512, 512}};
  scene.lights = {{{-5, 5, 50}},   {{30, -30, 30}}, {{-40, -30, 20}}, {{10, 30, 40}},
                  {{-30, 40, 10}}, {{50, 25, 20}},  {{-10, -60, 30}}};
  scene.materials = {{{0.2, 0.7, 0.2}, 1, 0, kMatteShine, 0, 0},
                     {{0.55, 0.4, 0.2}, 1, 0, kMatteShine, 0, 0}};
  const auto half = static_cast<std::size_t>(TreeObjects(size)) / 2;
  shapes.Expect(half, half, 1);
  const double f = kFieldHalf;
  const Vec3 field[] = {{f, f, 0}, {-f, f, 0}, {-f, -f, 0}, {f, -f, 0}};
  shapes.AddPolygon(field, {}, 0);
  Grower(shapes).Grow({}, {0, 0, 0}, kTrunkRadius, size);
  return scene;
}

}  // namespace stipple::raytracer
