// SPDX-License-Identifier: MIT
// Bezier patches of a scene: met directly, or as triangles where nobody can see the difference.
//
// Cut into n x n cells of two triangles, a patch is off by an error that falls as 1 / n^2 and whose
// size follows from how much the patch bends. Seen from the camera, in pixels, it decides n: one n
// for the whole scene, so that patches that share an edge share its corners, and there is no crack.
#ifndef STIPPLE_RAYTRACER_SCENE_PATCHES_H
#define STIPPLE_RAYTRACER_SCENE_PATCHES_H

#include <string_view>

#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

/// Triangles may be off by this part of a pixel.
inline constexpr double kPatchErrorPixels = 0.25;
/// More cells per side than this cost more memory than they save time: then rays meet patches
/// directly.
inline constexpr int kMostPatchCells = 32;

/// Pixels that two triangles in place of each patch would be off by where that is worst, as the
/// camera sees it; those of n x n cells are off by 1 / n^2 of it. An estimate, from second
/// derivatives on a grid of places: 20 % too small at worst for the teapot. Infinite if the eye is
/// within the box of a patch.
///
/// Source: Filip, Magedson, Markot, "Surface algorithms using bounds on derivatives", Computer
/// Aided Geometric Design 3(4), 1986.
double PatchErrorPixels(const Scene& scene);
double PatchErrorPixels(const Patch<double>& patch, const View& view);

/// `rule`: auto, direct, or the number of cells per side.
PatchChoice ChoosePatches(const Scene& scene, std::string_view rule);
/// Of so many patches where PatchErrorPixels is `error` at the worst.
PatchChoice ChoosePatches(std::size_t patches, double error, std::string_view rule);

/// Adds a patch's triangles with normals; a cell at an edge that is one point gives one triangle.
void AddTriangles(const Patch<double>& patch, int cells, std::uint32_t material, Shapes& to);

/// Replaces every patch, where it stands among the objects, by its triangles.
void TessellatePatches(Scene& scene, int cells);

/// Chooses, tessellates if that was chosen, and notes the choice in the scene. Nothing to do in a
/// scene without patches.
void AdaptPatches(Scene& scene, std::string_view rule);

}  // namespace stipple::raytracer

#endif
