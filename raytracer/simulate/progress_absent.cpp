// SPDX-License-Identifier: MIT
// How long a simulated run has still to go by its own clock is nothing to wait for.
#include "raytracer/render/progress.h"

namespace stipple::raytracer {

Progress::Progress(std::size_t total, bool)
    : total_(total),
      next_look_(static_cast<std::size_t>(-1)),
      start_s_(0),
      next_line_s_(0),
      terminal_(false) {}

Progress::~Progress() = default;

void Progress::Look() {}

}  // namespace stipple::raytracer
