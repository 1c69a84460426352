// SPDX-License-Identifier: MIT
#include "raytracer/scene/scene_objects.h"

#include <algorithm>
#include <utility>

#include "raytracer/scene/patches.h"

namespace stipple::raytracer {

SceneObjects::SceneObjects(const SceneChoice& choice) {
  RequireToReadAgain(choice);
  stream_ = SceneStream(choice);
  std::size_t patches = 0;
  rest_ = stream_.Read([&](Shapes& added) {
    patches += added.patches.size();
    added.Clear();
  });
  rest_.shapes = {};
  rest_.view = ViewOf(choice, rest_.view);
  if (patches == 0) return;
  double error = 0;
  stream_.Read([&](Shapes& added) {
    for (const Patch<double>& patch : added.patches)
      error = std::max(error, PatchErrorPixels(patch, rest_.view));
    added.Clear();
  });
  rest_.patches = ChoosePatches(patches, error, choice.patches);
}

void SceneObjects::ForEach(const Visit& visit) {
  std::uint32_t number = 0;
  Shapes triangles;  // of one patch
  stream_.Read([&](Shapes& added) {
    for (const Object& object : added.objects) {
      if (object.kind != ShapeKind::kPatch || rest_.patches.cells == 0) {
        visit(added, object, number++);
        continue;
      }
      AddTriangles(added.patches[object.index], rest_.patches.cells, object.material, triangles);
      for (const Object& triangle : triangles.objects) visit(triangles, triangle, number++);
      triangles.Clear();
    }
    added.Clear();
  });
}

}  // namespace stipple::raytracer
