// SPDX-License-Identifier: MIT
// The context item of a window: paints its parts by one draw call (scene_batch.h), in the same
// pixel coordinates as SceneItem paints them for SVG.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_ITEM_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_ITEM_H

#include <vtkContextItem.h>
#include <vtkNew.h>

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/views/window/scene_batch.h"
#include "analysis/views/window/text_atlas.h"
#include "analysis/views/window/window_scene.h"

class vtkOpenGLBufferObject;
class vtkOpenGLRenderWindow;
class vtkOpenGLVertexArrayObject;
class vtkTextureObject;
class vtkWindow;

namespace stipple {

class WindowItem : public vtkContextItem {
 public:
  static WindowItem* New();

  /// Turned into triangles at once, as far as they have changed.
  void Show(std::span<const ScenePart> parts, bool mono);
  bool Paint(vtkContext2D* painter) override;
  void ReleaseGraphicsResources() override;

  std::size_t corner_count() const { return corners_.size(); }

 protected:
  WindowItem();
  ~WindowItem() override;

 private:
  struct Batch {
    std::uint64_t version = 0;
    std::vector<Corner> corners;
  };
  void Build(std::span<const ScenePart> parts, bool mono);
  void LoadAtlas(vtkOpenGLRenderWindow* window);

  TextAtlas atlas_;
  std::vector<Batch> batches_;
  bool mono_ = false;
  std::vector<Corner> corners_;
  vtkNew<vtkOpenGLBufferObject> buffer_;
  vtkNew<vtkOpenGLVertexArrayObject> array_;
  vtkNew<vtkTextureObject> texture_;
  bool loaded_ = false;
};

}  // namespace stipple

#endif
