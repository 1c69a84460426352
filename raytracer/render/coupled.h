// SPDX-License-Identifier: MIT
// Ray and object partitions in concert: a pilot of 16 x 16 rays finds which leaves cost most; each
// leaf has the more holders the more it costs, as far as memory allows; and who asks for rays gets,
// if possible, such as begin in what it holds.
#ifndef STIPPLE_RAYTRACER_RENDER_COUPLED_H
#define STIPPLE_RAYTRACER_RENDER_COUPLED_H

#include <cstdint>
#include <string>
#include <vector>

#include "raytracer/render/divided.h"

namespace stipple::raytracer {

/// Divides the leaves of `parts`, made with Division::coupled, anew. `most_bytes`: that a rank may
/// hold. Every rank calls it. Returns the work of the busiest rank over the mean, as the pilot
/// foretells it. Errors: StoppedTogether.
template <class Real>
double Couple(const World& world, ShadingChoice shading, const std::string& kernel,
              std::uint64_t most_bytes, SceneParts<Real>& parts);

/// By bundle: the leaf that the ray through its middle point meets first.
template <class Real>
std::vector<std::uint32_t> HomesOf(const SceneParts<Real>& parts, const PartitionChoice& choice,
                                   ImageSize image, Samples samples);

}  // namespace stipple::raytracer

#endif
