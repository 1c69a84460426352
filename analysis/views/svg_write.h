// SPDX-License-Identifier: MIT
// The repair of what VTK's SVG device makes, and its text form.
#ifndef STIPPLE_ANALYSIS_VIEWS_SVG_WRITE_H
#define STIPPLE_ANALYSIS_VIEWS_SVG_WRITE_H

#include <string>
#include <string_view>

#include "analysis/views/scene.h"
#include "analysis/views/svg.h"

class vtkXMLDataElement;

namespace stipple {

/// Escapes & < > " ' for element content and attribute values of HTML and SVG.
std::string EscapeMarkup(std::string_view text);

/// Repairs the device's elements below `root` and writes them as one <svg>:
/// outlines nobody asked for are dropped, anchors get SVG's names, baselines numbers, sizes are
/// pixels, the font family is the page's, and neighbours that differ only in their outline become
/// one path.
std::string WriteSvg(const Scene& scene, vtkXMLDataElement* root, const SvgOptions& options);

}  // namespace stipple

#endif
