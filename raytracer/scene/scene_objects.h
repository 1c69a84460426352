// SPDX-License-Identifier: MIT
// A scene's objects one after the other, as often as somebody wants to see them: read or generated
// anew each time, so that nobody need have them all.
#ifndef STIPPLE_RAYTRACER_SCENE_SCENE_OBJECTS_H
#define STIPPLE_RAYTRACER_SCENE_SCENE_OBJECTS_H

#include <cstdint>
#include <functional>

#include "raytracer/scene/load.h"

namespace stipple::raytracer {

class SceneObjects {
 public:
  SceneObjects() = default;
  /// Reads the scene as often as it takes to know what becomes of patches. Errors: as LoadScene;
  /// InputError for what can be read but once, as a pipe.
  explicit SceneObjects(const SceneChoice& choice);

  /// All but the objects, as chosen.
  const Scene& rest() const { return rest_; }

  /// `shapes` has some of the objects; `number` is the object's among all.
  using Visit =
      std::function<void(const Shapes& shapes, const Object& object, std::uint32_t number)>;
  /// In their order; patches that rays do not meet directly as triangles. Errors: as LoadScene;
  /// InputError for a file that has changed meanwhile.
  void ForEach(const Visit& visit);

 private:
  SceneStream stream_;
  Scene rest_;
};

}  // namespace stipple::raytracer

#endif
