// SPDX-License-Identifier: MIT
// A scene that is never there at once is the scene.
#include "raytracer/scene/scene_objects.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "raytracer/errors.h"
#include "raytracer/scene/nff.h"
#include "raytracer/scene/patches.h"

namespace stipple::raytracer {
namespace {

class SceneObjectsTest : public testing::Test {
 protected:
  ~SceneObjectsTest() override { std::remove(path_.c_str()); }

  const std::string path_ =
      testing::TempDir() + "scene_objects_" + std::to_string(getpid()) + ".nff";
};

/// All objects, put together again. `most`: that were there at once.
Scene Whole(SceneObjects& objects, std::size_t& most) {
  Scene scene = objects.rest();
  objects.ForEach([&](const Shapes& some, const Object& object, std::uint32_t number) {
    EXPECT_EQ(number, scene.shapes.objects.size());
    most = std::max(most, some.objects.size());
    scene.shapes.AddCopy(some, object);
  });
  return scene;
}

TEST_F(SceneObjectsTest, AreThoseOfTheSceneFewAtATime) {
  WriteNff(LoadScene({.scene = "teapot", .size = 9}), path_);
  const SceneChoice choices[] = {{.scene = "balls", .size = 3},
                                 {.scene = "balls", .size = 4, .object_limit = 1000},
                                 {.scene = "rings", .size = 6, .object_limit = 3000},
                                 {.scene = "tree", .size = 10, .object_limit = 1000000},
                                 {.scene = path_},
                                 {.scene = path_, .object_limit = 700},
                                 {.scene = "teapot-patches", .size = 3},
                                 {.scene = "teapot-patches", .size = 3, .patches = "direct"},
                                 {.scene = "teapot-patches", .size = 3, .patches = "5"}};
  for (const SceneChoice& choice : choices) {
    Scene whole = LoadScene(choice);
    AdaptPatches(whole, choice.patches);
    SceneObjects objects(choice);
    EXPECT_EQ(objects.rest().patches.cells, whole.patches.cells);
    for (int time = 0; time < 2; ++time) {
      std::size_t most = 0;
      EXPECT_EQ(FormatNff(Whole(objects, most)), FormatNff(whole)) << choice.scene;
      const auto cells = static_cast<std::size_t>(whole.patches.cells);
      EXPECT_LE(most, std::max<std::size_t>(512, 2 * cells * cells)) << choice.scene;
    }
  }
}

TEST_F(SceneObjectsTest, AFileThatChangesIsRefused) {
  WriteNff(LoadScene({.scene = "balls", .size = 1}), path_);
  SceneObjects objects({.scene = path_});
  WriteNff(LoadScene({.scene = "balls", .size = 2}), path_);
  std::size_t most = 0;
  EXPECT_THROW(Whole(objects, most), InputError);
}

TEST_F(SceneObjectsTest, APipeIsRefused) {
  EXPECT_THROW(SceneObjects({.scene = "/dev/null"}), InputError);
}

}  // namespace
}  // namespace stipple::raytracer
