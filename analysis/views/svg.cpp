// SPDX-License-Identifier: MIT
// VTK's exporters need a window; its SVG device needs only a viewport that knows its window's size.
// Both are given to it as the empty shells below, so neither display nor OpenGL is touched.
#include "analysis/views/svg.h"

#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkSVGContextDevice2D.h>
#include <vtkViewport.h>
#include <vtkWindow.h>
#include <vtkXMLDataElement.h>

#include <cmath>

#include "analysis/views/palette.h"
#include "analysis/views/scene_item.h"
#include "analysis/views/svg_write.h"

namespace stipple {
namespace {

/// A window that is only a size.
class Sheet : public vtkWindow {
 public:
  static Sheet* New();
};
vtkStandardNewMacro(Sheet);

/// A viewport that covers a sheet.
class SheetViewport : public vtkViewport {
 public:
  static SheetViewport* New();
  void SetSheet(vtkWindow* sheet) { this->VTKWindow = sheet; }
  vtkWindow* GetVTKWindow() override { return this->VTKWindow; }
  vtkAssemblyPath* PickProp(double, double) override { return nullptr; }
  vtkAssemblyPath* PickProp(double, double, double, double) override { return nullptr; }
};
vtkStandardNewMacro(SheetViewport);

void AddTooltip(vtkXMLDataElement* group, const Shape& shape) {
  const auto* rect = std::get_if<RectShape>(&shape);
  if (rect == nullptr || rect->tooltip.empty()) return;
  vtkNew<vtkXMLDataElement> title;
  title->SetName("title");
  title->SetCharacterData(rect->tooltip.c_str(), static_cast<int>(rect->tooltip.size()));
  for (int i = group->GetNumberOfNestedElements() - 1; i >= 0; --i) {
    vtkXMLDataElement* drawn = group->GetNestedElement(i);
    if (std::string_view(drawn->GetName()) != "path") continue;
    drawn->AddNestedElement(title);
    return;
  }
}

void DrawLayer(SceneItem* item, const Layer& layer, vtkViewport* viewport,
               vtkXMLDataElement* root) {
  vtkNew<vtkXMLDataElement> group, definitions;
  group->SetName("g");
  definitions->SetName("defs");
  if (!layer.name.empty()) group->SetAttribute("class", layer.name.c_str());
  vtkNew<vtkSVGContextDevice2D> device;
  device->SetTextAsPath(false);
  device->SetEmbedFonts(false);
  device->SetSVGContext(group, definitions);
  vtkNew<vtkContext2D> painter;
  device->Begin(viewport);
  painter->Begin(device);
  for (const Shape& shape : layer.shapes) {
    item->PaintShape(painter, shape);
    AddTooltip(group, shape);
  }
  painter->End();
  device->End();
  root->AddNestedElement(group);
}

}  // namespace

std::string DrawSvg(const Scene& scene, const SvgOptions& options) {
  // VTK counts in whole pixels and flips y about the height, so both use the same whole number.
  Scene whole = scene;
  whole.width = std::ceil(scene.width);
  whole.height = std::ceil(scene.height);
  if (options.standalone)
    whole.layers.insert(whole.layers.begin(),
                        Layer{"ground", {RectShape{0, 0, whole.width, whole.height, kWhite, {}}}});
  vtkNew<Sheet> sheet;
  sheet->SetSize(static_cast<int>(whole.width), static_cast<int>(whole.height));
  vtkNew<SheetViewport> viewport;
  viewport->SetSheet(sheet);
  vtkNew<SceneItem> item;
  item->Show(&whole);
  vtkNew<vtkXMLDataElement> root;
  root->SetName("svg");
  for (const Layer& layer : whole.layers) DrawLayer(item, layer, viewport, root);
  viewport->SetSheet(nullptr);
  return WriteSvg(whole, root, options);
}

}  // namespace stipple
