// SPDX-License-Identifier: MIT
#include "raytracer/geometry/kernel.h"

#include <string>
#include <type_traits>

#include "raytracer/errors.h"
#include "raytracer/geometry/bvh_kernel.h"
#include "raytracer/geometry/embree_kernel.h"

namespace stipple::raytracer {

template <class Real>
std::unique_ptr<Kernel<Real>> MakeKernel(std::string_view name, const Model<Real>& model) {
  if (name == "scalar") return MakeScalarKernel(model);
  if constexpr (std::is_same_v<Real, long double>) {
    if (name == "bvh") return MakeScalarKernel(model);  // no machine has vectors of them
  } else {
    if (name == "bvh") return MakeVectorKernel(model);
    if (name == "embree") return MakeEmbreeKernel(model);
  }
  throw UsageError("--kernel " + std::string(name) + ": cannot compute in this kind of number");
}

template std::unique_ptr<Kernel<float>> MakeKernel(std::string_view, const Model<float>&);
template std::unique_ptr<Kernel<double>> MakeKernel(std::string_view, const Model<double>&);
template std::unique_ptr<Kernel<long double>> MakeKernel(std::string_view,
                                                         const Model<long double>&);

}  // namespace stipple::raytracer
