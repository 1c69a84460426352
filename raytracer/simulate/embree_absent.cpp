// SPDX-License-Identifier: MIT
#include "raytracer/errors.h"
#include "raytracer/geometry/embree_kernel.h"

namespace stipple::raytracer {

template <class Real>
std::unique_ptr<Kernel<Real>> MakeEmbreeKernel(const Model<Real>&) {
  throw UsageError(
      "--kernel embree: counts no tests, by which a simulated machine charges for work");
}

template std::unique_ptr<Kernel<float>> MakeEmbreeKernel(const Model<float>&);
template std::unique_ptr<Kernel<double>> MakeEmbreeKernel(const Model<double>&);

}  // namespace stipple::raytracer
