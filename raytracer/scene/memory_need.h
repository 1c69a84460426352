// SPDX-License-Identifier: MIT
// Does a scene fit into a node's memory? Asked before the model is built, so that a scene that is
// too large is refused with numbers and not by the system.
#ifndef STIPPLE_RAYTRACER_SCENE_MEMORY_NEED_H
#define STIPPLE_RAYTRACER_SCENE_MEMORY_NEED_H

#include <cstdint>
#include <span>
#include <string>

#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// Bytes that these shapes and their model take while it is built, an estimate from above.
std::uint64_t BytesToBuild(const Shapes& shapes);

/// Bytes that a part of them takes, with the shapes and the model of that part.
std::uint64_t BytesToBuild(const Shapes& shapes, std::span<const std::uint32_t> numbers);

/// Bytes that processes on this node can still get (MemAvailable of /proc/meminfo), or the largest
/// number where that is not known.
std::uint64_t AvailableBytes();

/// Errors: NoRoom if the scene does not fit; `limit` 0 stands for what the node has.
void RequireMemory(const Shapes& shapes, std::uint64_t limit);

/// The same for what one of several ranks holds, in words.
void RequireMemory(std::uint64_t needed, std::uint64_t allowed, const std::string& what);

}  // namespace stipple::raytracer

#endif
