// SPDX-License-Identifier: MIT
// What the program adapts to a scene, and why: it models no more than the scene needs.
//
// A decision is a rule over facts about the scene and what the user chose: pure functions, so all
// ranks decide alike. Each is a row of kDecisions in plan.cpp; --explain prints them before the
// picture is drawn. tests/raytracer/plan_test.cpp holds each to what it promises.
#ifndef STIPPLE_RAYTRACER_PLAN_H
#define STIPPLE_RAYTRACER_PLAN_H

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "raytracer/geometry/model.h"
#include "raytracer/options.h"
#include "raytracer/partition/scene_parts.h"
#include "raytracer/render/shading.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// What decisions need to know of a scene.
struct SceneFacts {
  std::array<std::uint64_t, 5> count{};  // of objects, by ShapeKind
  PatchChoice patches;                   // what was made of Bezier patches
  std::uint64_t model_bytes = 0;  // of the shapes and their hierarchy, on the rank that has most
  int parts = 0, parts_held = 0;  // of a divided scene: leaves, and how many a rank holds
  std::uint64_t copies = 0;       // objects in all leaves together

  /// Largest number that a ray's arithmetic meets: a coordinate of an object or of the eye, or the
  /// distance between the two.
  double reach = 0;
  /// Smallest feature: the radius of a sphere, the height or larger radius of a cone, the shortest
  /// edge of a triangle, polygon or patch.
  double smallest = std::numeric_limits<double>::infinity();

  bool mirrors = false;          // some material reflects or lets through: rays go on
  Rules rules = Rules::kOpaque;  // how much of the model of shading it uses

  std::uint64_t Objects() const;
  std::uint64_t CountOf(ShapeKind kind) const { return count[static_cast<std::size_t>(kind)]; }
};

/// One pass over the objects. The model is only read.
template <class Real>
SceneFacts FactsOf(const Scene& scene, Model<Real>& model);

/// The same of a divided scene; every rank calls it.
template <class Real>
SceneFacts FactsOf(const World& world, SceneParts<Real>& parts);

/// The error of float arithmetic, in smallest features: rays start 32 roundings off a surface.
double FloatError(const SceneFacts& facts);
inline constexpr double kFloatErrorAllowed = 1e-3;

/// Errors: UsageError if rays are to be float and the scene needs more digits.
void RequireDigits(const SceneFacts& facts, const Options& options);

/// Rays one after another that the scene needs, at most `wanted`: 1 if no material sends any on.
int DepthFor(const SceneFacts& facts, int wanted);

/// Text of --explain: a line per decision, what was decided first, then the reason in numbers.
std::string Explanation(const SceneFacts& facts, const Options& options);

}  // namespace stipple::raytracer

#endif
