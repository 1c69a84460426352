// SPDX-License-Identifier: MIT
// How far two pictures are from each other, in numbers and as a picture.
#ifndef STIPPLE_RAYTRACER_IMAGE_COMPARE_H
#define STIPPLE_RAYTRACER_IMAGE_COMPARE_H

#include <cstdint>
#include <string>

#include "raytracer/image/image.h"

namespace stipple::raytracer {

/// Bytes as numbers.
LinearImage Linear(const Image& bytes);

/// A PNG or, by its ending, an EXR; white is 1 in both. Errors: InputError, UsageError.
LinearImage ReadPicture(const std::string& path);

struct ImageDifference {
  ImageSize a, b;
  double largest = 0;        // of one component; white is 1
  int x = 0, y = 0;          // the first pixel that has it
  double rmse = 0;           // root of the mean square over all components
  std::uint64_t pixels = 0;  // that differ

  bool SameSize() const { return a == b; }
  bool Identical() const { return SameSize() && pixels == 0; }
};
ImageDifference Compare(const LinearImage& a, const LinearImage& b);

/// One line that says it: size, pixels that differ, RMSE, PSNR with respect to white, the largest
/// difference and where it is.
std::string DifferenceText(const ImageDifference& difference);

/// `a` in dim grey; pixels that differ glow, from violet (one step of 255) over orange to yellow
/// (all of the range), by the logarithm. Both have the same size.
Image DifferencePicture(const LinearImage& a, const LinearImage& b);

}  // namespace stipple::raytracer

#endif
