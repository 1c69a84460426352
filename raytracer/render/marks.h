// SPDX-License-Identifier: MIT
// What the ray tracer tells a tracing tool about itself; nothing happens when none is loaded.
#ifndef STIPPLE_RAYTRACER_RENDER_MARKS_H
#define STIPPLE_RAYTRACER_RENDER_MARKS_H

#include <cstddef>
#include <cstdint>

#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

enum class Moment {
  kLoadBegins,
  kBuildBegins,
  kRenderBegins,
  kSupplyEnds,
  kAssembleBegins,
  kOutputBegins
};

/// Marks a moment of the run.
void Mark(Moment moment);

/// This rank hands out work.
void MarkHost();

/// Records this rank's counters as they stand: after each bundle, or each part of a static
/// partition.
void RecordCounts(const RayCounts& counts);

/// Records, on the host, how many bundles are still to be handed out.
void RecordBundlesLeft(std::uint32_t bundles);

/// Records, after each package of rays, how many wait on this rank, and how many it has ever
/// received and sent.
void RecordTravel(std::size_t waiting, std::uint64_t received, std::uint64_t sent);

}  // namespace stipple::raytracer

#endif
