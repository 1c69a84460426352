// SPDX-License-Identifier: MIT
// Several scenes side by side and below one another as one.
#ifndef STIPPLE_ANALYSIS_VIEWS_SCENE_GRID_H
#define STIPPLE_ANALYSIS_VIEWS_SCENE_GRID_H

#include <span>
#include <string>

#include "analysis/views/scene.h"

namespace stipple {

void MoveShape(Shape& shape, double x, double y);

/// Row by row, `columns` in each, `gap` pixels between them; cells are as large as the largest
/// scene.
Scene SceneGrid(std::string name, std::string title, std::span<const Scene> scenes,
                std::size_t columns, double gap);

}  // namespace stipple

#endif
