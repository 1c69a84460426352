// SPDX-License-Identifier: MIT
// The four scenes of Eric Haines' Standard Procedural Databases that the exemplar uses, at any
// size: the same objects in the same order as SPD's own generators write them. And the teapot as
// the patches that SPD's triangles are made from.
#ifndef STIPPLE_RAYTRACER_SCENE_GENERATE_H
#define STIPPLE_RAYTRACER_SCENE_GENERATE_H

#include <cstdint>
#include <string_view>

#include "raytracer/geometry/shape_stream.h"
#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

// `take` gets the objects while they are made; what it leaves is in the scene.
Scene Balls(int size, const TakeShapes& take = {});
Scene Rings(int size, const TakeShapes& take = {});
Scene Teapot(int size, const TakeShapes& take = {});
Scene Tree(int size, const TakeShapes& take = {});
/// The 32 patches of the pot, on a board of size x size squares.
Scene TeapotPatches(int size, const TakeShapes& take = {});

/// Objects in each scene, as a real number so that absurd sizes do not overflow.
double BallsObjects(double size);
double RingsObjects(double size);
double TeapotObjects(double size);
double TreeObjects(double size);
double TeapotPatchesObjects(double size);

/// A further view of a generated scene, beside its own.
struct NamedView {
  std::string_view name;
  View (*view)(int size);
};

/// Eye at (0.2, 10.2, 2.2), looking at (0.2, 0, 1.5): the pot from its side, spout to the left.
View TeapotSideView(int size);
/// Straight down on the middle of the pyramid of rings: for size n the eye is at (0, y, h), looking
/// at (0, y, 0) with y = 1.30656 (n + 1) and h = 4.3 n + 3; up is +y, away from the scene's own
/// eye.
View RingsAboveView(int size);

struct Generator {
  std::string_view name;
  Scene (*scene)(int size, const TakeShapes& take);
  double (*objects)(double size);
  int smallest;
  int usual;  // the size whose statistics SPD publishes
  NamedView other_view;
};

inline constexpr Generator kGenerators[] = {
    {"balls", Balls, BallsObjects, 0, 4, {}},
    {"rings", Rings, RingsObjects, 1, 7, {"above", RingsAboveView}},
    // Some triangles of a pot of size 1 have no area.
    {"teapot", Teapot, TeapotObjects, 2, 12, {"side", TeapotSideView}},
    {"tree", Tree, TreeObjects, 0, 11, {}},
    {"teapot-patches", TeapotPatches, TeapotPatchesObjects, 1, 12, {"side", TeapotSideView}},
};

/// More objects than this are refused: a mistyped size should not fill the machine's memory.
inline constexpr double kMostObjects = 5e7;

/// SPD's background, the same in all scenes.
inline constexpr Vec3 kSpdBackground{0.078, 0.361, 0.753};

/// The exponent that SPD writes for surfaces without a highlight.
inline constexpr double kMatteShine = 100000;

}  // namespace stipple::raytracer

#endif
