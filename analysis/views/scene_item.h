// SPDX-License-Identifier: MIT
// The one context item: paints a scene in pixel coordinates, without transforms or clips, so that
// windows (OpenGL), SVG and PDF devices show the same.
#ifndef STIPPLE_ANALYSIS_VIEWS_SCENE_ITEM_H
#define STIPPLE_ANALYSIS_VIEWS_SCENE_ITEM_H

#include <vtkContextItem.h>

#include "analysis/views/scene.h"

class vtkContext2D;

namespace stipple {

// VTK's items have a member named Scene, hence the full name below.
class SceneItem : public vtkContextItem {
 public:
  static SceneItem* New();

  /// Not owned; must outlive the painting.
  void Show(const stipple::Scene* scene) { scene_ = scene; }
  bool Paint(vtkContext2D* painter) override;
  void PaintShape(vtkContext2D* painter, const Shape& shape) const;

 protected:
  SceneItem() = default;
  ~SceneItem() override = default;

 private:
  const stipple::Scene* scene_ = nullptr;
};

}  // namespace stipple

#endif
