// SPDX-License-Identifier: MIT
// One kernel for each set of vector instructions; the best that the machine has is chosen when the
// program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytracer/geometry/vector_kernel.cpp"
#include <hwy/foreach_target.h>
// The order matters: what follows is compiled for one target after the other.
#include <hwy/highway.h>

#include "raytracer/geometry/bvh_kernel.h"
#include "raytracer/geometry/vector_tests_inl.h"
#include "raytracer/geometry/walk_inl.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::raytracer {
namespace HWY_NAMESPACE {

Kernel<float>* MakeFloatKernel(const Model<float>& model) {
  return new BvhKernel<VectorTests<float>>(model);
}

Kernel<double>* MakeDoubleKernel(const Model<double>& model) {
  return new BvhKernel<VectorTests<double>>(model);
}

}  // namespace HWY_NAMESPACE
}  // namespace stipple::raytracer
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple::raytracer {

HWY_EXPORT(MakeFloatKernel);
HWY_EXPORT(MakeDoubleKernel);

template <>
std::unique_ptr<Kernel<float>> MakeVectorKernel(const Model<float>& model) {
  return std::unique_ptr<Kernel<float>>(HWY_DYNAMIC_DISPATCH(MakeFloatKernel)(model));
}

template <>
std::unique_ptr<Kernel<double>> MakeVectorKernel(const Model<double>& model) {
  return std::unique_ptr<Kernel<double>>(HWY_DYNAMIC_DISPATCH(MakeDoubleKernel)(model));
}

}  // namespace stipple::raytracer
#endif
