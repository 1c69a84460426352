// SPDX-License-Identifier: MIT
#include "analysis/exemplar/experiments.h"

namespace stipple {
namespace {

constexpr Experiment kExperiments[] = {
    {"speed-accuracy", SpeedAccuracy, "what the ray tracer's choices cost and what they lose"},
};

}  // namespace

std::span<const Experiment> Experiments() { return kExperiments; }

}  // namespace stipple
