// SPDX-License-Identifier: MIT
#include "raytracer/image/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

constexpr png_uint_32 kLargestSide = 1U << 15;  // of a picture that we read

png_image NewPngImage() {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  return png;
}

}  // namespace

void WritePng(const Image& image, const std::string& path) {
  png_image png = NewPngImage();
  png.width = static_cast<png_uint_32>(image.size.width);
  png.height = static_cast<png_uint_32>(image.size.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&png, path.c_str(), 0, image.rgb.data(), 0, nullptr) == 0)
    throw InputError(path, 0, fmt::format("cannot be written: {}", png.message));
}

Image ReadPng(const std::string& path) {
  png_image png = NewPngImage();
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0)
    throw InputError(path, 0, fmt::format("cannot be read: {}", png.message));
  if (png.width > kLargestSide || png.height > kLargestSide) {
    png_image_free(&png);
    throw InputError(path, 0, fmt::format("picture of {}x{} is too large", png.width, png.height));
  }
  png.format = PNG_FORMAT_RGB;
  Image image;
  image.size = {static_cast<int>(png.width), static_cast<int>(png.height)};
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&png, &black, image.rgb.data(), 0, nullptr) == 0)
    throw InputError(path, 0, fmt::format("cannot be read: {}", png.message));
  return image;
}

ImageDifference Compare(const Image& a, const Image& b) {
  ImageDifference difference;
  difference.same_size = a.size == b.size;
  if (!difference.same_size) return difference;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < a.rgb.size(); pixel += 3) {
    bool differs = false;
    for (std::size_t i = pixel; i < pixel + 3; ++i) {
      const int d = std::abs(a.rgb[i] - b.rgb[i]);
      difference.max = std::max(difference.max, d);
      squares += static_cast<double>(d) * d;
      differs = differs || d != 0;
    }
    if (differs) ++difference.pixels;
  }
  if (!a.rgb.empty()) difference.rms = std::sqrt(squares / static_cast<double>(a.rgb.size()));
  return difference;
}

}  // namespace stipple::raytracer
