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
// A ray's colour is added up in 64-bit fixed point, throughput x local colour at each hit, so that
// no order of addition can change a picture.
#ifndef STIPPLE_RAYTRACER_RENDER_TRACER_H
#define STIPPLE_RAYTRACER_RENDER_TRACER_H

#include <cmath>
#include <cstdint>

#include "raytracer/geometry/kernel.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

struct ShadingChoice {
  int max_depth = 5;
  double min_contribution = 0;  // rays that could change a pixel by less are not traced
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
};
inline constexpr std::int64_t kFixedOne = std::int64_t{1} << 32;

/// What the rays through one point of the raster found. It travels in messages as it is.
struct RayResult {
  FixedColor color;                  // sum over the rays
  std::uint32_t work = 0;            // box and primitive tests
  std::uint32_t object = kNoObject;  // that the first eye ray hit
  std::uint32_t in_shadow = 0;       // 1 if something stands between that hit and a light it faces
  std::uint32_t depth = 0;           // of the deepest ray
};
static_assert(sizeof(RayResult) == 40);

template <class Real>
class Tracer {
 public:
  /// All are kept by reference.
  Tracer(const Scene& scene, const Model<Real>& model, const Kernel<Real>& kernel,
         ShadingChoice choice);

  /// Follows an eye ray and all that come of it, and adds what they find.
  void TraceEye(const Ray<Real>& ray, RayResult& result);

  const RayCounts& counts() const { return counts_; }

 private:
  /// A place where a ray met an object, ready for shading.
  struct Surface {
    Vec<Real> point;
    Vec<Real> face;    // unit normal of the geometry, towards the ray's origin
    Vec<Real> normal;  // unit normal for shading, on the same side
    Real offset;       // distance that new rays keep from the surface
    bool leaving;      // the ray came from inside
    const Material* material;

    /// Where new rays start: a little off the surface, on the side they go to.
    Vec<Real> Outside() const { return point + face * offset; }
    Vec<Real> Inside() const { return point - face * offset; }
  };

  void Trace(const Ray<Real>& ray, Vec<Real> throughput, int depth, RayResult& result);
  Surface SurfaceAt(const Ray<Real>& ray, const Hit<Real>& hit) const;
  Vec<Real> LocalColor(const Ray<Real>& ray, const Surface& surface, bool& in_shadow);
  void Follow(const Ray<Real>& ray, const Surface& surface, Vec<Real> throughput, int depth,
              RayResult& result);

  bool WorthTracing(Vec<Real> throughput) const;

  const Scene& scene_;
  const Model<Real>& model_;
  const Kernel<Real>& kernel_;
  ShadingChoice choice_;
  Real light_scale_;
  RayCounts counts_;
};

}  // namespace stipple::raytracer

#endif
