// SPDX-License-Identifier: MIT
// Pictures in memory: rows from the top, three numbers per pixel: red, green, blue.
#ifndef STIPPLE_RAYTRACER_IMAGE_IMAGE_H
#define STIPPLE_RAYTRACER_IMAGE_IMAGE_H

#include <cstdint>
#include <vector>

#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// White is 255.
struct Image {
  ImageSize size;
  std::vector<std::uint8_t> rgb;
};

/// White is 1; what is brighter is kept.
struct LinearImage {
  ImageSize size;
  std::vector<float> rgb;
};

}  // namespace stipple::raytracer

#endif
