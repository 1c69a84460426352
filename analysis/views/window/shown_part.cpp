// SPDX-License-Identifier: MIT
#include "analysis/views/window/shown_part.h"

// VTK's header before X's, whose macros would break it.
#include <vtkOpenGLRenderWindow.h>

#include <GL/glx.h>
#include <X11/Xlib.h>

#include <string_view>

namespace stipple {
namespace {

using CopySubBuffer = void (*)(Display*, GLXDrawable, int, int, int, int);

Display* DisplayOf(vtkOpenGLRenderWindow& window) {
  return static_cast<Display*>(window.GetGenericDisplayId());
}

/// GLX_MESA_copy_sub_buffer promises that the back buffer stays; swapping does not. Null: not here.
CopySubBuffer CopyFunction(Display* display) {
  static const CopySubBuffer kCopy = [display]() -> CopySubBuffer {
    const char* known = glXQueryExtensionsString(display, DefaultScreen(display));
    if (known == nullptr ||
        std::string_view(known).find("GLX_MESA_copy_sub_buffer") == std::string_view::npos)
      return nullptr;
    return reinterpret_cast<CopySubBuffer>(
        glXGetProcAddressARB(reinterpret_cast<const GLubyte*>("glXCopySubBufferMESA")));
  }();
  return kCopy;
}

}  // namespace

bool CanShowParts(vtkOpenGLRenderWindow& window) {
  return CopyFunction(DisplayOf(window)) != nullptr;
}

void ShowParts(vtkOpenGLRenderWindow& window, std::span<const PixelBox> boxes) {
  Display* display = DisplayOf(window);
  const auto drawable = reinterpret_cast<GLXDrawable>(window.GetGenericWindowId());
  const CopySubBuffer copy = CopyFunction(display);
  if (copy == nullptr) {
    glXSwapBuffers(display, drawable);
    return;
  }
  const int height = window.GetSize()[1];
  for (const PixelBox& box : boxes)
    if (!box.empty())
      copy(display, drawable, box.left, height - box.bottom, box.right - box.left,
           box.bottom - box.top);
}

}  // namespace stipple
