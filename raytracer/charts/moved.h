// SPDX-License-Identifier: MIT
// Scenes put elsewhere, or in another unit of length: the same picture, from other numbers.
#ifndef STIPPLE_RAYTRACER_CHARTS_MOVED_H
#define STIPPLE_RAYTRACER_CHARTS_MOVED_H

#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// Adds one object of `from` to `to`, all lengths multiplied by `scale`, then moved.
void AddMoved(const Shapes& from, const Object& object, Vec3 by, Shapes& to, double scale = 1);

/// The scene with its lights and its eye.
Scene Moved(const Scene& scene, Vec3 by, double scale = 1);

}  // namespace stipple::raytracer

#endif
