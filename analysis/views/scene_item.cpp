// SPDX-License-Identifier: MIT
#include "analysis/views/scene_item.h"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <vector>

#include "analysis/views/text.h"

namespace stipple {
namespace {

/// Scenes have y downwards, VTK upwards.
std::vector<float> Flipped(const std::vector<Point>& points, double height) {
  std::vector<float> flat;
  flat.reserve(points.size() * 2);
  for (const Point& point : points) {
    flat.push_back(static_cast<float>(point.x));
    flat.push_back(static_cast<float>(height - point.y));
  }
  return flat;
}

void FillWith(vtkContext2D* painter, Colour fill) {
  painter->GetPen()->SetLineType(vtkPen::NO_PEN);
  painter->GetBrush()->SetColor(fill.red, fill.green, fill.blue, 255);
}

struct ShapePainter {
  vtkContext2D* painter;
  double height;

  void operator()(const RectShape& rect) const {
    FillWith(painter, rect.fill);
    painter->DrawRect(static_cast<float>(rect.x), static_cast<float>(height - rect.y - rect.height),
                      static_cast<float>(rect.width), static_cast<float>(rect.height));
  }

  void operator()(const PolygonShape& polygon) const {
    FillWith(painter, polygon.fill);
    std::vector<float> points = Flipped(polygon.points, height);
    painter->DrawPolygon(points.data(), static_cast<int>(polygon.points.size()));
  }

  void operator()(const LineShape& line) const {
    vtkPen* pen = painter->GetPen();
    pen->SetLineType(line.dashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
    pen->SetWidth(static_cast<float>(line.width));
    pen->SetColor(line.stroke.red, line.stroke.green, line.stroke.blue,
                  static_cast<unsigned char>(line.opacity * 255));
    std::vector<float> points = Flipped(line.points, height);
    painter->DrawPoly(points.data(), static_cast<int>(line.points.size()));
  }

  void operator()(const TextShape& text) const {
    const TextStyle& style = text.style;
    vtkTextProperty* property = painter->GetTextProp();
    property->SetFontSize(static_cast<int>(style.size));
    property->SetBold(style.bold);
    property->SetColor(style.colour.red / 255.0, style.colour.green / 255.0,
                       style.colour.blue / 255.0);
    property->SetOrientation(style.upwards ? 90 : 0);
    property->SetJustification(style.anchor == Anchor::kStart    ? VTK_TEXT_LEFT
                               : style.anchor == Anchor::kMiddle ? VTK_TEXT_CENTERED
                                                                 : VTK_TEXT_RIGHT);
    property->SetVerticalJustificationToCentered();
    painter->DrawString(static_cast<float>(text.x), static_cast<float>(height - text.y),
                        vtkStdString(CleanUtf8(text.text)));
  }
};

}  // namespace

vtkStandardNewMacro(SceneItem);

bool SceneItem::Paint(vtkContext2D* painter) {
  if (scene_ == nullptr) return false;
  for (const Layer& layer : scene_->layers)
    for (const Shape& shape : layer.shapes) PaintShape(painter, shape);
  return true;
}

void SceneItem::PaintShape(vtkContext2D* painter, const Shape& shape) const {
  std::visit(ShapePainter{painter, scene_->height}, shape);
}

}  // namespace stipple
