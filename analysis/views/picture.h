// SPDX-License-Identifier: MIT
// An SVG as PNG or PDF, so that all files of a picture are drawn from the same text.
#ifndef STIPPLE_ANALYSIS_VIEWS_PICTURE_H
#define STIPPLE_ANALYSIS_VIEWS_PICTURE_H

#include <string>

#include "analysis/views/scene.h"

namespace stipple {

/// Pixels of a PNG for each of the scene's: sharp on paper and on fine screens.
inline constexpr double kPngScale = 2;

/// The bytes of a file by the end of its name: ".svg", ".png" or ".pdf". The same scene gives the
/// same bytes. Errors: std::runtime_error, also for another ending.
std::string PictureOf(const Scene& scene, const std::string& path, bool mono);

/// Whether PictureOf knows the ending.
bool IsPictureName(const std::string& path);

}  // namespace stipple

#endif
