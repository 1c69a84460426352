// SPDX-License-Identifier: MIT
// Where a simulated machine reads how much a rank has worked; elsewhere nobody does.
#ifndef STIPPLE_RAYTRACER_RENDER_WORK_METER_H
#define STIPPLE_RAYTRACER_RENDER_WORK_METER_H

#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

/// As long as it lives these counts, as they grow, are this rank's work. One at a time.
class WorkMeter {
 public:
  explicit WorkMeter(const RayCounts& counts);
  ~WorkMeter();
  WorkMeter(const WorkMeter&) = delete;
  WorkMeter& operator=(const WorkMeter&) = delete;
};

}  // namespace stipple::raytracer

#endif
