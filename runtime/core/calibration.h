// SPDX-License-Identifier: MIT
// What events cost here, measured on their true paths when the process begins.
#ifndef STIPPLE_RUNTIME_CORE_CALIBRATION_H
#define STIPPLE_RUNTIME_CORE_CALIBRATION_H

#include "stipple/format.h"

namespace stipple {

/// Takes a fraction of a millisecond. All zero without memory. Signals are blocked; this thread's
/// stream is left as it was.
Calibration Calibrate();

}  // namespace stipple

#endif
