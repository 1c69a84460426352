// SPDX-License-Identifier: MIT
// Draws a scene in ways that the ray tracer does not offer, to see what its choices are worth:
//   bench_features draw SCENE SIZE PIXELS auto|transmitting|extended   no output; count its
//   instructions bench_features hierarchy OBJECTS PIXELS                            CPU seconds
//   with and without one
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <string_view>

#include "raytracer/image/compare.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/sampling.h"
#include "raytracer/scene/load.h"
#include "tests/raytracer/brute_force_kernel.h"

namespace stipple::raytracer {
namespace {

double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds of tracing all corners.
double Draw(const Scene& scene, const Model<double>& model, const Kernel<double>& kernel,
            ShadingChoice shading, int pixels) {
  const ImageSize size{pixels, pixels};
  const auto sampler = MakeSampler(scene, model, kernel, shading, size, {});
  const double start = CpuSeconds();
  for (RasterPoint point = 0; point < PointCount(RasterOf(size, {})); ++point)
    sampler->Sample(point);
  return CpuSeconds() - start;
}

int DrawWith(const char* const* words) {
  Scene scene = LoadScene({.scene = words[0], .size = std::atol(words[1])});
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const std::string_view rules = words[3];
  ShadingChoice shading;
  if (rules == "transmitting") shading.at_least = Rules::kTransmitting;
  if (rules == "extended") shading.at_least = Rules::kExtended;
  Draw(scene, model, *MakeKernel("bvh", model), shading, std::atoi(words[2]));
  return 0;
}

int CompareHierarchy(const char* const* words) {
  Scene scene = LoadScene({.scene = "rings",
                           .size = 2,
                           .object_limit = static_cast<std::uint64_t>(std::atol(words[0]))});
  const BruteForceKernel all(scene.shapes);
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const int pixels = std::atoi(words[1]);
  const double with = Draw(scene, model, *MakeKernel("bvh", model), {}, pixels);
  fmt::print("{:.4f} {:.4f}\n", with, Draw(scene, model, all, {}, pixels));
  return 0;
}

struct Drawn {
  Image image;
  RayCounts counts;
};

template <class Real>
Drawn DrawIn(Scene scene, ImageSize size) {
  const Model<Real> model = BuildModel<Real>(std::move(scene.shapes));
  const auto kernel = MakeKernel("bvh", model);
  const auto sampler = MakeSampler(scene, model, *kernel, {}, size, {});
  Raster raster;
  for (RasterPoint point = 0; point < PointCount(RasterOf(size, {})); ++point)
    raster.push_back(sampler->Sample(point));
  return {PictureOf(raster, size, {}).picture, sampler->counts()};
}

int CompareDigits(const char* const* words) {
  const Scene scene = LoadScene({.scene = words[0], .size = std::atol(words[1])});
  const int pixels = std::atoi(words[2]);
  const Drawn own = DrawIn<double>(scene, {pixels, pixels});
  const Drawn exact = DrawIn<long double>(scene, {pixels, pixels});
  fmt::print("{} {}\n", Compare(Linear(own.image), Linear(exact.image)).pixels,
             static_cast<std::int64_t>(own.counts.Rays() - exact.counts.Rays()));
  return 0;
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "draw" && argc == 6) return stipple::raytracer::DrawWith(argv + 2);
  if (what == "hierarchy" && argc == 4) return stipple::raytracer::CompareHierarchy(argv + 2);
  if (what == "exact" && argc == 5) return stipple::raytracer::CompareDigits(argv + 2);
  fmt::print(stderr,
             "usage: bench_features draw SCENE SIZE PIXELS auto|transmitting|extended\n"
             "       bench_features hierarchy OBJECTS PIXELS\n"
             "       bench_features exact SCENE SIZE PIXELS\n");
  return 2;
}
