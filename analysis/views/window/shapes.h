// SPDX-License-Identifier: MIT
// Short ways to write the shapes that a window's parts are made of.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_SHAPES_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_SHAPES_H

#include <string>
#include <utility>

#include "analysis/views/palette.h"
#include "analysis/views/scene.h"
#include "analysis/views/window/window_layout.h"

namespace stipple {

inline void AddRect(Layer& layer, const Area& area, Colour fill) {
  layer.shapes.emplace_back(RectShape{area.left, area.top, area.width, area.height, fill, {}});
}

inline void AddText(Layer& layer, Point at, std::string text, TextStyle style) {
  layer.shapes.emplace_back(TextShape{at.x, at.y, std::move(text), style});
}

inline void AddLine(Layer& layer, Point from, Point to, Colour stroke, double width = 1,
                    bool dashed = false) {
  layer.shapes.emplace_back(LineShape{{from, to}, stroke, width, dashed, 1});
}

inline void AddFrame(Layer& layer, const Area& a, Colour stroke, double width = 1) {
  const Point corners[] = {
      {a.left, a.top}, {a.right(), a.top}, {a.right(), a.bottom()}, {a.left, a.bottom()}};
  for (int i = 0; i < 4; ++i) AddLine(layer, corners[i], corners[(i + 1) % 4], stroke, width);
}

/// Bold, left, in the line above a part; where the part's own text may begin is returned.
double AddTitle(Layer& layer, Point at, const std::string& title);

}  // namespace stipple

#endif
