// SPDX-License-Identifier: MIT
// What was measured, laid out: panels of points, or of maps, on common scales.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_CHART_SCENE_H
#define STIPPLE_ANALYSIS_EXEMPLAR_CHART_SCENE_H

#include "analysis/exemplar/measured_chart.h"
#include "analysis/views/scene.h"

namespace stipple {

Scene SceneOf(const MeasuredChart& chart);

}  // namespace stipple

#endif
