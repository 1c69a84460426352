// SPDX-License-Identifier: MIT
#include "raytracer/charts/chart_list.h"

namespace stipple::raytracer {
namespace {

constexpr ChartEntry kCharts[] = {
    {"sampling", SamplingChart, "rays per pixel and where they go, against 1024 rays per pixel"},
    {"depth", DepthChart, "how far reflections are followed, against all of them"},
    {"precision", PrecisionChart,
     "kinds of number and kernels, with the scene far from the origin"},
    {"patches", PatchesChart, "Bezier patches met directly, or as triangles"},
    {"quadrics", QuadricsChart, "spheres as they are, or as triangles"},
    {"offsets", OffsetsChart, "rules for where rays start, over size and distance from the origin"},
    {"cracks", CracksChart, "rays lost between triangles, by the test that finds triangles"},
    {"packets", PacketsChart, "rays one by one or in packets, by where they come from"},
    {"sums", SumsChart, "contributions to a pixel, added in the order in which they arrive"},
};

}  // namespace

std::span<const ChartEntry> Charts() { return kCharts; }

}  // namespace stipple::raytracer
