// SPDX-License-Identifier: MIT
// In place of exr_file.cpp where OpenEXR was not found.
#include <fmt/format.h>

#include "raytracer/errors.h"
#include "raytracer/image/exr_file.h"

namespace stipple::raytracer {

void NeedExr(const std::string& path) {
  throw UsageError(
      fmt::format("{}: this build has no OpenEXR; install libopenexr-dev, then "
                  "configure and build again, or use a .png",
                  path));
}

void WriteExr(const LinearImage&, const std::string& path) { NeedExr(path); }

LinearImage ReadExr(const std::string& path) {
  NeedExr(path);
  return {};
}

}  // namespace stipple::raytracer
