// SPDX-License-Identifier: MIT
// On a real machine work takes its time by itself, and all ranks are alike.
#include "raytracer/render/machine.h"

namespace stipple::raytracer {

WorkMeter::WorkMeter(const RayCounts&) {}
WorkMeter::~WorkMeter() = default;

bool MachineHasHost() { return false; }

bool RanksShareMemory() { return true; }

}  // namespace stipple::raytracer
