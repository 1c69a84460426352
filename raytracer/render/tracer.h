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

#include "raytracer/geometry/kernel.h"
#include "raytracer/render/shader.h"

namespace stipple::raytracer {

template <class Real, Rules kRules>
class Tracer {
 public:
  /// Model and kernel are kept by reference, of the scene nothing is kept.
  Tracer(const Scene& scene, const Model<Real>& model, const Kernel<Real>& kernel,
         ShadingChoice choice);

  /// Follows an eye ray and all that come of it, and adds what they find.
  void TraceEye(const Ray<Real>& ray, RayResult& result);

  const RayCounts& counts() const { return shader_.counts(); }

 private:
  using Leg = typename Shader<Real, kRules>::Leg;
  struct Next;

  void Trace(const Leg& leg, RayResult& result);

  const Model<Real>& model_;
  const Kernel<Real>& kernel_;
  Shader<Real, kRules> shader_;
};

}  // namespace stipple::raytracer

#endif
