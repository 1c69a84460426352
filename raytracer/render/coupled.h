// SPDX-License-Identifier: MIT
// Ray and object partitions in concert: a pilot of 16 x 16 rays finds which leaves rays go through
// one after another; who holds what is then decided so that they seldom travel (coupling.h); and
// who asks for rays gets, if possible, such as it can follow far.
#ifndef STIPPLE_RAYTRACER_RENDER_COUPLED_H
#define STIPPLE_RAYTRACER_RENDER_COUPLED_H

#include <string>

#include "raytracer/partition/coupling.h"
#include "raytracer/render/divided.h"

namespace stipple::raytracer {

/// Divides the leaves of `parts`, made with Division::coupled, anew. Every rank calls it. Returns
/// what the pilot foretells, on rank 0. Errors: StoppedTogether.
template <class Real>
Forecast Couple(const World& world, ShadingChoice shading, const std::string& kernel,
                SceneParts<Real>& parts);

/// By bundle: the leaves that the ray through its middle point would meet if nothing stopped it.
template <class Real>
Ways WaysOf(const SceneParts<Real>& parts, const PartitionChoice& choice, ImageSize image,
            Samples samples);

}  // namespace stipple::raytracer

#endif
