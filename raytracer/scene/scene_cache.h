// SPDX-License-Identifier: MIT
// Large scenes that were read from a file are kept, with their models, so that nobody waits twice
// for the text to be read and the hierarchy to be built.
//
// A kept scene is named by a hash of all that it depends on: the text, what was asked of it, this
// program's layout. So it cannot be out of date, wherever the text moves; what is no longer asked
// for is removed with time. Files are written under another name and renamed, so no half of one is
// seen; a hash over everything is compared before one is used.
#ifndef STIPPLE_RAYTRACER_SCENE_SCENE_CACHE_H
#define STIPPLE_RAYTRACER_SCENE_SCENE_CACHE_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/packed_scene.h"

namespace stipple::raytracer {

/// Scenes of fewer objects are not kept: reading them takes less than a tenth of a second.
inline constexpr std::uint64_t kLeastCachedObjects = 100'000;
/// A file of fewer bytes cannot hold that many: "s 0 0 0 1" is one of the shortest.
inline constexpr std::size_t kLeastCachedText = 10 * kLeastCachedObjects;
/// What the folder holds at most; the files used longest ago go first.
inline constexpr std::uint64_t kCacheBytes = std::uint64_t{8} << 30;

/// A scene that lies in a mapped file.
template <class Real>
struct CachedScene {
  std::string path;
  std::uint64_t hash = 0;  // of the whole file
  MappedFile file;
  BuiltScene<Real> built;
};

/// $XDG_CACHE_HOME/stipple, else $HOME/.cache/stipple; empty if neither variable holds an absolute
/// path.
std::string CacheFolder();

template <class Real>
class SceneCache {
 public:
  /// `text`: of the whole file. `choices`: in words, all else that the model depends on.
  SceneCache(const Hash& text, std::string_view choices);

  /// Nothing if it was not kept or is damaged, which is said in `note` and mended by keeping it
  /// anew.
  std::optional<CachedScene<Real>> Open(std::string& note) const;

  /// Keeps a large scene, and moves `built` into the file. Nothing, and `built` as it was, if the
  /// scene is small or cannot be kept: a full disk or a folder that cannot be written is no error.
  std::optional<CachedScene<Real>> Keep(BuiltScene<Real>& built) const;

  /// Where the scene is or would be kept; empty if there is no folder.
  const std::string& path() const { return path_; }

 private:
  std::uint64_t key_ = 0;
  std::string path_;
};

/// What another rank of a node does to look at a scene that one has opened or kept: it maps the
/// same file. Nothing if it is no longer there or has another hash.
template <class Real>
std::optional<CachedScene<Real>> OpenAgain(const std::string& path, std::uint64_t hash);

}  // namespace stipple::raytracer

#endif
