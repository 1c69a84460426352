// SPDX-License-Identifier: MIT
// A scene: what is seen, from where, in which light.
#ifndef STIPPLE_RAYTRACER_SCENE_SCENE_H
#define STIPPLE_RAYTRACER_SCENE_SCENE_H

#include <cstdint>
#include <vector>

#include "raytracer/geometry/shapes.h"
#include "raytracer/geometry/vec.h"
#include "raytracer/scene/view.h"

namespace stipple::raytracer {

/// NFF's fill: colour, and how much of a ray is scattered, mirrored and let through.
struct Material {
  Vec3 color{1, 1, 1};
  double diffuse = 1;       // Kd
  double specular = 0;      // Ks
  double shine = 0;         // exponent of the highlight
  double transmission = 0;  // T
  double refraction = 1;    // index of refraction inside
  int priority = 0;         // where media overlap the higher one counts; 0: NFF's rule (extension)

  friend bool operator==(const Material&, const Material&) = default;
};

struct Light {
  Vec3 position;
  Vec3 color{1, 1, 1};
  bool colored = false;  // the file gave a colour
  double radius = 0;     // of a light that rays can meet (extension); 0: a point, as NFF has them
};

/// What was made of a scene's Bezier patches, and why (patches.h).
struct PatchChoice {
  std::size_t patches = 0;  // in the scene; 0: nothing had to be decided
  int cells = 0;            // triangles: cells per side of a patch; 0: rays meet patches directly
  double cells_needed = 0;  // for triangles off by less than kPatchErrorPixels
  double error_pixels = 0;  // what the triangles are off by at the worst place; 0: there are none
};

struct Scene {
  Vec3 background;
  View view;
  std::vector<Light> lights;
  std::vector<Material> materials;
  Shapes shapes;
  PatchChoice patches{};
};

}  // namespace stipple::raytracer

#endif
