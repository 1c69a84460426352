// SPDX-License-Identifier: MIT
// Pictures on disk.
#ifndef STIPPLE_RAYTRACER_IMAGE_PNG_FILE_H
#define STIPPLE_RAYTRACER_IMAGE_PNG_FILE_H

#include <cstdint>
#include <string>
#include <vector>

#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// Rows from the top, three bytes per pixel: red, green, blue.
struct Image {
  ImageSize size;
  std::vector<std::uint8_t> rgb;
};

/// Errors: InputError if the file cannot be written.
void WritePng(const Image& image, const std::string& path);

/// Any PNG, as 8-bit colours without transparency. Errors: InputError.
Image ReadPng(const std::string& path);

struct ImageDifference {
  bool same_size = true;
  int max = 0;               // largest difference of one component, of 255
  double rms = 0;            // root of the mean square over all components
  std::uint64_t pixels = 0;  // that differ

  bool Identical() const { return same_size && pixels == 0; }
};
ImageDifference Compare(const Image& a, const Image& b);

}  // namespace stipple::raytracer

#endif
