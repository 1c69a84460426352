// SPDX-License-Identifier: MIT
// The window itself: VTK's render window and interactor around a state, a scene and a controller.
// All that VTK does here is to open it, hand over events and show triangles.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_H

#include <string>
#include <vector>

#include "analysis/stats/window_source.h"

namespace stipple {

/// Why no window can be opened here; empty: it can. Asks the X server before VTK does, which ends
/// the program when there is none.
std::string WhyNoDisplay();

struct WindowOptions {
  std::vector<int> ranks;  // shown at first; empty: all
  bool mono = false;
};

/// Opens a window and returns when it is closed.
void ShowWindow(const WindowSource& source, const WindowOptions& options);

}  // namespace stipple

#endif
