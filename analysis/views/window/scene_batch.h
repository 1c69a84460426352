// SPDX-License-Identifier: MIT
// Shapes turned into one array of triangles: a whole window is drawn by a single call, whatever it
// holds. VTK's own 2-D painter sets up a draw for each shape and keeps the textures of 50 texts
// only; a window has hundreds of either. Edges of lines and texts are smooth without multisampling:
// a corner carries its distance from the middle of the line.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_SCENE_BATCH_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_SCENE_BATCH_H

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

/// What the shader makes of a corner's u and v.
enum class Ink : std::uint8_t {
  kFill = 0,
  kLine = 1,   // u: distance from the middle, v: half the width, in pixels
  kText = 2,   // place in the atlas, in texels
  kHatch = 3,  // lines of 45 degrees
};

struct Corner {
  float x = 0, y = 0;  // pixels, y downwards
  float u = 0, v = 0;
  float ink = 0;
  std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
  friend bool operator==(const Corner&, const Corner&) = default;
};
static_assert(sizeof(Corner) == 24);

/// A text in the atlas: its box in texels, and where the baseline is.
struct PlacedText {
  float left = 0, top = 0, width = 0, height = 0;
  float baseline = 0;  // below the top of the box
};

/// Where texts are kept ready.
class TextStore {
 public:
  virtual ~TextStore() = default;
  virtual PlacedText Of(const std::string& text, int size, bool bold) = 0;
};

/// Appends the layer's triangles. `mono`: greys, and a hatch for messages.
void AppendLayer(const Layer& layer, bool mono, TextStore& texts, std::vector<Corner>& corners);

/// Triangles of a simple polygon, three indices each; empty for fewer than three points.
std::vector<std::uint32_t> Triangles(const std::vector<Point>& polygon);

}  // namespace stipple

#endif
