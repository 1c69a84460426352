// SPDX-License-Identifier: MIT
// A figure laid out: its panels in a grid.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_FIGURE_SCENE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_FIGURE_SCENE_H

#include "analysis/exemplar/figure.h"
#include "analysis/views/scene.h"

namespace stipple {

Scene SceneOf(const Figure& figure);

/// Whether states are shown, whose colours need a key.
bool ShowsStates(const Figure& figure);

}  // namespace stipple

#endif
