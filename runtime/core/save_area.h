// SPDX-License-Identifier: MIT
// What slow.S saves of the vector registers, and how much room that takes.
#ifndef STIPPLE_RUNTIME_CORE_SAVE_AREA_H
#define STIPPLE_RUNTIME_CORE_SAVE_AREA_H

namespace stipple {

/// Asks the processor once, before the first id is given out.
void PrepareSaveArea();

}  // namespace stipple

#endif
