// SPDX-License-Identifier: MIT
// Names that got a number: regions, and the names of marks and counters. They outlive the objects
// that brought them, and a fork: a child's stream defines them again under the same numbers.
#ifndef STIPPLE_RUNTIME_CORE_REGION_H
#define STIPPLE_RUNTIME_CORE_REGION_H

#include <cstdint>
#include <string_view>

#include "runtime/core/module.h"
#include "runtime/core/process.h"

namespace stipple {

/// Writes the definition of every module, region and name there is. The lock is held.
void DefineAll(Process& process);

/// Sets the id slots of every registered object to 0: no more events. The lock is held.
void SilenceAll();

/// How visits of a region are recorded from now on; UpdateAll makes it so. A forked child keeps it.
RegionModeKind ModeOf(std::uint32_t region);
void SetMode(std::uint32_t region, RegionModeKind mode);

/// Whether a region's functions have id slots: only these know modes.
bool HasSlots(std::uint32_t region);

/// What the id slot of a region's functions is to hold now: its id and mode, or 0 while it is
/// switched off.
std::uint32_t TokenOf(std::uint32_t region);

/// Sets every id slot to what it is to hold. The lock is held.
void UpdateAll();

/// The region of the function at `address` of `module` (null: of no file). The lock is held.
std::uint32_t CodeRegion(Process& process, const Module* module, std::uintptr_t address);

/// Whether a region is a function whose name, as people write it, matches a filter's pattern. The
/// lock is not held.
bool IsFunctionNamed(std::uint32_t region, std::string_view pattern);

/// Switches one region; UpdateAll makes it so. The lock is held.
void SwitchRegion(Process& process, std::uint32_t region, bool on);

/// Writes which regions are switched off by themselves. The lock is held.
void DefineRegionSwitches(Process& process);

/// The highest region id given out.
std::uint32_t LastRegion();

/// The id of a mark's or counter's name; 0 if it cannot be recorded. The lock is held.
std::uint32_t NameId(Process& process, const char* name, const char* unit);

}  // namespace stipple

#endif
