// SPDX-License-Identifier: MIT
// Rays come out of a message as they went in, to the bit.
#include "raytracer/render/ray_package.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace stipple::raytracer {
namespace {

/// Knows its eye rays' lines, and nothing else.
template <class Real>
class OnlyEyeRays final : public RankTracer<Real> {
 public:
  void Begin(RasterPoint, std::vector<Traveller<Real>>&, RayResult&) override {}
  Ray<Real> EyeRay(RasterPoint point, std::size_t number) const override {
    const auto x = static_cast<Real>(point), y = static_cast<Real>(number);
    return {{x, y, 1}, {y, 2, x}};
  }
  int Advance(Traveller<Real>&, std::span<const std::uint64_t>, std::vector<Traveller<Real>>&,
              RayResult&) override {
    return RankTracer<Real>::kEnded;
  }
  const RayCounts& counts() const override { return counts_; }
  const std::vector<std::uint32_t>& ways() const override { return ways_; }

 private:
  RayCounts counts_;
  std::vector<std::uint32_t> ways_;
};

/// Of every kind one, with values at the ends of what they may be.
template <class Real>
std::vector<Traveller<Real>> SomeRays() {
  const Real third = Real{1} / 3;
  Traveller<Real> eye;
  eye.ray = OnlyEyeRays<Real>().EyeRay(0xfffffffe, 4095);
  eye.point = 0xfffffffe;
  eye.eye_ray = 4096;
  eye.first = true;
  Traveller<Real> reflected;
  reflected.ray = {{third, -third, 1e-30F}, {-0.0F, third, -1}};
  reflected.throughput = third;
  reflected.depth = 64;
  reflected.seen = 65535;
  for (const int rank : {9, 0, 65535, 1, 2, 3, 4}) reflected.passed.Add(rank);
  reflected.media.inside = {1, 2, 3, 4, 5, 6, 7, 8};
  reflected.media.count = 8;
  Traveller<Real> met = reflected, flat = eye;
  met.t = flat.t = third;
  met.object = flat.object = 0xfffffffe;
  met.material = flat.material = 77;
  met.normals = {{third, 0, 1}, {third, 0, std::numeric_limits<Real>::denorm_min()}};
  flat.normals = {{0, third, 1}, {0, third, 1}};
  Traveller<Real> to_light;
  to_light.ray = met.ray;
  to_light.to_light = true;
  to_light.t = 1000 * third;
  Deposit(Vec<Real>{1024, -1024, -third}, to_light.gain);
  return {eye, reflected, met, to_light, flat};
}

template <class Real>
void ExpectSame(const Traveller<Real>& a, const Traveller<Real>& b) {
  EXPECT_EQ(a.ray.origin, b.ray.origin);
  EXPECT_EQ(a.ray.direction, b.ray.direction);
  EXPECT_EQ(a.gain, b.gain);
  EXPECT_EQ(a.throughput, b.throughput);
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.object, b.object);
  EXPECT_EQ(std::tuple(a.point, a.material, a.seen, a.eye_ray, a.depth, a.to_light, a.first),
            std::tuple(b.point, b.material, b.seen, b.eye_ray, b.depth, b.to_light, b.first));
  EXPECT_TRUE(std::ranges::equal(a.passed.ranks(), b.passed.ranks()));
  EXPECT_EQ(a.normals.face, b.normals.face);
  EXPECT_EQ(a.normals.shading, b.normals.shading);
  EXPECT_EQ(a.media.count, b.media.count);
  EXPECT_EQ(a.media.inside, b.media.inside);
}

template <class Real>
void ComesOutAsItWentIn() {
  const std::vector<Traveller<Real>> rays = SomeRays<Real>();
  RayPackage<Real> package;
  for (const Traveller<Real>& ray : rays) package.Add(ray);
  const std::span<const std::byte> bytes = package.Ready({3, 9});
  EXPECT_LE(bytes.size(), RayPackage<Real>::MostBytes(rays.size()));
  std::vector<Traveller<Real>> out{Traveller<Real>()};
  const PackageHeader header = Unpack(bytes, OnlyEyeRays<Real>(), out);
  EXPECT_EQ(header.standing.worked_off, 3U);
  EXPECT_EQ(header.standing.waiting, 9U);
  ASSERT_EQ(out.size(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ExpectSame(out[i], rays[i]);
    EXPECT_TRUE(out[i].arrived);
  }
}

TEST(RayPackage, RaysComeOutAsTheyWentIn) {
  ComesOutAsItWentIn<float>();
  ComesOutAsItWentIn<double>();
}

TEST(RayPackage, ARayTakesFewBytes) {
  const auto bytes_of = [](const Traveller<double>& ray) {
    RayPackage<double> package;
    package.Add(ray);
    return package.Ready({}).size() - sizeof(PackageHeader);
  };
  const std::vector<Traveller<double>> rays = SomeRays<double>();
  EXPECT_EQ(bytes_of(rays[0]), 9U);   // from the eye
  EXPECT_EQ(bytes_of(rays[3]), 81U);  // to a light
  Traveller<double> reflected = rays[1];
  reflected.media.count = 0;
  EXPECT_EQ(bytes_of(reflected), 64U + 1 + 2 * PassedRanks::kMost);
  reflected.passed = {};
  EXPECT_EQ(bytes_of(reflected), 64U);
}

TEST(PassedRanks, TheEarliestAndThoseWithoutANumberOfTwoBytesAreForgotten) {
  const Holding each = Holding::Even(10, 1);
  PassedRanks passed;
  for (int rank = 0; rank < 8; ++rank) passed.Add(rank);
  passed.Add(65536);
  for (std::uint32_t leaf = 0; leaf < 10; ++leaf)
    EXPECT_EQ(passed.AnyHolds(each, leaf), leaf >= 2 && leaf < 8) << leaf;
}

}  // namespace
}  // namespace stipple::raytracer
