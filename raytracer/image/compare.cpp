// SPDX-License-Identifier: MIT
#include "raytracer/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "raytracer/image/exr_file.h"
#include "raytracer/image/png_file.h"
#include "raytracer/image/ramp.h"

namespace stipple::raytracer {
namespace {

/// The largest difference of a component of the pixel that begins at `i`; what cannot be compared
/// differs by all of the range.
double PixelDifference(const LinearImage& a, const LinearImage& b, std::size_t i) {
  double largest = 0;
  for (std::size_t c = i; c < i + 3; ++c) {
    const double d = std::abs(static_cast<double>(a.rgb[c]) - static_cast<double>(b.rgb[c]));
    largest = std::max(largest, std::isfinite(d) ? d : a.rgb[c] == b.rgb[c] ? 0.0 : 1.0);
  }
  return largest;
}

std::uint8_t DimGrey(const float* rgb) {
  const double luma = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  return static_cast<std::uint8_t>(20 + std::lround(90 * std::clamp(luma, 0.0, 1.0)));
}

}  // namespace

LinearImage Linear(const Image& bytes) {
  LinearImage image{bytes.size, {}};
  image.rgb.reserve(bytes.rgb.size());
  for (const std::uint8_t byte : bytes.rgb) image.rgb.push_back(static_cast<float>(byte) / 255);
  return image;
}

LinearImage ReadPicture(const std::string& path) {
  return path.ends_with(".exr") ? ReadExr(path) : Linear(ReadPng(path));
}

ImageDifference Compare(const LinearImage& a, const LinearImage& b) {
  ImageDifference difference{.a = a.size, .b = b.size};
  if (!difference.SameSize()) return difference;
  double squares = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const double largest = PixelDifference(a, b, i);
    if (largest == 0) continue;
    ++difference.pixels;
    for (std::size_t c = i; c < i + 3; ++c) {
      const double d = static_cast<double>(a.rgb[c]) - static_cast<double>(b.rgb[c]);
      squares += d * d;
    }
    if (largest <= difference.largest) continue;
    difference.largest = largest;
    difference.x = static_cast<int>(i / 3 % static_cast<std::size_t>(a.size.width));
    difference.y = static_cast<int>(i / 3 / static_cast<std::size_t>(a.size.width));
  }
  if (!a.rgb.empty()) difference.rmse = std::sqrt(squares / static_cast<double>(a.rgb.size()));
  return difference;
}

std::string DifferenceText(const ImageDifference& d) {
  if (!d.SameSize())
    return fmt::format("different sizes: {}x{} and {}x{} pixels\n", d.a.width, d.a.height,
                       d.b.width, d.b.height);
  if (d.Identical()) return fmt::format("identical: {}x{} pixels\n", d.a.width, d.a.height);
  const double share = static_cast<double>(d.pixels) / d.a.width / d.a.height;
  return fmt::format(
      "different: {} of {}x{} pixels ({:.3g} %), RMSE {:.4g} of 255, PSNR {:.1f} dB, largest "
      "difference {:.4g} of 255 at column {}, row {}\n",
      d.pixels, d.a.width, d.a.height, 100 * share, 255 * d.rmse, -20 * std::log10(d.rmse),
      255 * d.largest, d.x, d.y);
}

Image DifferencePicture(const LinearImage& a, const LinearImage& b) {
  Image picture{a.size, {}};
  picture.rgb.reserve(a.rgb.size());
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const double d = PixelDifference(a, b, i);
    if (d > 0) {
      const Rgb color = ColorAt(kGlow, std::log(std::max(255 * d, 1.0)) / std::log(255.0));
      picture.rgb.insert(picture.rgb.end(), color.begin(), color.end());
    } else {
      picture.rgb.insert(picture.rgb.end(), 3, DimGrey(&a.rgb[i]));
    }
  }
  return picture;
}

}  // namespace stipple::raytracer
