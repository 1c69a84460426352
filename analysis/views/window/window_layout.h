// SPDX-License-Identifier: MIT
// Where the parts of a window lie at its present size: header, overview strip, timeline, curves and
// displays below it, facts and menu at the right. Parts that find no room are left out, the lowest
// first; the timeline stays.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_LAYOUT_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_LAYOUT_H

#include <vector>

#include "analysis/views/scene.h"
#include "analysis/views/window/view_state.h"

namespace stipple {

struct Area {
  double left = 0, top = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
  bool Has(Point p) const { return p.x >= left && p.x < right() && p.y >= top && p.y < bottom(); }
  friend bool operator==(const Area&, const Area&) = default;
};

/// A panel that is shown, and where.
struct PlacedPanel {
  Panel panel = Panel::kUtilisation;
  Area area;
};

struct WindowLayout {
  double width = 0, height = 0;
  Area header;
  Area overview;                      // the strip; its axis is below it
  Area timeline;                      // rows with their labels, and the axis
  std::vector<PlacedPanel> curves;    // as wide as the timeline
  std::vector<PlacedPanel> displays;  // side by side below
  Area side;                          // no width: there is no room for it
};

inline constexpr double kWindowMargin = 16;
inline constexpr double kTitleHeight = 28;  // above the timeline, a curve, a display
inline constexpr double kLeastWindowWidth = 320;
inline constexpr double kLeastWindowHeight = 200;

WindowLayout LayOut(double width, double height, const ViewState& state);

}  // namespace stipple

#endif
