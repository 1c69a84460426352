// SPDX-License-Identifier: MIT
// Rays where objects are divided: each is followed through all that this rank holds at once, and
// then goes on to the rank of the next leaf on its way, or has come to its end.
//
// A ray carries all that anybody needs to go on with it: what it has met so far, with the normals
// there, so that the rank where it ends can shade without holding the object; on its way to a
// light, what that light adds.
#ifndef STIPPLE_RAYTRACER_RENDER_TRAVEL_H
#define STIPPLE_RAYTRACER_RENDER_TRAVEL_H

#include <array>
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
  std::uint32_t seen_ahead = 0;      // bit i: leaf seen + 1 + i, too, with those of a rank before
  std::uint16_t eye_ray = 0;         // 1 + its number among those of its point; 0: it is none
  std::uint8_t depth = 1;
  bool to_light = false;
  bool first = false;    // of its point: what it meets is what the pixel shows
  bool arrived = false;  // in a message: another rank has looked for its way before
  PackedMedia media;
};

/// It has been through the leaf that comes next.
template <class Real>
void PassLeaf(Traveller<Real>& ray) {
  bool seen = true;
  while (seen) {
    ++ray.seen;
    seen = (ray.seen_ahead & 1U) != 0;
    ray.seen_ahead >>= 1U;
  }
}

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
  /// Tests done in each leaf; of leaves that are held together, in that which a ray came to first.
  virtual const std::vector<std::uint64_t>& leaf_work() const = 0;
};

/// `rank`: as `parts.holding` counts them. Parts must outlive it. Errors: UsageError for a kernel
/// that cannot trace this scene.
template <class Real>
std::unique_ptr<RankTracer<Real>> MakeRankTracer(const SceneParts<Real>& parts, int rank,
                                                 ShadingChoice shading, ImageSize image,
                                                 Samples samples);

}  // namespace stipple::raytracer

#endif
