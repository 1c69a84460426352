// SPDX-License-Identifier: MIT
// The rules of shading one by one, on scenes whose answer is a formula.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/raytracer/render/one_ray.h"

namespace stipple::raytracer {
namespace {

constexpr Material kMatte{.diffuse = 1};

Material Glass(double index, int priority = 0) {
  return {.diffuse = 0, .transmission = 1, .refraction = index, .priority = priority};
}
double Radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// A floor at z = -4 with a light 1 above it: the brightness of a point tells how far it is from
/// the light's foot, so that what bends a ray can be measured.
Scene Bench() {
  Scene scene;
  scene.lights = {{{0, 0, -3}}};
  AddWall(scene, 2, -4, true, kMatte);
  return scene;
}
double DistanceOnBench(const OneRay& ray, double throughput = 1) {
  const double cosine = ray.color().x / throughput / 0.5;  // one light is scaled by 1/2
  return std::sqrt(1 / (cosine * cosine) - 1);
}

TEST(Rules, AGlassSlabShiftsARayBySnellsLaw) {
  for (const double index : {1.0, 1.33, 1.5, 2.4})
    for (const double degrees : {5.0, 30.0, 60.0, 75.0}) {
      Scene scene = Bench();
      AddWall(scene, 2, 0, true, Glass(index));
      AddWall(scene, 2, -1, false, Glass(index));
      const double angle = Radians(degrees);
      const double inside = std::asin(std::sin(angle) / index);
      const OneRay ray =
          TraceOne(scene, {-std::tan(angle), 0, 1}, {std::sin(angle), 0, -std::cos(angle)});
      EXPECT_EQ(ray.counts.refracted_rays, 2U);
      EXPECT_NEAR(DistanceOnBench(ray), std::tan(inside) + 3 * std::tan(angle), 1e-5)
          << index << ' ' << degrees;
    }
}

TEST(Rules, AGlassSphereTurnsARayTwiceTheSameWay) {
  for (const double index : {1.2, 1.5})
    for (const double across : {0.1, 0.5, 0.9}) {
      Scene scene = Bench();
      scene.materials.push_back(Glass(index));
      scene.shapes.AddSphere({0, 0, 0}, 1, 1);
      const double outside = std::asin(across), inside = std::asin(across / index);
      const double turned = 2 * (outside - inside);
      // The ray leaves where the chord that it entered on ends.
      const double at = outside + 2 * (std::numbers::pi / 2 - inside);
      const Vec3 leaves{std::sin(outside + std::numbers::pi - 2 * inside), 0, std::cos(at)};
      const double exit_z = std::cos(outside + std::numbers::pi - 2 * inside);
      const double expected = leaves.x - (exit_z + 4) * std::tan(turned);
      const OneRay ray = TraceOne(scene, {across, 0, 5}, {0, 0, -1});
      EXPECT_NEAR(DistanceOnBench(ray), std::abs(expected), 1e-5) << index << ' ' << across;
    }
}

TEST(Rules, OnTotalInternalReflectionTheReflectedRayTakesAll) {
  Scene scene = Bench();
  const Material glass{
      .diffuse = 0, .specular = 0.25, .shine = 1e6, .transmission = 0.5, .refraction = 1.5};
  AddWall(scene, 2, 0, true, glass);
  const double critical = std::asin(1 / 1.5);
  for (const double angle : {critical - 1e-6, critical + 1e-6, critical + 0.5}) {
    const OneRay ray =
        TraceOne(scene, {-std::tan(angle), 0, -1}, {std::sin(angle), 0, std::cos(angle)});
    const bool total = angle > critical;
    EXPECT_EQ(ray.counts.refracted_rays, total ? 0U : 1U);
    EXPECT_EQ(ray.counts.reflected_rays, 1U);
    EXPECT_NEAR(DistanceOnBench(ray, total ? 0.75 : 0.25), 4 * std::tan(angle), 1e-5);
  }
}

/// A ray that runs in water at `degrees` to the vertical comes to a horizontal glass surface; how
/// far from straight down it meets a floor 3 below.
double WaterToGlass(double degrees, int water_priority, int glass_priority) {
  Scene scene = Bench();
  AddWall(scene, 0, -0.5, false, Glass(1.33, water_priority));
  AddWall(scene, 2, -1, true, Glass(1.5, glass_priority));
  const double angle = Radians(degrees);
  const Vec3 in_water{std::sin(angle), 0, -std::cos(angle)};
  const Vec3 enters = Vec3{0, 0, -1} - in_water * (0.5 / in_water.x);
  const double steepness = std::asin(1.33 * std::cos(angle));  // in air, to the horizontal
  const Vec3 in_air{std::cos(steepness), 0, -std::sin(steepness)};
  return DistanceOnBench(TraceOne(scene, enters - in_air, in_air));
}

// Under NFF's rule the glass is entered as if from air: wrong by 2.2 degrees at 10, by 17.6 at 70.
TEST(Rules, MediaWithPrioritiesKnowWhatIsAroundThem) {
  for (const double degrees : {50.0, 60.0, 70.0}) {
    const double sine = std::sin(Radians(degrees));
    EXPECT_NEAR(WaterToGlass(degrees, 1, 2), 3 * std::tan(std::asin(sine * 1.33 / 1.5)), 1e-5);
    EXPECT_NEAR(WaterToGlass(degrees, 0, 0), 3 * std::tan(std::asin(sine / 1.5)), 1e-5);
  }
  const auto refracted = [](int water, int glass) {
    return std::atan(WaterToGlass(70, water, glass) / 3) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(refracted(1, 2) - refracted(0, 0), 17.6, 0.05);
}

// Glass from -1 to -2 in water from 0 to -1.5: the water's lower side lies inside the glass.
TEST(Rules, WhereMediaOverlapTheHigherPriorityCounts) {
  for (const auto& [water, glass] : {std::pair{1, 2}, std::pair{2, 1}}) {
    Scene scene = Bench();
    AddWall(scene, 2, 0, true, Glass(1.33, water));
    scene.materials.push_back(scene.materials.back());
    AddWall(scene, 2, -1, true, Glass(1.5, glass));
    const auto glass_material = static_cast<std::uint32_t>(scene.materials.size() - 1);
    AddWall(scene, 2, -1.5, false, {});
    scene.shapes.objects.back().material = 1;  // the water's
    AddWall(scene, 2, -2, false, {});
    scene.shapes.objects.back().material = glass_material;
    const double angle = Radians(40);
    const double in_water = std::tan(std::asin(std::sin(angle) / 1.33));
    const double in_glass = std::tan(std::asin(std::sin(angle) / 1.5));
    const double water_depth = water > glass ? 1.5 : 1;
    const OneRay ray =
        TraceOne(scene, {-std::tan(angle), 0, 1}, {std::sin(angle), 0, -std::cos(angle)});
    EXPECT_EQ(ray.counts.refracted_rays, 3U);  // the fourth surface is none
    EXPECT_NEAR(DistanceOnBench(ray),
                water_depth * in_water + (2 - water_depth) * in_glass + 2 * std::tan(angle), 1e-5);
  }
}

// Two mirrors that end at x = 10: a ray at 45 degrees meets each once per 2 and then sees the sky.
TEST(Rules, BetweenTwoMirrorsEachReflectionTakesItsShare) {
  Scene scene;
  scene.background = {1, 0.5, 0};
  scene.materials = {{.diffuse = 0, .specular = 0.75}};
  for (const double z : {0.0, 1.0})
    scene.shapes.AddPolygon(std::vector<Vec3>{{-1, -1, z}, {10, -1, z}, {10, 1, z}, {-1, 1, z}}, {},
                            0);
  for (int reflections = 1; reflections <= 10; ++reflections) {
    const Vec3 from{9.5 - reflections, 0, 0.999};
    const OneRay all = TraceOne(scene, from, {1, 0, -1}, {64, 0});
    EXPECT_EQ(all.counts.reflected_rays, static_cast<unsigned>(reflections));
    EXPECT_NEAR(all.color().x, std::pow(0.75, reflections), 1e-9);
    EXPECT_NEAR(all.color().y, 0.5 * std::pow(0.75, reflections), 1e-9);
    EXPECT_EQ(all.result.lost, 0);
    const OneRay five = TraceOne(scene, from, {1, 0, -1}, {5, 0});
    EXPECT_EQ(five.counts.reflected_rays, static_cast<unsigned>(std::min(reflections, 4)));
    EXPECT_EQ(five.result.color.red > 0, reflections <= 4);
    EXPECT_EQ(five.result.lost > 0, reflections > 4);
    const OneRay cut = TraceOne(scene, from, {1, 0, -1}, {64, 0.4});  // 0.75^3 = 0.42
    EXPECT_EQ(cut.counts.reflected_rays, static_cast<unsigned>(std::min(reflections, 3)));
  }
}

TEST(Rules, HighlightsFollowPhong) {
  Scene scene;
  scene.lights = {{{3, 0, 4}, {1, 0.5, 0.25}, true}};
  AddWall(scene, 2, 0, true, {{0.5, 1, 1}, 0.6, 0.3, 7});
  const double angle = Radians(30);
  const OneRay ray =
      TraceOne(scene, {-std::tan(angle), 0, 1}, {std::sin(angle), 0, -std::cos(angle)}, {1, 0});
  const double mirrored = std::sin(angle) * 0.6 + std::cos(angle) * 0.8;
  const double highlight = 0.3 * std::pow(mirrored, 7);
  EXPECT_NEAR(ray.color().x, 0.5 * (0.5 * 0.6 * 0.8 + highlight), 1e-9);
  EXPECT_NEAR(ray.color().y, 0.5 * 0.5 * (0.6 * 0.8 + highlight), 1e-9);
  EXPECT_NEAR(ray.color().z, 0.5 * 0.25 * (0.6 * 0.8 + highlight), 1e-9);
}

TEST(Rules, LightsAreScaledByTheirNumber) {
  Scene scene;
  scene.lights = {{{0, 0, 4}, {1, 0, 0}, true}, {{0, 0, 9}, {0, 1, 0}, true}, {{0, 0, -5}}};
  AddWall(scene, 2, 0, true, kMatte);
  const OneRay ray = TraceOne(scene, {0.1, 0, 1}, {-0.1, 0, -1});
  EXPECT_NEAR(ray.color().x, std::sqrt(3.0) / 6, 1e-9);
  EXPECT_NEAR(ray.color().y, std::sqrt(3.0) / 6, 1e-9);
  EXPECT_EQ(ray.color().z, 0);
  EXPECT_EQ(ray.counts.shadow_rays, 2U);  // none to the light that the floor faces away from
}

TEST(Rules, ShadingNormalsAreInterpolated) {
  Scene scene;
  scene.lights = {{{0, 0, 1e9}}};
  scene.materials = {kMatte};
  const std::vector<Vec3> normals{{0, 0, 1}, Normalized(Vec3{1, 0, 1}), Normalized(Vec3{0, 1, 1})};
  scene.shapes.AddPolygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals, 0);
  const OneRay ray = TraceOne(scene, {0.25, 0.5, 1}, {0, 0, -1});
  const Vec3 normal = Normalized(normals[0] * 0.25 + normals[1] * 0.25 + normals[2] * 0.5);
  EXPECT_NEAR(ray.color().x, 0.5 * normal.z, 1e-8);
}

TEST(Rules, ALightWithARadiusIsSeenInItsColour) {
  Scene scene;
  scene.background = {0, 0, 1};
  scene.lights = {{{0, 0, 4}, {0.5, 1, 0.25}, true, 0.5}};
  AddWall(scene, 2, 0, true, {.diffuse = 0.5, .specular = 0.25, .shine = 1e5});
  const Vec3 color{0.5, 1, 0.25};
  EXPECT_EQ(TraceOne(scene, {0.4, 0, 2}, {0, 0, 1}).color(), color);
  EXPECT_EQ(TraceOne(scene, {0.6, 0, 2}, {0, 0, 1}).color(), (Vec3{0, 0, 1}));
  EXPECT_EQ(TraceOne(scene, {0, 0, 2}, {0, 0, 1}).counts.eye_hits, 0U);
  // In the mirror a quarter of it, on the floor as if it were a point.
  const OneRay mirrored = TraceOne(scene, {-0.2, 0, 1}, {0.1, 0, -1});
  const double lambert = 0.5 * 0.5 * 4 / std::sqrt(16 + 0.01);
  EXPECT_NEAR(mirrored.color().x, 0.25 * 0.5 + 0.5 * lambert, 1e-9);
  EXPECT_NEAR(mirrored.color().y, 0.25 + lambert, 1e-9);
  EXPECT_EQ(mirrored.counts.shadow_rays, 1U);
  // What stands before it hides it.
  scene.shapes.AddSphere({0, 0, 3}, 0.2, 0);
  EXPECT_LT(TraceOne(scene, {0, 0, 2}, {0, 0, 1}).color().x, 0.5);
  EXPECT_EQ(TraceOne(scene, {0.4, 0, 2}, {0, 0, 1}).color(), color);
  scene.lights[0].radius = 0;
  EXPECT_EQ(TraceOne(scene, {0.4, 0, 2}, {0, 0, 1}).color(), (Vec3{0, 0, 1}));
}

TEST(Rules, SceneThatUsesLessLooksTheSameByRulesForMore) {
  Scene opaque = Bench();
  opaque.materials[0].specular = 0.5;
  opaque.shapes.AddSphere({0.5, 0, -3.5}, 0.4, 0);
  EXPECT_EQ(RulesOf(opaque), Rules::kOpaque);
  Scene glass = opaque;
  glass.materials.push_back(Glass(1.5));
  glass.shapes.AddSphere({0, 0, -1}, 0.6, 1);
  EXPECT_EQ(RulesOf(glass), Rules::kTransmitting);
  for (double x = -1; x < 1; x += 0.09) {
    const Vec3 from{x, 0.05, 1}, down{0.1, 0, -1};
    const OneRay plain = TraceBy<Rules::kOpaque>(opaque, from, down);
    EXPECT_EQ(plain.result.color, TraceBy<Rules::kTransmitting>(opaque, from, down).result.color);
    EXPECT_EQ(plain.result.color, TraceBy<Rules::kExtended>(opaque, from, down).result.color);
    EXPECT_EQ(TraceBy<Rules::kTransmitting>(glass, from, down).result.color,
              TraceBy<Rules::kExtended>(glass, from, down).result.color);
  }
}

}  // namespace
}  // namespace stipple::raytracer
