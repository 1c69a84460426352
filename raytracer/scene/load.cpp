// SPDX-License-Identifier: MIT
#include "raytracer/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "raytracer/errors.h"
#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/generate.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

const Generator* FindGenerator(const std::string& name) {
  const Generator* const found = std::ranges::find(kGenerators, name, &Generator::name);
  return found == std::end(kGenerators) ? nullptr : found;
}

int SizeOf(const Generator& generator, std::int64_t size) {
  if (size < 0) return generator.usual;
  if (size < generator.smallest)
    throw UsageError(fmt::format("--scene-size {}: the smallest {} have size {}", size,
                                 generator.name, generator.smallest));
  const double objects = generator.objects(static_cast<double>(size));
  if (objects > kMostObjects)
    throw UsageError(
        fmt::format("--scene-size {}: {} of that size has {:.3g} objects, at most "
                    "{:.3g} are possible",
                    size, generator.name, objects, kMostObjects));
  return static_cast<int>(size);
}

bool IsNamedView(const std::string& camera) {
  return std::ranges::any_of(
      kGenerators, [&](const Generator& generator) { return generator.other_view.name == camera; });
}

View CameraOf(const SceneChoice& choice, const View& own) {
  if (choice.camera == "default") return own;
  if (!IsNamedView(choice.camera)) return ReadNffView(choice.camera);
  const Generator* const generator = FindGenerator(choice.scene);
  if (generator == nullptr || generator->other_view.name != choice.camera)
    throw UsageError(
        fmt::format("--camera {}: scene {} has no such view (rings have above, "
                    "teapot has side)",
                    choice.camera, choice.scene));
  return generator->other_view.view(SizeOf(*generator, choice.size));
}

}  // namespace

bool IsFile(const SceneChoice& choice) {
  if (FindGenerator(choice.scene) != nullptr) return false;
  if (choice.size >= 0)
    throw UsageError(
        fmt::format("--scene-size {}: the file {} has the size it has", choice.size, choice.scene));
  return true;
}

Scene SceneFrom(const SceneChoice& choice, std::string_view text) {
  const Generator* const generator = FindGenerator(choice.scene);
  Scene scene = generator != nullptr ? generator->scene(SizeOf(*generator, choice.size))
                                     : ParseNff(text, choice.scene);
  if (choice.object_limit > 0) LimitObjects(scene, choice.object_limit);
  return scene;
}

View ViewOf(const SceneChoice& choice, const View& own) {
  View view = CameraOf(choice, own);
  if (choice.resolution.width > 0) view.resolution = choice.resolution;
  return view;
}

Scene LoadScene(const SceneChoice& choice) {
  const FileText text = IsFile(choice) ? FileText(choice.scene) : FileText();
  Scene scene = SceneFrom(choice, text.view());
  scene.view = ViewOf(choice, scene.view);
  return scene;
}

}  // namespace stipple::raytracer
