// SPDX-License-Identifier: MIT
// From names and sizes to a scene.
#ifndef STIPPLE_RAYTRACER_SCENE_LOAD_H
#define STIPPLE_RAYTRACER_SCENE_LOAD_H

#include <cstdint>
#include <optional>
#include <string>

#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/generate.h"
#include "raytracer/scene/limit.h"
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

/// A scene that is read or generated again whenever it is asked for.
class SceneStream {
 public:
  SceneStream() = default;
  /// With an object limit it is read at once, to know which objects are large. Errors: as
  /// LoadScene.
  explicit SceneStream(const SceneChoice& choice);

  /// The scene with its own view. All objects go to `take`, if there is one; what it leaves is in
  /// the scene. Errors: as LoadScene; InputError for a file that has another text than before.
  Scene Read(const TakeShapes& take);

  /// Of the file, once it was read.
  const Hash& text_hash() const { return hash_; }
  std::size_t text_bytes() const { return bytes_; }

 private:
  Scene ReadAll(const TakeShapes& take);

  SceneChoice choice_;
  std::optional<LargestOnly> largest_;
  Hash hash_;
  std::size_t bytes_ = 0;
};

/// Is the scene a file, and not generated? Errors: UsageError if a size was chosen for a file.
bool IsFile(const SceneChoice& choice);
/// Errors: InputError for what can be read but once, as a pipe.
void RequireToReadAgain(const SceneChoice& choice);
/// The chosen one; `own`: the scene's.
View ViewOf(const SceneChoice& choice, const View& own);

}  // namespace stipple::raytracer

#endif
