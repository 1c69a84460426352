// SPDX-License-Identifier: MIT
#include "raytracer/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "raytracer/image/ramp.h"

namespace stipple::raytracer {
namespace {

std::size_t Index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

std::uint8_t ToByte(std::int64_t sum, std::int64_t rays) {
  const std::int64_t full = rays * kFixedOne;
  const std::int64_t bounded = std::clamp<std::int64_t>(sum, 0, full);
  return static_cast<std::uint8_t>((bounded * 255 + full / 2) / full);
}

double MeanOf(std::int64_t sum, std::int64_t rays) {
  return static_cast<double>(sum) / (static_cast<double>(kFixedOne) * static_cast<double>(rays));
}

/// Tells `use` all rays of each pixel: those of its point, or of its four corners. A pixel at a
/// time: all of them would be as large as the raster.
template <class Use>
void ForEachPixel(RasterView raster, ImageSize image, Samples samples, Use use) {
  const int width = RasterOf(image, samples).width;
  const int reach = samples.corners() ? 1 : 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      RayResult pixel;
      for (int dy = 0; dy <= reach; ++dy)
        for (int dx = 0; dx <= reach; ++dx) Add(raster[Index(x + dx, y + dy, width)], pixel);
      use(pixel);
    }
}

void Bound(const RayResult& pixel, double pixels, LossBound& bound) {
  // What makes a component brighter than white is not seen.
  const std::int64_t darkest = std::min({pixel.color.red, pixel.color.green, pixel.color.blue});
  const double room = 1 - std::clamp(MeanOf(darkest, pixel.rays), 0.0, 1.0);
  const double lost = std::min(MeanOf(pixel.lost, pixel.rays), room);
  bound.mean += lost / pixels;
  bound.worst = std::max(bound.worst, lost);
}

/// A picture whose components are `component(sum, rays)`.
template <class Pixels, class Component>
Bounded<Pixels> Develop(RasterView raster, ImageSize image, Samples samples, Component component) {
  Bounded<Pixels> made{{image, {}}, {}};
  const std::size_t pixels = Index(0, image.height, image.width);
  made.picture.rgb.reserve(3 * pixels);
  ForEachPixel(raster, image, samples, [&](const RayResult& pixel) {
    for (const std::int64_t sum : {pixel.color.red, pixel.color.green, pixel.color.blue})
      made.picture.rgb.push_back(component(sum, pixel.rays));
    Bound(pixel, static_cast<double>(pixels), made.loss);
  });
  return made;
}

struct PixelCost {
  std::uint64_t work = 0;
  std::uint32_t object = kNoObject;
  std::uint32_t in_shadow = 0;
  std::uint32_t depth = 0;
};

std::vector<PixelCost> CostsOf(RasterView raster, ImageSize image, Samples samples) {
  const ImageSize size = RasterOf(image, samples);
  std::vector<PixelCost> costs(Index(0, image.height, image.width));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const RayResult& result = raster[Index(x, y, size.width)];
      PixelCost& cost =
          costs[Index(std::min(x, image.width - 1), std::min(y, image.height - 1), image.width)];
      cost.work += result.work;
      cost.depth = std::max<std::uint32_t>(cost.depth, result.depth);
      if (x >= image.width || y >= image.height) continue;
      cost.object = result.object;
      cost.in_shadow = result.in_shadow;
    }
  }
  return costs;
}

}  // namespace

Bounded<Image> PictureOf(RasterView raster, ImageSize image, Samples samples) {
  return Develop<Image>(raster, image, samples, ToByte);
}

Bounded<LinearImage> LinearPictureOf(RasterView raster, ImageSize image, Samples samples) {
  return Develop<LinearImage>(raster, image, samples, [](std::int64_t sum, std::int64_t rays) {
    return static_cast<float>(MeanOf(sum, rays));
  });
}

LossBound LossOf(RasterView raster, ImageSize image, Samples samples) {
  LossBound bound;
  const auto pixels = static_cast<double>(Index(0, image.height, image.width));
  ForEachPixel(raster, image, samples,
               [&](const RayResult& pixel) { Bound(pixel, pixels, bound); });
  return bound;
}

Image CostImageOf(RasterView raster, ImageSize image, Samples samples) {
  const std::vector<PixelCost> costs = CostsOf(raster, image, samples);
  std::uint64_t dearest = 1;
  for (const PixelCost& cost : costs) dearest = std::max(dearest, cost.work);
  Image picture{image, {}};
  picture.rgb.reserve(3 * costs.size());
  for (const PixelCost& cost : costs) {
    const Rgb color =
        ColorAt(kViridis, std::sqrt(static_cast<double>(cost.work) / static_cast<double>(dearest)));
    picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
  }
  return picture;
}

std::string CostTableOf(RasterView raster, ImageSize image, Samples samples) {
  const std::vector<PixelCost> costs = CostsOf(raster, image, samples);
  std::string table = "x,y,work,object,in_shadow,depth\n";
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const PixelCost& cost = costs[Index(x, y, image.width)];
      const long object = cost.object == kNoObject ? -1 : static_cast<long>(cost.object);
      fmt::format_to(std::back_inserter(table), "{},{},{},{},{},{}\n", x, y, cost.work, object,
                     cost.in_shadow, cost.depth);
    }
  }
  return table;
}

}  // namespace stipple::raytracer
