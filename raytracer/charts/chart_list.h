// SPDX-License-Identifier: MIT
// All charts of speed against accuracy, in one visible table: one function and one file each.
#ifndef STIPPLE_RAYTRACER_CHARTS_CHART_LIST_H
#define STIPPLE_RAYTRACER_CHARTS_CHART_LIST_H

#include <span>
#include <string_view>

#include "raytracer/charts/chart_table.h"
#include "raytracer/charts/session.h"

namespace stipple::raytracer {

struct ChartEntry {
  std::string_view name;
  ChartTable (*measure)(Session& session);
  std::string_view meaning;
};

std::span<const ChartEntry> Charts();

ChartTable SamplingChart(Session& session);
ChartTable DepthChart(Session& session);
ChartTable PrecisionChart(Session& session);
ChartTable PatchesChart(Session& session);
ChartTable QuadricsChart(Session& session);
ChartTable OffsetsChart(Session& session);
ChartTable CracksChart(Session& session);
ChartTable PacketsChart(Session& session);
ChartTable SumsChart(Session& session);

}  // namespace stipple::raytracer

#endif
