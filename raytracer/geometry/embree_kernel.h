// SPDX-License-Identifier: MIT
// Intel Embree 3 behind the same questions as the own hierarchy: the peer that our speed is
// compared with, and a second opinion on what a ray hits.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_EMBREE_KERNEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_EMBREE_KERNEL_H

#include <memory>

#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

/// Builds Embree's hierarchy over the model's shapes, on one thread; the model's own hierarchy is
/// not used and may be missing (Hierarchy::kNone). For float and double; hits are those of float
/// arithmetic in either case, and which of two objects at the same distance is hit is up to Embree.
/// Embree does not tell how many tests it did: TestCounts stay as they are.
///
/// Errors: UsageError if Embree cannot be set up, or an object lies beyond what it can hold.
template <class Real>
std::unique_ptr<Kernel<Real>> MakeEmbreeKernel(const Model<Real>& model);

}  // namespace stipple::raytracer

#endif
