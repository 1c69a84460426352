// SPDX-License-Identifier: MIT
// Paints a window's parts: as triangles (scene_batch.h) in the same pixel coordinates as SceneItem
// paints them for SVG, straight into what the window shows, and only where something has changed.
// VTK's renderers clear, paint and copy the whole window for each frame: in software that alone
// takes longer than the bar for a frame.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_PAINTER_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_PAINTER_H

#include <vtkNew.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/views/window/changed_boxes.h"
#include "analysis/views/window/scene_batch.h"
#include "analysis/views/window/text_atlas.h"
#include "analysis/views/window/window_scene.h"

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkOpenGLVertexArrayObject;
class vtkShaderProgram;
class vtkTextureObject;

namespace stipple {

class WindowPainter {
 public:
  WindowPainter();
  ~WindowPainter();
  WindowPainter(const WindowPainter&) = delete;
  WindowPainter& operator=(const WindowPainter&) = delete;

  /// Turned into triangles at once, as far as they have changed.
  void Show(std::span<const ScenePart> parts, bool mono);
  /// What has changed since the last call is painted and seen.
  void Paint(vtkOpenGLRenderWindow& window);
  /// The next Paint paints all: what was seen is lost.
  void PaintAll() { width_ = 0; }
  /// While the window is still there.
  void ReleaseGraphicsResources();

 private:
  struct Batch {
    std::uint64_t version = 0;
    std::vector<Corner> corners;
    PixelBox box;
  };
  /// Neighbours among the triangles of a box that one program paints.
  struct Run {
    std::size_t first = 0, count = 0;
    bool fill = false;
  };
  void Build(std::span<const ScenePart> parts, bool mono);
  std::vector<Run> RunsIn(const PixelBox& box);
  void LoadAtlas(vtkOpenGLRenderWindow& window);
  void Load(vtkOpenGLRenderWindow& window);
  void Draw(vtkOpenGLRenderWindow& window, const Run& run);

  TextAtlas atlas_;
  std::vector<Batch> batches_;
  bool mono_ = false;
  std::vector<PixelBox> changed_;
  int width_ = 0, height_ = 0;   // of what is seen
  std::vector<Corner> corners_;  // to be painted now
  vtkNew<vtkOpenGLBufferObject> buffer_;
  vtkNew<vtkOpenGLVertexArrayObject> fill_array_, ink_array_;
  vtkShaderProgram* fill_ = nullptr;  // the window's
  vtkShaderProgram* ink_ = nullptr;
  vtkNew<vtkTextureObject> texture_;
  bool loaded_ = false;
};

}  // namespace stipple

#endif
