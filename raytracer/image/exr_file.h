// SPDX-License-Identifier: MIT
// OpenEXR pictures: what the rays brought, not limited to what a byte can hold. Only where OpenEXR
// was found when this program was configured.
#ifndef STIPPLE_RAYTRACER_IMAGE_EXR_FILE_H
#define STIPPLE_RAYTRACER_IMAGE_EXR_FILE_H

#include <string>

#include "raytracer/image/image.h"

namespace stipple::raytracer {

/// Errors: InputError if the file cannot be written, UsageError in a build without OpenEXR.
void WriteExr(const LinearImage& image, const std::string& path);

/// The channels R, G and B. Errors: InputError, UsageError in a build without OpenEXR.
LinearImage ReadExr(const std::string& path);

/// Errors: UsageError in a build without OpenEXR; so that nobody waits for a picture in vain.
void NeedExr(const std::string& path);

}  // namespace stipple::raytracer

#endif
