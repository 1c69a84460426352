// SPDX-License-Identifier: MIT
// Intersections whose answer is known in closed form.
#include "raytracer/geometry/intersect.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "raytracer/geometry/surface.h"

namespace stipple::raytracer {
namespace {

Ray<double> Towards(Vec3 from, Vec3 to) { return {from, Normalized(to - from)}; }

TEST(Intersect, SphereFromOutsideInsideAndBeyond) {
  const Sphere<double> sphere{{0, 0, 0}, 2};
  EXPECT_DOUBLE_EQ(IntersectSphere(sphere, {{0, 0, 10}, {0, 0, -1}}), 8);
  EXPECT_DOUBLE_EQ(IntersectSphere(sphere, {{0, 0, 1}, {0, 0, -1}}), 3);
  EXPECT_DOUBLE_EQ(IntersectSphere(sphere, {{0, 0, 1}, {0, 0, 1}}), 1);
  EXPECT_EQ(IntersectSphere(sphere, {{0, 0, 10}, {0, 0, 1}}), kMiss<double>);
  EXPECT_EQ(IntersectSphere(sphere, {{2.001, 0, 10}, {0, 0, -1}}), kMiss<double>);
  EXPECT_DOUBLE_EQ(IntersectSphere<double>({{0, 0, 0}, -2}, {{0, 0, 10}, {0, 0, -1}}), 8);
}

TEST(Intersect, AFarSphereKeepsItsDigits) {
  for (const double distance : {1e2, 1e4, 1e6}) {
    const Sphere<double> sphere{{0, 0, -distance}, 1};
    const double t = IntersectSphere(sphere, {{0.6, 0, 0}, {0, 0, -1}});
    EXPECT_NEAR(t, distance - 0.8, 1e-15 * distance) << distance;
  }
}

Cone<double> ConeOf(Vec3 base, double base_radius, Vec3 apex, double apex_radius) {
  Shapes shapes;
  shapes.AddCone(base, base_radius, apex, apex_radius, 0);
  return shapes.cones[0];
}

TEST(Intersect, CylinderSideWithoutEnds) {
  const Cone<double> cylinder = ConeOf({0, 0, 0}, 1, {0, 0, 4}, 1);
  EXPECT_DOUBLE_EQ(IntersectCone(cylinder, {{5, 0, 2}, {-1, 0, 0}}), 4);
  EXPECT_DOUBLE_EQ(IntersectCone(cylinder, {{0, 0, 2}, {-1, 0, 0}}), 1);
  EXPECT_EQ(IntersectCone(cylinder, {{5, 0, 4.5}, {-1, 0, 0}}), kMiss<double>);
  // Down the middle: in at one open end, out at the other.
  EXPECT_EQ(IntersectCone(cylinder, {{0.5, 0, 9}, {0, 0, -1}}), kMiss<double>);
  // In at the open top, to the wall inside: from (0, 0, 5) to (1, 0, 2).
  EXPECT_DOUBLE_EQ(IntersectCone(cylinder, Towards({0, 0, 5}, {1, 0, 2})), std::sqrt(10.0));
}

TEST(Intersect, ConeToItsTip) {
  const Cone<double> cone = ConeOf({0, 0, 0}, 1, {0, 0, 2}, 0);
  EXPECT_DOUBLE_EQ(IntersectCone(cone, {{5, 0, 1}, {-1, 0, 0}}), 4.5);
  EXPECT_EQ(IntersectCone(cone, {{5, 0, 3}, {-1, 0, 0}}),
            kMiss<double>);  // the other nappe is not there
  EXPECT_DOUBLE_EQ(IntersectCone(cone, {{0.5, 0, 9}, {0, 0, -1}}), 8);
  // Parallel to the side, so that one root is at infinity; the other is where x = -0.75, z = 0.5.
  EXPECT_DOUBLE_EQ(IntersectCone(cone, {{-1, 0, 1}, Normalized(Vec3{1, 0, -2})}),
                   0.25 * std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(IntersectCone(cone, {{-2, 0, 3}, Normalized(Vec3{1, 0, -2})}),
                   1.25 * std::sqrt(5.0));
}

TEST(Intersect, FrustumAtADistanceKeepsItsDigits) {
  const Cone<double> frustum = ConeOf({0, 0, 0}, 2, {0, 0, 2}, 1);
  for (const double distance : {1e1, 1e3, 1e5})
    EXPECT_NEAR(IntersectCone(frustum, {{distance, 0, 1}, {-1, 0, 0}}), distance - 1.5,
                4e-16 * distance + 1e-14);
}

TEST(Intersect, ConcavePolygonHasItsNotch) {
  // An L of width 1 in the square from 0 to 4.
  const std::array<Vec3, 6> corners{
      {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}, {0, 4, 0}}};
  Shapes shapes;
  shapes.AddPolygon(corners, {}, 0);
  const auto hit = [&](double x, double y) {
    return IntersectPolygon<double>(shapes.polygons[0], shapes.outlines, {{x, y, 3}, {0, 0, -1}});
  };
  EXPECT_DOUBLE_EQ(hit(0.5, 3.5), 3);
  EXPECT_DOUBLE_EQ(hit(3.5, 0.5), 3);
  EXPECT_DOUBLE_EQ(hit(0.5, 0.5), 3);
  EXPECT_EQ(hit(2, 2), kMiss<double>);
  EXPECT_EQ(hit(-0.5, 2), kMiss<double>);
  EXPECT_EQ(hit(2, 4.5), kMiss<double>);
}

TEST(Intersect, PolygonInAnyPlane) {
  for (const Vec3 normal : {Vec3{1, 0.2, 0.1}, Vec3{-0.1, 1, 0.3}, Vec3{0.2, 0.1, -1}}) {
    const Vec3 n = Normalized(normal);
    const Vec3 u = Normalized(Cross(n, {0.3, 0.4, 0.5}));
    const Vec3 v = Cross(n, u);
    Shapes shapes;
    shapes.AddPolygon(std::array<Vec3, 4>{u + v, v - u, -(u + v), u - v}, {}, 0);
    const auto at = [&](Vec3 target) {
      return IntersectPolygon<double>(shapes.polygons[0], shapes.outlines,
                                      Towards(target + n * 2.0, target));
    };
    EXPECT_NEAR(at(u * 0.9 + v * 0.9), 2, 1e-14);
    EXPECT_EQ(at(u * 1.1), kMiss<double>);
    EXPECT_EQ(at(v * -1.1), kMiss<double>);
  }
}

Triangle<double> TriangleOf(Vec3 a, Vec3 b, Vec3 c) {
  Shapes shapes;
  shapes.AddPolygon(std::array<Vec3, 3>{a, b, c}, {}, 0);
  return shapes.triangles[0];
}

TEST(Intersect, TriangleDistanceAndWeights) {
  const Triangle<double> triangle = TriangleOf({0, 0, 1}, {2, 0, 1}, {0, 2, 1});
  const TriangleHit<double> hit =
      IntersectTriangle(triangle, ShearRay<double>({{0.5, 1, 5}, {0, 0, -1}}));
  EXPECT_DOUBLE_EQ(hit.t, 4);
  EXPECT_DOUBLE_EQ(hit.u, 0.25);
  EXPECT_DOUBLE_EQ(hit.v, 0.5);
  EXPECT_EQ(IntersectTriangle(triangle, ShearRay<double>({{1.5, 1.5, 5}, {0, 0, -1}})).t,
            kMiss<double>);
  EXPECT_EQ(IntersectTriangle(triangle, ShearRay<double>({{0.5, 1, 5}, {0, 0, 1}})).t,
            kMiss<double>);
}

TEST(Intersect, NoRaySlipsBetweenTrianglesThatShareAnEdgeOrCorner) {
  const Vec3 middle{0.1, 0.2, 0.3};
  constexpr int kFan = 7;
  std::array<Vec3, kFan> rim;
  for (int i = 0; i < kFan; ++i) {
    const double angle = 2 * std::numbers::pi * i / kFan;
    rim[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle), 0.1 * i};
  }
  int missed = 0;
  const auto test = [&](Vec3 target) {
    const ShearRay<double> ray(Towards({0.37, -0.81, 9.3}, target));
    bool hit = false;
    for (std::size_t i = 0; i < kFan; ++i)
      hit = hit || IntersectTriangle(TriangleOf(middle, rim[i], rim[(i + 1) % kFan]), ray).t <
                       kMiss<double>;
    missed += hit ? 0 : 1;
  };
  for (std::size_t i = 0; i < kFan; ++i)
    for (int step = 0; step < 1000; ++step) test(middle + (rim[i] - middle) * (step / 1001.0));
  EXPECT_EQ(missed, 0);
}

TEST(Normals, AreThoseOfTheShape) {
  Shapes shapes;
  shapes.AddSphere({0, 0, 0}, 2, 0);
  shapes.AddSphere({0, 0, 0}, -2, 0);
  shapes.AddCone({0, 0, 0}, 2, {0, 0, 2}, 1, 0);
  shapes.AddCone({0, 0, 0}, -1, {0, 0, 2}, -1, 0);
  const Model<double> model = BuildModel<double>(std::move(shapes));
  const auto normal = [&](std::uint32_t object, Vec3 at) {
    return NormalsAt<double>(model, {1, object, 0, 0}, at).face;
  };
  EXPECT_NEAR(normal(0, {2, 0, 0}).x, 1, 1e-15);
  EXPECT_NEAR(normal(1, {2, 0, 0}).x, -1, 1e-15);
  EXPECT_NEAR(normal(2, {1.5, 0, 1}).x, std::sqrt(0.8), 1e-15);
  EXPECT_NEAR(normal(2, {1.5, 0, 1}).z, std::sqrt(0.2), 1e-15);
  EXPECT_NEAR(normal(3, {1, 0, 1}).x, -1, 1e-15);
}

TEST(Normals, AreBlendedBetweenTheCornersOfAPatch) {
  const Vec3 left = Normalized(Vec3{-1, 0, 1}), right = Normalized(Vec3{1, 0, 1});
  Shapes shapes;
  shapes.AddPolygon(std::array<Vec3, 4>{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}},
                    std::array<Vec3, 4>{left, right, right, left}, 0);
  shapes.AddPolygon(std::array<Vec3, 3>{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}},
                    std::array<Vec3, 3>{left, right, left}, 0);
  const Model<double> model = BuildModel<double>(std::move(shapes));
  const Vec3 middle = NormalsAt<double>(model, {1, 0, 0, 0}, {1, 1, 0}).shading;
  EXPECT_NEAR(middle.x, 0, 1e-15);
  EXPECT_NEAR(middle.z, 1, 1e-15);
  EXPECT_NEAR(NormalsAt<double>(model, {1, 0, 0, 0}, {1e-9, 1, 0}).shading.x, left.x, 1e-8);
  EXPECT_NEAR(NormalsAt<double>(model, {1, 1, 0.5, 0}, {1, 0, 0}).shading.x, 0, 1e-15);
}

}  // namespace
}  // namespace stipple::raytracer
