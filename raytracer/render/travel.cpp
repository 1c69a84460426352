// SPDX-License-Identifier: MIT
#include "raytracer/render/travel.h"

namespace stipple::raytracer {
namespace {

template <class Real, Rules kRules>
class RankTracerIn final : public RankTracer<Real> {
 public:
  using Shading = Shader<Real, kRules>;
  using Leg = typename Shading::Leg;

  RankTracerIn(const SceneParts<Real>& parts, int rank, ShadingChoice shading, ImageSize image,
               Samples samples, bool pilot)
      : parts_(parts),
        rank_(rank),
        eye_rays_(parts.scene.view, RasterOf(image, samples), samples),
        shader_(parts.scene, shading, parts.rounding),
        pilot_(pilot),
        here_(*parts.here),
        holds_all_(parts.holding.LeavesOf(rank).size() == parts.tree.leaves()) {
    for (int holder = 0; holder < parts.holding.ranks(); ++holder) {
      LeafBits& held = held_by_.emplace_back(0);
      for (const std::uint32_t leaf : parts.holding.LeavesOf(holder)) held |= BitOf(leaf);
    }
  }

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
  const std::vector<std::uint32_t>& ways() const override { return ways_; }

 private:
  // To choose who goes on with a ray so many of the leaves on its way are looked at.
  static constexpr std::size_t kLookAhead = 8;

  /// Where it goes next. `stopped`: something stands before its light.
  int Follow(Traveller<Real>& ray, std::span<const std::uint64_t> waiting, bool& stopped) {
    if (holds_all_) return FollowHere(ray, waiting, stopped);
    way_.Begin(parts_.tree, {Wide(ray.ray.origin), Wide(ray.ray.direction)},
               static_cast<double>(shader_.rounding()));
    const int next = FollowOnWay(ray, waiting, stopped);
    shader_.counts().tests.box_tests += way_.Work();
    if (ray.arrived) shader_.counts().repeated_tests += way_.Work();
    return next;
  }

  int FollowOnWay(Traveller<Real>& ray, std::span<const std::uint64_t> waiting, bool& stopped) {
    bool tested = false;
    for (; way_.Reach(ray.seen + std::size_t{1}); ++ray.seen) {
      const LeafOnWay next = way_.leaves()[ray.seen];
      if (static_cast<double>(ray.t) < next.enter) break;
      const bool held = parts_.holding.Holds(rank_, next.leaf);
      if ((held && tested) || ray.passed.AnyHolds(parts_.holding, next.leaf)) continue;
      if (!held || (!ray.arrived && parts_.holding.OthersHaveFewer(next.leaf, waiting, rank_))) {
        if (tested) ray.passed.Add(rank_);
        way_.Reach(ray.seen + kLookAhead);
        return parts_.holding.Next(way_.leaves().subspan(ray.seen), waiting, ray.point);
      }
      stopped = Test(ray);
      tested = true;
      if (!stopped) continue;
      ++ray.seen;
      break;
    }
    if (pilot_) KeepWay(ray.seen);
    return RankTracer<Real>::kEnded;
  }

  void KeepWay(std::size_t leaves) {
    ways_.push_back(static_cast<std::uint32_t>(leaves));
    for (const LeafOnWay& on_way : way_.leaves().first(leaves)) ways_.push_back(on_way.leaf);
  }

  /// Where all objects are at hand a ray's way need not be known.
  int FollowHere(Traveller<Real>& ray, std::span<const std::uint64_t> waiting, bool& stopped) {
    const LeafOnWay any;
    if (!ray.arrived && parts_.holding.OthersHaveFewer(any.leaf, waiting, rank_))
      return parts_.holding.Next({&any, 1}, waiting, ray.point);
    stopped = Test(ray);
    return RankTracer<Real>::kEnded;
  }

  /// Tests all that is held. Does something stand before the ray's light?
  bool Test(Traveller<Real>& ray) {
    TestCounts& tests = shader_.counts().tests;
    Repeats repeats{here_.copies, SeenElsewhere(ray)};
    bool stopped = false;
    if (!ray.to_light)
      Meet(ray, repeats);
    else if (repeats.seen == 0)
      stopped = here_.kernel->Occluded(ray.ray, ray.t, tests);
    else
      stopped = here_.kernel->OccludedAgain(ray.ray, ray.t, tests, repeats);
    shader_.counts().repeated_tests += repeats.tests;
    return stopped;
  }

  /// What those hold who have tested all they hold for this ray.
  LeafBits SeenElsewhere(const Traveller<Real>& ray) const {
    LeafBits seen = 0;
    for (const std::uint16_t rank : ray.passed.ranks()) seen |= held_by_[rank];
    return seen;
  }

  static Vec3 Wide(Vec<Real> v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  /// Keeps what is nearer than what was met before.
  void Meet(Traveller<Real>& ray, Repeats& repeats) {
    TestCounts& tests = shader_.counts().tests;
    const Hit<Real> hit = repeats.seen == 0
                              ? here_.kernel->Intersect(ray.ray, tests)
                              : here_.kernel->IntersectAgain(ray.ray, ray.t, tests, repeats);
    if (hit.object == kNoObject) return;
    const std::uint32_t object = here_.numbers[hit.object];
    if (hit.t > ray.t || (hit.t == ray.t && object >= ray.object)) return;
    ray.t = hit.t;
    ray.object = object;
    ray.material = here_.model.objects[hit.object].material;
    ray.normals = NormalsAt(here_.model, hit, shader_.PointAt(ray.ray, hit.t));
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
  LeafWay way_;
  std::vector<std::uint32_t> ways_;
  const bool pilot_;
  const HeldPart<Real>& here_;
  std::vector<LeafBits> held_by_;  // by rank
  const bool holds_all_;
};

}  // namespace

template <class Real>
std::unique_ptr<RankTracer<Real>> MakeRankTracer(const SceneParts<Real>& parts, int rank,
                                                 ShadingChoice shading, ImageSize image,
                                                 Samples samples, bool pilot) {
  return WithRules(std::max(shading.at_least, RulesOf(parts.scene)),
                   [&]<Rules kRules>() -> std::unique_ptr<RankTracer<Real>> {
                     return std::make_unique<RankTracerIn<Real, kRules>>(parts, rank, shading,
                                                                         image, samples, pilot);
                   });
}

template std::unique_ptr<RankTracer<float>> MakeRankTracer(const SceneParts<float>&, int,
                                                           ShadingChoice, ImageSize, Samples, bool);
template std::unique_ptr<RankTracer<double>> MakeRankTracer(const SceneParts<double>&, int,
                                                            ShadingChoice, ImageSize, Samples,
                                                            bool);

}  // namespace stipple::raytracer
