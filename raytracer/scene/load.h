// SPDX-License-Identifier: MIT
// From names and sizes to a scene.
#ifndef STIPPLE_RAYTRACER_SCENE_LOAD_H
#define STIPPLE_RAYTRACER_SCENE_LOAD_H

#include <cstdint>
#include <string>
#include <string_view>

#include "raytracer/scene/scene.h"

namespace stipple::raytracer {

struct SceneChoice {
  std::string scene;               // of kGenerators, or a file
  std::int64_t size = -1;          // of a generated scene; below 0: its usual size
  std::uint64_t object_limit = 0;  // 0: all
  std::string camera = "default";  // "default", a further view of the scene, or a file
  std::uint64_t memory_limit = 0;  // bytes that it may take on a node; 0: what the node has
  ImageSize resolution{};          // 0 x 0: that of the view
  std::string patches = "auto";    // patches.h; LoadScene leaves them as they are
};

/// Errors: InputError for files, UsageError for a size or view that the scene does not have.
Scene LoadScene(const SceneChoice& choice);

// Its steps, for who can spare some.

/// Is the scene a file, and not generated? Errors: UsageError if a size was chosen for a file.
bool IsFile(const SceneChoice& choice);
/// With the scene's own view. `text`: of the file.
Scene SceneFrom(const SceneChoice& choice, std::string_view text);
/// The chosen one; `own`: the scene's.
View ViewOf(const SceneChoice& choice, const View& own);

}  // namespace stipple::raytracer

#endif
