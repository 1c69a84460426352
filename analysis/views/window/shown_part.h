// SPDX-License-Identifier: MIT
// How what was painted comes to be seen: by parts where the X server's OpenGL keeps what was
// painted before (Mesa does), else as a whole.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_SHOWN_PART_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_SHOWN_PART_H

#include <span>

#include "analysis/views/window/changed_boxes.h"

class vtkOpenGLRenderWindow;

namespace stipple {

/// Whether what is painted outside the boxes that are shown stays as it was.
bool CanShowParts(vtkOpenGLRenderWindow& window);
void ShowParts(vtkOpenGLRenderWindow& window, std::span<const PixelBox> boxes);

}  // namespace stipple

#endif
