// SPDX-License-Identifier: MIT
#include "analysis/views/scene_grid.h"

#include <algorithm>
#include <utility>

namespace stipple {
namespace {

/// Moves shapes.
struct Mover {
  double x, y;

  void operator()(RectShape& shape) const {
    shape.x += x;
    shape.y += y;
  }
  void operator()(TextShape& shape) const {
    shape.x += x;
    shape.y += y;
  }
  void operator()(PolygonShape& shape) const { Move(shape.points); }
  void operator()(LineShape& shape) const { Move(shape.points); }
  void Move(std::vector<Point>& points) const {
    for (Point& point : points) point = {point.x + x, point.y + y};
  }
};

}  // namespace

void MoveShape(Shape& shape, double x, double y) { std::visit(Mover{x, y}, shape); }

Scene SceneGrid(std::string name, std::string title, std::span<const Scene> scenes,
                std::size_t columns, double gap) {
  Scene grid{.name = std::move(name), .title = std::move(title)};
  double width = 0, height = 0;
  for (const Scene& scene : scenes) {
    width = std::max(width, scene.width);
    height = std::max(height, scene.height);
  }
  const std::size_t across = std::min(columns, scenes.size());
  const std::size_t down = (scenes.size() + columns - 1) / columns;
  const auto extent = [gap](std::size_t count, double size) {
    return static_cast<double>(count) * (size + gap) - gap;
  };
  grid.width = extent(across, width);
  grid.height = extent(down, height);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Mover mover{static_cast<double>(i % columns) * (width + gap),
                      static_cast<double>(i / columns) * (height + gap)};
    for (Layer layer : scenes[i].layers) {
      for (Shape& shape : layer.shapes) std::visit(mover, shape);
      grid.layers.push_back(std::move(layer));
    }
    if (!grid.description.empty()) grid.description += ". ";
    grid.description += scenes[i].title + ": " + scenes[i].description;
  }
  return grid;
}

}  // namespace stipple
