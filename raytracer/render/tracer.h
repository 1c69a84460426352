// SPDX-License-Identifier: MIT
// What one ray sees: Whitted's model as the rules of the Standard Procedural Databases say it.
//
// At a hit each light that the surface faces gets a shadow ray (none if the normal faces away); a
// visible one adds diffuse light and, on mirrors, a Phong highlight. Then the ray is reflected and
// refracted, to a fixed depth; the eye ray has depth
// 1. On total internal reflection the reflected ray takes what would have gone through. Nothing is
// ambient; every object casts a full shadow; surfaces are lit from the side that is seen. Where
// normals are interpolated, neither light nor a reflection comes from behind the true surface. A
// light without a colour is white, and all are scaled by sqrt(L) / (2 L) for L lights, as SPD
// suggests.
//
// Two extensions, for scenes that ask for them: transparent materials with a priority may overlap
// (media.h), else each lies in air; a light with a radius is seen in its own colour by eye,
// reflected and refracted rays, while shadow rays go to its centre and pass other lights.
//
// A ray's colour is added up in 64-bit fixed point, throughput x local colour at each hit, so that
// no order of addition can change a picture. So is what the rays that were not followed could have
// added at most.
#ifndef STIPPLE_RAYTRACER_RENDER_TRACER_H
#define STIPPLE_RAYTRACER_RENDER_TRACER_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "raytracer/geometry/kernel.h"
#include "raytracer/render/media.h"
#include "raytracer/render/shading.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

struct ShadingChoice {
  int max_depth = 5;
  double min_contribution =
      0;  // rays whose share of the eye ray's colour is smaller are not traced
  Rules at_least =
      Rules::kOpaque;  // compiled in even if the scene needs less: to measure its price
};

struct RayCounts {
  std::uint64_t eye_rays = 0, eye_hits = 0;
  std::uint64_t shadow_rays = 0, shadow_hits = 0;
  std::uint64_t reflected_rays = 0, refracted_rays = 0;
  TestCounts tests;

  std::uint64_t Rays() const { return eye_rays + shadow_rays + reflected_rays + refracted_rays; }
  std::uint64_t Work() const { return tests.box_tests + tests.primitive_tests; }
};

/// A colour in units of 2^-32.
struct FixedColor {
  std::int64_t red = 0, green = 0, blue = 0;

  friend bool operator==(const FixedColor&, const FixedColor&) = default;
};
inline constexpr std::int64_t kFixedOne = std::int64_t{1} << 32;

/// What the rays through one point of the raster found. It travels in messages as it is.
struct RayResult {
  FixedColor color;                  // sum over the rays
  std::int64_t lost = 0;             // rays not followed could add no more to a component of it
  std::uint32_t work = 0;            // box and primitive tests
  std::uint32_t object = kNoObject;  // that the first eye ray hit
  std::uint16_t rays = 0;            // eye rays
  std::uint8_t in_shadow = 0;        // 1 if something stands between that hit and a light it faces
  std::uint8_t depth = 0;            // of the deepest ray
  std::int64_t squares = 0;          // adaptive sampling: of the rays' components, as `color`
};
static_assert(sizeof(RayResult) == 56);

/// What `sum` found and, after that, `more`. Inline: a picture adds a million of them.
inline void Add(const RayResult& more, RayResult& sum) {
  if (sum.rays == 0) {
    sum = more;
    return;
  }
  sum.color.red += more.color.red;
  sum.color.green += more.color.green;
  sum.color.blue += more.color.blue;
  sum.lost += more.lost;
  sum.squares += more.squares;
  sum.work += more.work;
  sum.rays = static_cast<std::uint16_t>(sum.rays + more.rays);
  sum.depth = std::max(sum.depth, more.depth);
}

/// In units of 2^-32, rounded.
std::int64_t ToFixed(double value);

template <class Real, Rules kRules>
class Tracer {
 public:
  /// Model and kernel are kept by reference, of the scene nothing is kept.
  Tracer(const Scene& scene, const Model<Real>& model, const Kernel<Real>& kernel,
         ShadingChoice choice);

  /// Follows an eye ray and all that come of it, and adds what they find.
  void TraceEye(const Ray<Real>& ray, RayResult& result);

  const RayCounts& counts() const { return counts_; }

 private:
  static constexpr bool kTransmission = kRules >= Rules::kTransmitting;
  static constexpr bool kExtensions = kRules == Rules::kExtended;

  using Material = ShadedMaterial<Real>;

  /// A ray and what it carries.
  struct Leg {
    Ray<Real> ray;
    Real throughput;  // share of the eye ray's colour
    int depth;
    [[no_unique_address]] std::conditional_t<kExtensions, Media<Real>, OnlyAir> media;
  };

  /// A place where a ray met an object, ready for shading.
  struct Surface {
    Vec<Real> point;
    Vec<Real> face;      // unit normal of the geometry, towards the ray's origin
    Vec<Real> normal;    // unit normal for shading, on the same side
    Vec<Real> mirrored;  // direction of the reflected ray, if the material sends any on
    Real offset;         // distance that new rays keep from the surface
    bool leaving;        // the ray came from inside
    const Material* material;

    /// Where new rays start: a little off the surface, on the side they go to.
    Vec<Real> Outside() const { return point + face * offset; }
    Vec<Real> Inside() const { return point - face * offset; }
  };

  void Trace(const Leg& leg, RayResult& result);
  bool MeetsLight(const Leg& leg, Real distance, RayResult& result);
  Surface SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit) const;
  Vec<Real> LocalColor(const Surface& surface, bool& in_shadow);
  void Follow(const Leg& leg, const Surface& surface, RayResult& result);
  Real Refract(const Leg& leg, const Surface& surface, RayResult& result);
  Real Bending(const Leg& leg, const Surface& surface) const;
  bool WorthTracing(Real throughput, int depth, RayResult& result) const;
  void Lose(Real throughput, int depth, RayResult& result) const;

  const Model<Real>& model_;
  const Kernel<Real>& kernel_;
  Shading<Real> shading_;
  std::array<double, kDeepest + 1> largest_colors_;
  int max_depth_;
  Real min_contribution_;
  Real rounding_;  // of the kernel's distances
  RayCounts counts_;
};

}  // namespace stipple::raytracer

#endif
