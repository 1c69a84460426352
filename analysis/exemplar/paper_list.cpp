// SPDX-License-Identifier: MIT
#include <array>

#include "analysis/exemplar/paper.h"

namespace stipple {

std::span<const PaperExperiment> PaperExperiments() {
  static const std::array kExperiments{kF8, kF12, kF15, kF17};
  return kExperiments;
}

}  // namespace stipple
