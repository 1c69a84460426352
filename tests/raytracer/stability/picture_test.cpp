// SPDX-License-Identifier: MIT
// Row A2: whole pictures. A scene's rays do not depend on the unit of length or on where its origin
// is, and what double finds is what long double finds. So counts of rays are compared, with the
// scene scaled and moved: a fixed offset or none, or float, fail visibly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "raytracer/charts/moved.h"
#include "raytracer/scene/generate.h"
#include "tests/raytracer/stability/trace_picture.h"

namespace stipple::raytracer {
namespace {

constexpr ImageSize kImage{96, 96};

std::array<Scene, 4> SmallScenes() { return {Balls(3), Rings(3), Teapot(5), Tree(7)}; }

/// Difference of two counts, relative.
double Change(std::uint64_t count, std::uint64_t from) {
  return (static_cast<double>(count) - static_cast<double>(from)) /
         static_cast<double>(std::max<std::uint64_t>(from, 1));
}

void ExpectSameCounts(const RayCounts& a, const RayCounts& b) {
  EXPECT_EQ(a.eye_hits, b.eye_hits);
  EXPECT_EQ(a.shadow_rays, b.shadow_rays);
  EXPECT_EQ(a.shadow_hits, b.shadow_hits);
  EXPECT_EQ(a.reflected_rays, b.reflected_rays);
  EXPECT_EQ(a.refracted_rays, b.refracted_rays);
}

/// Within 10^-5 of all rays, but at least one: a ray that just touches a surface may fall to the
/// other side.
void ExpectNearCounts(const RayCounts& a, const RayCounts& b) {
  const double slack = std::max(1.0, 1e-5 * static_cast<double>(b.Rays()));
  const auto near = [&](std::uint64_t x, std::uint64_t y) {
    EXPECT_NEAR(static_cast<double>(x), static_cast<double>(y), slack);
  };
  near(a.eye_hits, b.eye_hits);
  near(a.shadow_rays, b.shadow_rays);
  near(a.shadow_hits, b.shadow_hits);
  near(a.reflected_rays, b.reflected_rays);
}

TEST(WholePicture, HasExactlyTheSameRaysAtScalesThatArePowersOfTwo) {
  for (const Scene& scene : SmallScenes()) {
    const Traced plain = Trace<double>(scene, "bvh", kImage);
    for (const int power : {-10, -3, 7, 20}) {
      const Traced scaled = Trace<double>(Moved(scene, {}, std::ldexp(1.0, power)), "bvh", kImage);
      SCOPED_TRACE(power);
      ExpectSameCounts(scaled.counts, plain.counts);
      EXPECT_EQ(scaled.counts.tests.box_tests, plain.counts.tests.box_tests);
      EXPECT_EQ(scaled.counts.tests.primitive_tests, plain.counts.tests.primitive_tests);
      EXPECT_TRUE(Compare(scaled.picture, plain.picture).Identical());
    }
  }
}

TEST(WholePicture, HasTheSameRaysAtAnyScaleAndPlace) {
  for (const Scene& scene : SmallScenes()) {
    const RayCounts plain = Trace<double>(scene, "bvh", kImage).counts;
    for (const auto& [scale, shift] :
         {std::pair{1e-3, 0.0}, std::pair{1e3, 0.0}, std::pair{1e6, 0.0}, std::pair{1.0, 1e5}}) {
      SCOPED_TRACE(testing::Message() << scale << ' ' << shift);
      const Scene moved = Moved(scene, {shift, shift, shift}, scale);
      ExpectNearCounts(Trace<double>(moved, "bvh", kImage).counts, plain);
    }
  }
}

TEST(WholePicture, IsLongDoublesPicture) {
  for (const Scene& scene : SmallScenes()) {
    const Traced traced = Trace<double>(scene, "bvh", kImage);
    const Traced truth = Trace<long double>(scene, "scalar", kImage);
    ExpectSameCounts(traced.counts, truth.counts);
    EXPECT_TRUE(Compare(traced.picture, truth.picture).Identical());
  }
}

TEST(WholePicture, HasOtherRaysInFloatFarFromTheOrigin) {
  const Scene scene = Balls(3);
  const auto rays = [&](double shift) {
    return Trace<float>(Moved(scene, {shift, shift, shift}), "bvh", kImage).counts.shadow_rays;
  };
  const std::uint64_t truth = Trace<double>(scene, "bvh", kImage).counts.shadow_rays;
  EXPECT_LT(std::abs(Change(rays(0), truth)), 2e-3);
  EXPECT_GT(std::abs(Change(rays(1e5), truth)), 0.05);
}

/// Passes hits on and claims another precision for them, so that the tracer keeps another offset.
class OffsetKernel final : public Kernel<double> {
 public:
  /// `offset`: a fixed distance in the scene.
  OffsetKernel(const Kernel<double>& inner, double offset) : inner_(inner), offset_(offset) {}

  Hit<double> Intersect(const Ray<double>& ray, TestCounts& tests) const override {
    const Hit<double> hit = inner_.Intersect(ray, tests);
    size_ = std::max(MaxNorm(ray.origin + ray.direction * hit.t), hit.t);
    return hit;
  }
  bool Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const override {
    return inner_.Occluded(ray, max_t, tests);
  }
  double Rounding() const override { return offset_ / (32 * size_); }

 private:
  const Kernel<double>& inner_;
  double offset_;
  mutable double size_ = 1;
};

TEST(WholePicture, HasOtherRaysWithoutAnOffsetOrWithAFixedOne) {
  const auto counts = [&](double scale, double offset) {
    Scene scene = Moved(Balls(3), {}, scale);
    const Model<double> model = BuildModel<double>(std::move(scene.shapes));
    const auto kernel = MakeKernel("bvh", model);
    return TraceWith(scene, model, OffsetKernel(*kernel, offset), kImage).counts;
  };
  const RayCounts truth = Trace<double>(Balls(3), "bvh", kImage).counts;
  EXPECT_GT(Change(counts(1, 0).reflected_rays, truth.reflected_rays), 0.3);
  EXPECT_GT(Change(counts(1, 0).shadow_rays, truth.shadow_rays), 0.1);
  EXPECT_LT(std::abs(Change(counts(1, 1e-4).reflected_rays, truth.reflected_rays)), 0.01);
  EXPECT_LT(Change(counts(1e-3, 1e-4).reflected_rays, truth.reflected_rays), -0.04);
}

}  // namespace
}  // namespace stipple::raytracer
