// SPDX-License-Identifier: MIT
#include "raytracer/render/travel.h"

#include <limits>

namespace stipple::raytracer {
namespace {

template <class Real, Rules kRules>
class RankTracerIn final : public RankTracer<Real> {
 public:
  using Shading = Shader<Real, kRules>;
  using Leg = typename Shading::Leg;

  RankTracerIn(const SceneParts<Real>& parts, int rank, ShadingChoice shading, ImageSize image,
               Samples samples)
      : parts_(parts),
        rank_(rank),
        eye_rays_(parts.scene.view, RasterOf(image, samples), samples),
        shader_(parts.scene, shading, parts.rounding),
        leaf_work_(parts.tree.leaves()),
        holds_all_(parts.HoldsAllAsOne()) {}

  void Begin(RasterPoint point, std::vector<Traveller<Real>>& rays, RayResult& found) override {
    shader_.counts().eye_rays += eye_rays_.count();
    found.rays = static_cast<std::uint16_t>(found.rays + eye_rays_.count());
    found.depth = std::max<std::uint8_t>(found.depth, 1);
    for (std::size_t i = 0; i < eye_rays_.count(); ++i) {
      Traveller<Real> ray;
      ray.ray = eye_rays_.Through(point, i);
      ray.eye_ray = static_cast<std::uint16_t>(i + 1);
      ray.point = point;
      ray.first = i == 0;
      rays.push_back(ray);
    }
  }

  Ray<Real> EyeRay(RasterPoint point, std::size_t number) const override {
    return eye_rays_.Through(point, number);
  }

  [[gnu::noinline]] int Advance(Traveller<Real>& ray, std::span<const std::uint64_t> waiting,
                                std::vector<Traveller<Real>>& rays, RayResult& found) override {
    const std::uint64_t work_before = shader_.counts().Work();
    bool stopped = false;
    const int next = Follow(ray, waiting, stopped);
    if (next == RankTracer<Real>::kEnded) {
      if (ray.to_light)
        EndAtLight(ray, stopped, found);
      else
        End(ray, rays, found);
    }
    found.work += static_cast<std::uint32_t>(shader_.counts().Work() - work_before);
    return next;
  }

  const RayCounts& counts() const override { return shader_.counts(); }
  const std::vector<std::uint64_t>& leaf_work() const override { return leaf_work_; }

 private:
  /// Where it goes next. `stopped`: something stands before its light.
  int Follow(Traveller<Real>& ray, std::span<const std::uint64_t> waiting, bool& stopped) {
    if (holds_all_) return FollowHere(ray, waiting, stopped);
    const Ray<double> line = {Wide(ray.ray.origin), Wide(ray.ray.direction)};
    const std::uint64_t walk =
        parts_.tree.Along(line, static_cast<double>(shader_.rounding()), way_);
    shader_.counts().tests.box_tests += walk;
    if (ray.arrived) shader_.counts().repeated_tests += walk;
    for (; ray.seen < way_.size(); PassLeaf(ray)) {
      const LeafOnWay& next = way_[ray.seen];
      if (static_cast<double>(ray.t) < next.enter) break;
      if (!parts_.holding.Holds(rank_, next.leaf) ||
          (!ray.arrived && parts_.holding.OthersHaveFewer(next.leaf, waiting, rank_)))
        return parts_.holding.Next(std::span(way_).subspan(ray.seen), waiting, ray.point);
      stopped = Test(next.leaf, ray);
      if (stopped) break;
      SeeAhead(*parts_.held[next.leaf], ray);
    }
    return RankTracer<Real>::kEnded;
  }

  /// Where all objects are at hand a ray's way need not be known.
  int FollowHere(Traveller<Real>& ray, std::span<const std::uint64_t> waiting, bool& stopped) {
    const LeafOnWay any;
    if (!ray.arrived && parts_.holding.OthersHaveFewer(any.leaf, waiting, rank_))
      return parts_.holding.Next({&any, 1}, waiting, ray.point);
    stopped = Test(any.leaf, ray);
    return RankTracer<Real>::kEnded;
  }

  /// Tests what is held together with a leaf. Does it stand before the ray's light?
  bool Test(std::uint32_t leaf, Traveller<Real>& ray) {
    const HeldPart<Real>& part = *parts_.held[leaf];
    const std::uint64_t before = shader_.counts().Work();
    Repeats repeats{part.copies, ray.arrived && ray.seen > 0 ? SeenElsewhere(part, ray) : 0};
    bool stopped = false;
    if (!ray.to_light)
      Meet(part, ray, repeats);
    else if (repeats.seen == 0)
      stopped = part.kernel->Occluded(ray.ray, ray.t, shader_.counts().tests);
    else
      stopped = part.kernel->OccludedAgain(ray.ray, ray.t, shader_.counts().tests, repeats);
    shader_.counts().repeated_tests += repeats.tests;
    leaf_work_[leaf] += shader_.counts().Work() - before;
    return stopped;
  }

  /// Leaves that a ray has been through with other objects than these.
  LeafBits SeenElsewhere(const HeldPart<Real>& part, const Traveller<Real>& ray) const {
    LeafBits seen = 0;
    for (std::size_t i = 0; i < way_.size(); ++i) {
      const std::size_t ahead = i - ray.seen - 1;  // of those before the next a huge number
      const bool through =
          i < ray.seen || (ahead < std::numeric_limits<decltype(ray.seen_ahead)>::digits &&
                           (ray.seen_ahead >> ahead & 1U) != 0);
      if (through && parts_.held[way_[i].leaf].get() != &part) seen |= BitOf(way_[i].leaf);
    }
    return seen;
  }

  /// Leaves further on whose objects were tested together with those of the next.
  void SeeAhead(const HeldPart<Real>& part, Traveller<Real>& ray) {
    const std::size_t first = ray.seen + std::size_t{1};
    const std::size_t most = std::numeric_limits<decltype(ray.seen_ahead)>::digits;
    for (std::size_t i = 0; i < most && first + i < way_.size(); ++i)
      if (parts_.held[way_[first + i].leaf].get() == &part) ray.seen_ahead |= 1U << i;
  }

  static Vec3 Wide(Vec<Real> v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  /// Keeps what is nearer than what was met before.
  void Meet(const HeldPart<Real>& part, Traveller<Real>& ray, Repeats& repeats) {
    TestCounts& tests = shader_.counts().tests;
    const Hit<Real> hit = repeats.seen == 0 ? part.kernel->Intersect(ray.ray, tests)
                                            : part.kernel->IntersectAgain(ray.ray, tests, repeats);
    if (hit.object == kNoObject) return;
    const std::uint32_t object = part.numbers[hit.object];
    if (hit.t > ray.t || (hit.t == ray.t && object >= ray.object)) return;
    ray.t = hit.t;
    ray.object = object;
    ray.material = part.model.objects[hit.object].material;
    ray.normals = NormalsAt(part.model, hit, shader_.PointAt(ray.ray, hit.t));
  }

  /// Tells of rays that come of one that has ended.
  struct Next {
    RankTracerIn& tracer;
    const Traveller<Real>& from;
    std::vector<Traveller<Real>>& rays;
    RayResult& found;

    template <class Gain>
    void ToLight(const Ray<Real>& ray, Real distance, Gain gain) {
      Traveller<Real> more;
      more.ray = ray;
      more.t = distance;
      more.to_light = true;
      Deposit(gain(), more.gain);
      more.point = from.point;
      more.depth = from.depth;
      more.first = from.first;
      rays.push_back(more);
    }
    void Go(const Leg& leg) {
      Traveller<Real> more;
      more.ray = leg.ray;
      more.throughput = leg.throughput;
      more.point = from.point;
      more.depth = static_cast<std::uint8_t>(leg.depth);
      more.first = from.first && leg.depth == from.depth;
      if constexpr (Shading::kExtensions) more.media = leg.media.Packed(tracer.shader_.materials());
      rays.push_back(more);
      found.depth = std::max(found.depth, more.depth);
    }
  };

  void EndAtLight(const Traveller<Real>& ray, bool stopped, RayResult& found) {
    if (stopped) {
      ++shader_.counts().shadow_hits;
      if (ray.first) found.in_shadow = 1;
      return;
    }
    found.color.red += ray.gain.red;
    found.color.green += ray.gain.green;
    found.color.blue += ray.gain.blue;
  }

  void End(const Traveller<Real>& ray, std::vector<Traveller<Real>>& rays, RayResult& found) {
    Leg leg{ray.ray, ray.throughput, ray.depth, {}};
    if constexpr (Shading::kExtensions) {
      leg.media = Media<Real>(ray.media, shader_.materials());
      if (shader_.MeetsLight(leg, ray.t, found)) return;
    }
    if (ray.object == kNoObject) {
      Deposit(shader_.background() * leg.throughput, found.color);
      return;
    }
    Next next{*this, ray, rays, found};
    shader_.Shade(leg, shader_.SurfaceAt(ray.ray, ray.t, ray.normals, ray.material), ray.object,
                  ray.first, found, next);
  }

  const SceneParts<Real>& parts_;
  int rank_;
  SampleRays<Real> eye_rays_;
  Shader<Real, kRules> shader_;
  std::vector<LeafOnWay> way_;
  std::vector<std::uint64_t> leaf_work_;
  bool holds_all_;
};

}  // namespace

template <class Real>
std::unique_ptr<RankTracer<Real>> MakeRankTracer(const SceneParts<Real>& parts, int rank,
                                                 ShadingChoice shading, ImageSize image,
                                                 Samples samples) {
  return WithRules(std::max(shading.at_least, RulesOf(parts.scene)),
                   [&]<Rules kRules>() -> std::unique_ptr<RankTracer<Real>> {
                     return std::make_unique<RankTracerIn<Real, kRules>>(parts, rank, shading,
                                                                         image, samples);
                   });
}

template std::unique_ptr<RankTracer<float>> MakeRankTracer(const SceneParts<float>&, int,
                                                           ShadingChoice, ImageSize, Samples);
template std::unique_ptr<RankTracer<double>> MakeRankTracer(const SceneParts<double>&, int,
                                                            ShadingChoice, ImageSize, Samples);

}  // namespace stipple::raytracer
