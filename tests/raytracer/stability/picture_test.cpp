// SPDX-License-Identifier: MIT
// Row A2: whole pictures. A scene's rays do not depend on the unit of length or on where its origin
// is, and what double finds is what long double finds. So counts of rays are compared, with the
// scene scaled and moved: a fixed offset or none, or float, fail visibly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "raytracer/charts/moved.h"
#include "raytracer/image/compare.h"
#include "raytracer/scene/generate.h"
#include "tests/raytracer/stability/compare_counts.h"
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

TEST(WholePicture, HasExactlyTheSameRaysAtScalesThatArePowersOfTwo) {
  for (const Scene& scene : SmallScenes()) {
    const Traced plain = Trace<double>(scene, "bvh", kImage);
    for (const int power : {-10, -3, 7, 20}) {
      const Traced scaled = Trace<double>(Moved(scene, {}, std::ldexp(1.0, power)), "bvh", kImage);
      SCOPED_TRACE(power);
      ExpectSameCounts(scaled.counts, plain.counts);
      EXPECT_EQ(scaled.counts.tests.box_tests, plain.counts.tests.box_tests);
      EXPECT_EQ(scaled.counts.tests.primitive_tests, plain.counts.tests.primitive_tests);
      EXPECT_TRUE(Compare(Linear(scaled.picture), Linear(plain.picture)).Identical());
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
    EXPECT_TRUE(Compare(Linear(traced.picture), Linear(truth.picture)).Identical());
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

/// Claims to be exact, so that the tracer keeps no offset, and begins each ray a fixed distance
/// after its origin instead.
class FixedNearKernel final : public Kernel<double> {
 public:
  FixedNearKernel(const Kernel<double>& inner, double nearest) : inner_(inner), nearest_(nearest) {}

  Hit<double> Intersect(const Ray<double>& ray, TestCounts& tests) const override {
    Hit<double> hit = inner_.Intersect(Later(ray), tests);
    hit.t += nearest_;
    return hit;
  }
  bool Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const override {
    return inner_.Occluded(Later(ray), max_t - nearest_, tests);
  }
  double Rounding() const override { return 0; }

 private:
  Ray<double> Later(const Ray<double>& ray) const {
    return {ray.origin + ray.direction * nearest_, ray.direction};
  }

  const Kernel<double>& inner_;
  double nearest_;
};

TEST(WholePicture, HasOtherRaysWithoutAnOffsetOrWithAFixedOne) {
  const auto counts = [&](double scale, double offset) {
    Scene scene = Moved(Balls(3), {}, scale);
    const Model<double> model = BuildModel<double>(std::move(scene.shapes));
    const auto kernel = MakeKernel("bvh", model);
    return TraceWith(scene, model, FixedNearKernel(*kernel, offset), kImage).counts;
  };
  const RayCounts truth = Trace<double>(Balls(3), "bvh", kImage).counts;
  EXPECT_GT(Change(counts(1, 0).reflected_rays, truth.reflected_rays), 0.3);
  EXPECT_GT(Change(counts(1, 0).shadow_rays, truth.shadow_rays), 0.1);
  EXPECT_LT(std::abs(Change(counts(1, 1e-4).reflected_rays, truth.reflected_rays)), 0.01);
  EXPECT_LT(Change(counts(1e-3, 1e-4).reflected_rays, truth.reflected_rays), -0.02);
}

}  // namespace
}  // namespace stipple::raytracer
