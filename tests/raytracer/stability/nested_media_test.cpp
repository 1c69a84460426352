// SPDX-License-Identifier: MIT
// Row H2: glass in water.
//
// NFF cannot say what surrounds a dielectric, and its rule is air: the ray from water into glass is
// bent as if it came from air, 2 degrees too much at 10 degrees and 18 at 70. That is the rule by
// default; media with priorities (render/media.h) are bent as they should be.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "raytracer/charts/rejected/refraction.h"
#include "tests/raytracer/stability/trace_picture.h"

namespace stipple::raytracer {
namespace {

constexpr double kWater = 1.33, kGlass = 1.5;
constexpr double kDegree = std::numbers::pi / 180;

TEST(NestedMedia, AreBentWrongByNffsRule) {
  const auto error_deg = [](double angle_deg) {
    const double sine = std::sin(angle_deg * kDegree);
    return (std::asin(rejected::SineFromMedium(sine, kWater, kGlass)) -
            std::asin(rejected::SineFromAir(sine, kGlass))) /
           kDegree;
  };
  EXPECT_NEAR(error_deg(10), 2.2, 0.1);
  EXPECT_NEAR(error_deg(70), 17.6, 0.1);
}

/// Keeps the directions of the rays that it is asked for.
class RecordingKernel final : public Kernel<double> {
 public:
  explicit RecordingKernel(const Kernel<double>& inner) : inner_(inner) {}

  Hit<double> Intersect(const Ray<double>& ray, TestCounts& tests) const override {
    sines_.push_back(Length(Cross(ray.direction, Vec3{0, 0, 1})));
    return inner_.Intersect(ray, tests);
  }
  bool Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const override {
    return inner_.Occluded(ray, max_t, tests);
  }
  /// Of the rays' angles with the z axis.
  const std::vector<double>& sines() const { return sines_; }

 private:
  const Kernel<double>& inner_;
  mutable std::vector<double> sines_;
};

/// Sines of the angles of a ray from air through water into glass, whose surfaces are horizontal.
std::vector<double> SinesThroughLayers(double angle_deg, int water_priority, int glass_priority) {
  const double tangent = std::tan(angle_deg * kDegree);
  Scene scene;
  scene.view = {{-tangent, 0, 1}, {0, 0, 0}, {0, 1, 0}, 1, 0, {1, 1}};
  scene.materials = {{{1, 1, 1}, 0, 0, 0, 1, kWater, water_priority},
                     {{1, 1, 1}, 0, 0, 0, 1, kGlass, glass_priority}};
  for (const std::uint32_t layer : {0U, 1U}) {
    const double z = -static_cast<double>(layer);
    scene.shapes.AddPolygon(
        std::vector<Vec3>{{-99, -99, z}, {99, -99, z}, {99, 99, z}, {-99, 99, z}}, {}, layer);
  }
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const auto kernel = MakeKernel("bvh", model);
  const RecordingKernel recording(*kernel);
  const auto sampler = MakeSampler(scene, model, recording, {}, {1, 1}, {1});
  sampler->Sample(0);
  return recording.sines();
}

TEST(NestedMedia, AreInAirWithoutPriorities) {
  const std::vector<double> sines = SinesThroughLayers(60, 0, 0);
  ASSERT_EQ(sines.size(), 3U);
  EXPECT_NEAR(sines[1], sines[0] / kWater, 1e-12);
  EXPECT_NEAR(sines[2], rejected::SineFromAir(sines[1], kGlass), 1e-12);
}

TEST(NestedMedia, AreBentRightWithPriorities) {
  for (const double angle_deg : {10.0, 60.0, 85.0}) {
    const std::vector<double> sines = SinesThroughLayers(angle_deg, 1, 2);
    ASSERT_EQ(sines.size(), 3U);
    EXPECT_NEAR(sines[1], sines[0] / kWater, 1e-12);
    EXPECT_NEAR(sines[2], rejected::SineFromMedium(sines[1], kWater, kGlass), 1e-12);
  }
}

}  // namespace
}  // namespace stipple::raytracer
