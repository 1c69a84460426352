// SPDX-License-Identifier: MIT
// Curves below a window's timeline, on its axis: how many ranks compute, and how much is sent.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_CURVES_PART_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_CURVES_PART_H

#include "analysis/stats/timeline.h"
#include "analysis/views/axis.h"
#include "analysis/views/scene.h"
#include "analysis/views/window/window_layout.h"

namespace stipple {

/// `visible`: the span shown; `whole`: the run, for what is counted since its start.
Layer UtilisationCurve(const Timeline& visible, const Timeline& whole, const TimeAxis& axis,
                       const Area& area);
Layer LoadCurve(const Timeline& visible, const TimeAxis& axis, const Area& area);

}  // namespace stipple

#endif
