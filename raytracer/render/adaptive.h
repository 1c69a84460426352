// SPDX-License-Identifier: MIT
// Adaptive sampling: rays where the picture needs them.
//
// Every pixel gets kFirstRays. Then, round by round, the rank that has the whole picture says which
// pixels get as many rays again as they have, until no pixel needs more. It decides from sums of
// integers over finished rounds, so that the picture does not depend on who traced what.
//
// A pixel's variance says little after a few rays: those of a pixel with a thin edge in it may all
// agree. So the mean over the pixels around it is taken, weighted 1 2 1 in both directions; where a
// neighbour has seen an edge, its neighbours are looked at more closely. Rays lie on a lattice
// whose first 2^k points are a lattice themselves, so n of them lower the squared error like
// n^-1.5, and one more ray by an amount in proportion to variance x n^-2.5: rays go where that is
// large, which makes the error of the picture least. Tried in its place and worse or no better: the
// differences of the sums of halves, quarters and eighths of the lattice (alone up to 9 dB worse,
// averaged 0 to 1), the largest instead of the mean variance, own variance alone (-0.3 to -6 dB),
// weighting by the pixel's work, and at least 16 or 32 rays where neighbours show another object or
// shadow.
#ifndef STIPPLE_RAYTRACER_RENDER_ADAPTIVE_H
#define STIPPLE_RAYTRACER_RENDER_ADAPTIVE_H

#include <cstdint>
#include <span>
#include <vector>

#include "raytracer/render/tracer.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

inline constexpr int kFirstRays = 8;
inline constexpr int kMostRays = 256;

/// By point of the raster: how many rays it has and gets again, as a power of two; 0: none.
using Doubling = std::vector<std::uint8_t>;

/// `tolerance`: a ray is worth tracing if it is expected to lower a pixel's squared error (of 1)
/// by more than about tolerance^2.
Doubling WorthDoubling(std::span<const RayResult> raster, ImageSize image, double tolerance);

}  // namespace stipple::raytracer

#endif
