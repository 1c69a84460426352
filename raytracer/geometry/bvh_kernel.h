// SPDX-License-Identifier: MIT
// Kernels that walk the model's own hierarchy.
#ifndef STIPPLE_RAYTRACER_GEOMETRY_BVH_KERNEL_H
#define STIPPLE_RAYTRACER_GEOMETRY_BVH_KERNEL_H

#include <memory>

#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

/// One box and one primitive at a time.
template <class Real>
std::unique_ptr<Kernel<Real>> MakeScalarKernel(const Model<Real>& model);

/// Eight boxes and four primitives at a time, with the best instructions of this machine. For
/// float and double.
template <class Real>
std::unique_ptr<Kernel<Real>> MakeVectorKernel(const Model<Real>& model);

}  // namespace stipple::raytracer

#endif
