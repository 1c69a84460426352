// SPDX-License-Identifier: MIT
// On a real machine work takes its time by itself.
#include "raytracer/render/work_meter.h"

namespace stipple::raytracer {

WorkMeter::WorkMeter(const RayCounts&) {}
WorkMeter::~WorkMeter() = default;

}  // namespace stipple::raytracer
