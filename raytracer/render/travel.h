// SPDX-License-Identifier: MIT
// Rays where objects are divided: each is followed through all that this rank holds at once, and
// then goes on to the rank of the next leaf on its way, or has come to its end.
//
// A ray carries all that anybody needs to go on with it: what it has met so far, with the normals
// there, so that the rank where it ends can shade without holding the object; on its way to a
// light, what that light adds.
#ifndef STIPPLE_RAYTRACER_RENDER_TRAVEL_H
#define STIPPLE_RAYTRACER_RENDER_TRAVEL_H

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "raytracer/partition/holding.h"
#include "raytracer/partition/object_tree.h"
#include "raytracer/partition/ray_partition.h"
#include "raytracer/partition/scene_parts.h"
#include "raytracer/render/sampling.h"
#include "raytracer/render/shader.h"

namespace stipple::raytracer {

/// The ranks that tested all they hold for a ray, the latest last; the earliest are forgotten, and
/// what they hold is tested again if somebody else holds it, too.
class PassedRanks {
 public:
  static constexpr std::size_t kMost = 6;

  void Add(int rank) {
    if (rank > std::numeric_limits<std::uint16_t>::max()) return;
    if (count_ == kMost) std::shift_left(rank_.begin(), rank_.end(), 1), --count_;
    rank_[count_++] = static_cast<std::uint16_t>(rank);
  }
  bool AnyHolds(const Holding& holding, std::uint32_t leaf) const {
    return std::ranges::any_of(ranks(), [&](int rank) { return holding.Holds(rank, leaf); });
  }
  std::span<const std::uint16_t> ranks() const { return {rank_.data(), count_}; }

 private:
  std::array<std::uint16_t, kMost> rank_{};
  std::uint8_t count_ = 0;
};

/// How it travels in messages: ray_package.h.
template <class Real>
struct Traveller {
  Ray<Real> ray;
  Normals<Real> normals;  // where it met `object`
  FixedColor gain;        // of a ray to a light: what the light adds
  Real throughput = 1;
  Real t = std::numeric_limits<Real>::infinity();  // to `object`, or to the light
  RasterPoint point = 0;
  std::uint32_t object = kNoObject;  // the nearest so far
  std::uint32_t material = 0;        // of it
  std::uint16_t seen = 0;            // leaves on its way that it has been through, from the first
  PassedRanks passed;                // it has been through whatever they hold
  std::uint16_t eye_ray = 0;         // 1 + its number among those of its point; 0: it is none
  std::uint8_t depth = 1;
  bool to_light = false;
  bool first = false;    // of its point: what it meets is what the pixel shows
  bool arrived = false;  // in a message: another rank has looked for its way before
  PackedMedia media;
};

/// What one rank does with rays.
template <class Real>
class RankTracer {
 public:
  virtual ~RankTracer() = default;

  /// Adds the eye rays of a point to `rays`, and that there are so many to `found`.
  virtual void Begin(RasterPoint point, std::vector<Traveller<Real>>& rays, RayResult& found) = 0;
  /// The line of one of them.
  virtual Ray<Real> EyeRay(RasterPoint point, std::size_t number) const = 0;

  static constexpr int kEnded = -1;
  /// Follows a ray through leaves that this rank holds. The rank that it has to go to, or kEnded;
  /// then rays that come of it are added to `rays`. What it found is added to `found`. `waiting`:
  /// rays that are known to wait for each rank; where several can go on with one, it goes to who
  /// has few.
  virtual int Advance(Traveller<Real>& ray, std::span<const std::uint64_t> waiting,
                      std::vector<Traveller<Real>>& rays, RayResult& found) = 0;

  virtual const RayCounts& counts() const = 0;
  /// Of each ray that ended here, the leaves that it went through, each way behind its length; for
  /// the tracer of a pilot. Of none where all objects are at hand.
  virtual const std::vector<std::uint32_t>& ways() const = 0;
};

/// `rank`: as `parts.holding` counts them. `pilot`: keeps the ways of rays. Parts must outlive it.
/// Errors: UsageError for a kernel that cannot trace this scene.
template <class Real>
std::unique_ptr<RankTracer<Real>> MakeRankTracer(const SceneParts<Real>& parts, int rank,
                                                 ShadingChoice shading, ImageSize image,
                                                 Samples samples, bool pilot = false);

}  // namespace stipple::raytracer

#endif
