// SPDX-License-Identifier: MIT
// Scenes drawn as SVG by VTK's own device, without display, window or OpenGL. Text stays text.
#ifndef STIPPLE_ANALYSIS_VIEWS_SVG_H
#define STIPPLE_ANALYSIS_VIEWS_SVG_H

#include <string>

#include "analysis/views/scene.h"

namespace stipple {

struct SvgOptions {
  bool standalone = false;  // a file of its own: name space, size, white ground
  bool mono = false;        // patterns and greys: states and lines are told apart without colour
};

/// The same scene gives the same bytes, everywhere.
std::string DrawSvg(const Scene& scene, const SvgOptions& options = {});

}  // namespace stipple

#endif
