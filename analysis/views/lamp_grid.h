// SPDX-License-Identifier: MIT
// A coloured square for each rank in rows of equal length: status, and LEDs of many ranks.
#ifndef STIPPLE_ANALYSIS_VIEWS_LAMP_GRID_H
#define STIPPLE_ANALYSIS_VIEWS_LAMP_GRID_H

#include <functional>
#include <span>
#include <string>

#include "analysis/stats/timeline.h"
#include "analysis/views/rank_table.h"
#include "analysis/views/scene.h"
#include "analysis/views/view_list.h"

namespace stipple {

struct Lamp {
  Colour colour;
  std::string text;  // below it where there is room, else in its tooltip
};

/// Sets the scene's size and adds its layers. Few ranks have large squares with name and text, many
/// small ones, and each row of squares the name of its first rank.
void AddLampGrid(Scene& scene, const ViewInput& input, std::span<const TimelineRow> ranks,
                 std::span<const Lamp> lamps);

/// Ranks' names on one line below their columns, thinned; culprit and host always.
void AddNamesBelow(Layer& layer, const RankTable& table, double y, int culprit,
                   const std::function<double(std::size_t)>& x_of);

}  // namespace stipple

#endif
