// SPDX-License-Identifier: MIT
// What a scene file may say and no ray tracer can draw: objects without a surface, or smaller than
// the digits that their place leaves them.
#ifndef STIPPLE_RAYTRACER_SCENE_CHECK_H
#define STIPPLE_RAYTRACER_SCENE_CHECK_H

#include <span>
#include <string_view>

#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

// Each tells what is wrong, or "". Numbers are finite and at most 1e30.

std::string_view ProblemOf(const View& view);
std::string_view ProblemOf(const Material& material);
std::string_view ProblemOf(const Light& light);

/// Spheres, cones and patches too small: below 1e-30, or below 1e-12 of their distance from the
/// origin, where a double has but a few digits left for their shape.
std::string_view ProblemOfSphere(Vec3 center, double radius);
std::string_view ProblemOfCone(Vec3 base, double base_radius, Vec3 apex, double apex_radius);
std::string_view ProblemOfPatch(std::span<const Vec3, 16> control);

/// Polygons may be concave, and their outline may touch or cross itself: what it winds around an
/// odd number of times is inside. Not allowed are those without area (all corners on one line, or
/// as much wound one way as the other), and those whose corners leave their plane by a hundredth of
/// their size, which is far more than rounding to six digits does.
std::string_view ProblemOfPolygon(std::span<const Vec3> vertices);

}  // namespace stipple::raytracer

#endif
