// SPDX-License-Identifier: MIT
#include "raytracer/image/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include "raytracer/errors.h"
#include "raytracer/whole_file.h"

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
  png.flags = PNG_IMAGE_FLAG_FAST;  // while one rank writes, the others wait
  WriteWhole(path, [&](const std::string& file) {
    if (png_image_write_to_file(&png, file.c_str(), 0, image.rgb.data(), 0, nullptr) == 0)
      throw InputError(path, 0, fmt::format("cannot be written: {}", png.message));
  });
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

}  // namespace stipple::raytracer
