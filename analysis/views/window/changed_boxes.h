// SPDX-License-Identifier: MIT
// Which pixels a change of triangles touches. Drawn in software a frame costs what it paints, not
// what it holds: only these boxes are painted anew, and the rest of the window stays.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_CHANGED_BOXES_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_CHANGED_BOXES_H

#include <span>
#include <vector>

#include "analysis/views/window/scene_batch.h"

namespace stipple {

/// Pixels [left, right) x [top, bottom), y downwards.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return left >= right || top >= bottom; }
  bool Meets(const PixelBox& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

PixelBox BoxOf(std::span<const Corner> corners);

/// Adds a box; those that meet become one, so that no pixel is painted twice.
void AddBox(std::vector<PixelBox>& boxes, PixelBox box);

/// Adds what must be painted anew when triangles are replaced; nothing where they are equal.
void AddChange(std::vector<PixelBox>& boxes, std::span<const Corner> before,
               std::span<const Corner> after);

}  // namespace stipple

#endif
