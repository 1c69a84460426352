// SPDX-License-Identifier: MIT
// PNG pictures on disk.
#ifndef STIPPLE_RAYTRACER_IMAGE_PNG_FILE_H
#define STIPPLE_RAYTRACER_IMAGE_PNG_FILE_H

#include <string>

#include "raytracer/image/image.h"

namespace stipple::raytracer {

/// Errors: InputError if the file cannot be written.
void WritePng(const Image& image, const std::string& path);

/// Any PNG, as 8-bit colours without transparency. Errors: InputError.
Image ReadPng(const std::string& path);

}  // namespace stipple::raytracer

#endif
