// SPDX-License-Identifier: MIT
// A picture of a run in a window of the X server, without events: what the window handles events
// for, and what frame times are measured of.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_CANVAS_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_CANVAS_H

#include <memory>
#include <string>
#include <vector>

#include "analysis/stats/window_source.h"
#include "analysis/views/window/controller.h"
#include "analysis/views/window/view_state.h"
#include "analysis/views/window/window_scene.h"

class vtkRenderWindow;

namespace stipple {

class WindowCanvas {
 public:
  WindowCanvas(const WindowSource& source, std::vector<int> ranks, int width, int height);
  ~WindowCanvas();
  WindowCanvas(const WindowCanvas&) = delete;
  WindowCanvas& operator=(const WindowCanvas&) = delete;

  void Render();
  /// The X server forgot what the window showed.
  void Uncovered();
  vtkRenderWindow* window();
  ViewState& state() { return state_; }
  WindowScene& scene() { return scene_; }
  Controller& controller() { return controller_; }

 private:
  const WindowSource& source_;
  ViewState state_;
  WindowScene scene_;
  Controller controller_;
  struct Vtk;  // so that who draws needs no header of VTK's
  std::unique_ptr<Vtk> vtk_;
  std::string title_;
};

}  // namespace stipple

#endif
