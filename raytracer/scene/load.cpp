// SPDX-License-Identifier: MIT
#include "raytracer/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "raytracer/errors.h"
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

void RequireToReadAgain(const SceneChoice& choice) {
  std::error_code no_matter;
  if (!IsFile(choice) || std::filesystem::is_regular_file(choice.scene, no_matter)) return;
  if (std::filesystem::exists(choice.scene, no_matter))
    throw InputError(choice.scene, 0, "is read more than once here, which takes a file that stays");
}

SceneStream::SceneStream(const SceneChoice& choice) : choice_(choice) {
  if (choice.object_limit == 0) return;
  RequireToReadAgain(choice);
  SizesSeen sizes(choice.object_limit);
  ReadAll([&](Shapes& added) {
    sizes.See(added);
    added.Clear();
  });
  largest_ = sizes.Largest();
}

Scene SceneStream::ReadAll(const TakeShapes& take) {
  Scene scene;
  if (!IsFile(choice_)) {
    const Generator& generator = *FindGenerator(choice_.scene);
    scene = generator.scene(SizeOf(generator, choice_.size), take);
  } else {
    Text text = Text::OfFile(choice_.scene);
    scene = ReadNff(text, choice_.scene, take);
    if (bytes_ > 0 && text.hash().Value() != hash_.Value())
      throw InputError(choice_.scene, 0, "has changed while it was read again");
    hash_ = text.hash();
    bytes_ = text.bytes_read();
  }
  if (take) take(scene.shapes);
  return scene;
}

Scene SceneStream::Read(const TakeShapes& take) {
  if (!largest_) return ReadAll(take);
  LargestOnly largest = *largest_;
  Shapes kept;
  Scene scene = ReadAll([&](Shapes& added) {
    for (const Object& object : added.objects)
      if (largest.Keeps(added, object)) kept.AddCopy(added, object);
    added.Clear();
    if (take) take(kept);
  });
  scene.shapes = std::move(kept);
  return scene;
}

View ViewOf(const SceneChoice& choice, const View& own) {
  View view = CameraOf(choice, own);
  if (choice.resolution.width > 0) view.resolution = choice.resolution;
  return view;
}

Scene LoadScene(const SceneChoice& choice) {
  Scene scene = SceneStream(choice).Read({});
  scene.view = ViewOf(choice, scene.view);
  return scene;
}

}  // namespace stipple::raytracer
