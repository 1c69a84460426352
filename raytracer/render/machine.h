// SPDX-License-Identifier: MIT
// The machine that a rank runs on: all that differs on a simulated one (raytracer/simulate).
#ifndef STIPPLE_RAYTRACER_RENDER_MACHINE_H
#define STIPPLE_RAYTRACER_RENDER_MACHINE_H

#include "raytracer/render/tracer.h"

namespace stipple::raytracer {

/// As long as it lives these counts, as they grow, are this rank's work, and a simulated machine
/// takes its time for them. One at a time.
class WorkMeter {
 public:
  explicit WorkMeter(const RayCounts& counts);
  ~WorkMeter();
  WorkMeter(const WorkMeter&) = delete;
  WorkMeter& operator=(const WorkMeter&) = delete;
};

/// Whether the last rank is no node but the machine's host, which collects whatever the partition.
bool MachineHasHost();

/// Whether what one rank of a node writes can be seen by the others.
bool RanksShareMemory();

}  // namespace stipple::raytracer

#endif
