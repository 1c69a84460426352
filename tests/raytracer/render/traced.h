// SPDX-License-Identifier: MIT
// A scene with all that traces it, and whole pictures of it, on one rank.
#ifndef STIPPLE_TESTS_RAYTRACER_RENDER_TRACED_H
#define STIPPLE_TESTS_RAYTRACER_RENDER_TRACED_H

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "raytracer/render/picture.h"
#include "raytracer/render/render.h"

namespace stipple::raytracer {

struct Traced {
  Traced(Scene with, ImageSize size, Samples per_pixel, ShadingChoice shading = {})
      : scene(std::move(with)),
        image(size),
        samples(per_pixel),
        model(BuildModel<double>(std::move(scene.shapes))),
        kernel(MakeKernel("bvh", model)),
        sampler(MakeSampler(scene, model, *kernel, shading, image, samples)) {}

  /// All rounds, as Render does them.
  Raster Draw() const {
    Raster raster;
    for (RasterPoint point = 0; point < PointCount(RasterOf(image, samples)); ++point)
      raster.push_back(sampler->Sample(point));
    for (bool more = samples.adaptive; more;) {
      const Doubling doubling = WorthDoubling(raster, image, samples.tolerance);
      more = false;
      for (RasterPoint point = 0; point < raster.size(); ++point) {
        if (doubling[point] == 0) continue;
        Add(sampler->SampleAgain(point, 1 << doubling[point]), raster[point]);
        more = true;
      }
    }
    return raster;
  }
  LinearImage Picture() const { return LinearPictureOf(Draw(), image, samples).picture; }

  Scene scene;
  ImageSize image;
  Samples samples;
  Model<double> model;
  std::unique_ptr<Kernel<double>> kernel;
  std::unique_ptr<Sampler> sampler;
};

}  // namespace stipple::raytracer

#endif
