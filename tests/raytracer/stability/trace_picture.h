// SPDX-License-Identifier: MIT
// A whole picture in any kind of number, as the program makes it.
#ifndef STIPPLE_TESTS_RAYTRACER_STABILITY_TRACE_PICTURE_H
#define STIPPLE_TESTS_RAYTRACER_STABILITY_TRACE_PICTURE_H

#include <memory>
#include <string_view>
#include <utility>

#include "raytracer/render/picture.h"
#include "raytracer/render/sampling.h"

namespace stipple::raytracer {

struct Traced {
  RayCounts counts;
  Image picture;
};

/// By a kernel of the caller's.
template <class Real>
Traced TraceWith(const Scene& scene, const Model<Real>& model, const Kernel<Real>& kernel,
                 ImageSize image, ShadingChoice shading = {}) {
  const Samples corners;
  const auto sampler = MakeSampler(scene, model, kernel, shading, image, corners);
  Raster raster;
  for (RasterPoint point = 0; point < PointCount(RasterOf(image, corners)); ++point)
    raster.push_back(sampler->Sample(point));
  return {sampler->counts(), PictureOf(raster, image, corners).picture};
}

template <class Real>
Traced Trace(Scene scene, std::string_view kernel_name, ImageSize image,
             ShadingChoice shading = {}) {
  const Model<Real> model = BuildModel<Real>(std::move(scene.shapes));
  return TraceWith(scene, model, *MakeKernel(kernel_name, model), image, shading);
}

}  // namespace stipple::raytracer

#endif
