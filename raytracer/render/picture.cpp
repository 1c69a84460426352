// SPDX-License-Identifier: MIT
#include "raytracer/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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

struct PixelCost {
  std::uint64_t work = 0;
  std::uint32_t object = kNoObject;
  std::uint32_t in_shadow = 0;
  std::uint32_t depth = 0;
};

std::vector<PixelCost> CostsOf(const Raster& raster, ImageSize image, Samples samples) {
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

Image PictureOf(const Raster& raster, ImageSize image, Samples samples) {
  const int width = RasterOf(image, samples).width;
  const std::int64_t rays = samples.corners() ? 4 : samples.per_pixel;
  Image picture{image, {}};
  picture.rgb.reserve(3 * Index(0, image.height, image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      FixedColor sum;
      const int reach = samples.corners() ? 1 : 0;  // a pixel's points: itself, or its four corners
      for (int dy = 0; dy <= reach; ++dy) {
        for (int dx = 0; dx <= reach; ++dx) {
          const FixedColor& color = raster[Index(x + dx, y + dy, width)].color;
          sum.red += color.red;
          sum.green += color.green;
          sum.blue += color.blue;
        }
      }
      for (const std::int64_t component : {sum.red, sum.green, sum.blue})
        picture.rgb.push_back(ToByte(component, rays));
    }
  }
  return picture;
}

Image CostImageOf(const Raster& raster, ImageSize image, Samples samples) {
  const std::vector<PixelCost> costs = CostsOf(raster, image, samples);
  std::uint64_t dearest = 1;
  for (const PixelCost& cost : costs) dearest = std::max(dearest, cost.work);
  Image picture{image, {}};
  picture.rgb.reserve(3 * costs.size());
  for (const PixelCost& cost : costs)
    picture.rgb.insert(picture.rgb.end(), 3,
                       static_cast<std::uint8_t>((cost.work * 255 + dearest / 2) / dearest));
  return picture;
}

std::string CostTableOf(const Raster& raster, ImageSize image, Samples samples) {
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
