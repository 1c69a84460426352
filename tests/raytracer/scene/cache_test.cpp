// SPDX-License-Identifier: MIT
// Kept scenes are what was kept, or nothing: not one byte may change unseen.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "raytracer/scene/generate.h"
#include "raytracer/scene/nff.h"
#include "raytracer/scene/scene_cache.h"

namespace stipple::raytracer {
namespace {

namespace fs = std::filesystem;

/// A cache folder of one test's own.
class CacheTest : public testing::Test {
 protected:
  CacheTest() { setenv("XDG_CACHE_HOME", folder_.c_str(), 1); }
  ~CacheTest() override {
    unsetenv("XDG_CACHE_HOME");
    fs::remove_all(folder_);
  }

  std::string folder_ = [] {
    std::string name = testing::TempDir() + "cache_test_XXXXXX";
    return std::string(mkdtemp(name.data()));
  }();
};

/// Just enough spheres to be kept, in rows.
BuiltScene<double> LargeScene() {
  Scene scene = Balls(0);
  for (int i = 0; i < 100'000; ++i)
    scene.shapes.AddSphere({i % 100 * 1.0, i / 100 % 100 * 1.0, i / 10000 * 1.0}, 0.25, 1);
  Model<double> model = BuildModel<double>(std::move(scene.shapes));
  return {std::move(scene), std::move(model)};
}

Hash HashOf(std::string_view text) {
  Hash hash;
  hash.Add(std::as_bytes(std::span(text)));
  return hash;
}

const SceneCache<double> CacheOf(std::string_view text) {
  return SceneCache<double>(HashOf(text), "all");
}

std::vector<std::vector<std::byte>> CopyOf(BuiltScene<double>& built) {
  std::vector<std::vector<std::byte>> copy;
  for (const auto part : PartsOf(built)) copy.emplace_back(part.begin(), part.end());
  return copy;
}

TEST(PackedScene, IsTheSameSceneElsewhere) {
  Scene scene = ReadNff(std::string(STIPPLE_TEST_DATA) + "/every_entity.nff");
  const View view = scene.view;
  Model<double> model = BuildModel<double>(std::move(scene.shapes));
  BuiltScene<double> built{std::move(scene), std::move(model)};
  const auto before = CopyOf(built);
  const std::uint64_t bytes = HeaderOf(built).bytes;
  std::vector<std::max_align_t> memory(bytes / sizeof(std::max_align_t) + 1);
  auto* const block = reinterpret_cast<std::byte*>(memory.data());
  PackInto(block, built);
  EXPECT_EQ(CopyOf(built), before);
  std::optional<BuiltScene<double>> seen = Unpack<double>({block, bytes});
  ASSERT_TRUE(seen);
  EXPECT_EQ(CopyOf(*seen), before);
  EXPECT_EQ(seen->scene.view.from, view.from);
  EXPECT_FALSE(Unpack<double>({block, bytes - 64}));
  EXPECT_FALSE(Unpack<double>({block, 100}));
  EXPECT_FALSE(Unpack<float>({block, bytes}));
}

TEST_F(CacheTest, WhatWasKeptIsFound) {
  BuiltScene<double> built = LargeScene();
  const auto before = CopyOf(built);
  std::string note;
  EXPECT_FALSE(CacheOf("text").Open(note));
  ASSERT_TRUE(CacheOf("text").Keep(built));
  std::optional<CachedScene<double>> found = CacheOf("text").Open(note);
  ASSERT_TRUE(found);
  EXPECT_EQ(CopyOf(found->built), before);
  EXPECT_EQ(found->built.scene.lights.size(), 3U);
  EXPECT_TRUE(OpenAgain<double>(found->path, found->hash));
  EXPECT_FALSE(OpenAgain<double>(found->path, found->hash + 1));
  EXPECT_EQ(note, "");
}

TEST_F(CacheTest, AnotherTextOrChoiceIsAnotherScene) {
  const std::string path = CacheOf("text").path();
  EXPECT_NE(CacheOf("texT").path(), path);
  EXPECT_NE(CacheOf("text ").path(), path);
  EXPECT_NE(SceneCache<double>(HashOf("text"), "first 10").path(), path);
  EXPECT_NE(SceneCache<float>(HashOf("text"), "all").path(), path);
}

TEST_F(CacheTest, NoDamageIsFollowed) {
  BuiltScene<double> built = LargeScene();
  ASSERT_TRUE(CacheOf("text").Keep(built));
  const std::string path = CacheOf("text").path();
  const auto size = static_cast<std::size_t>(fs::file_size(path));
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < kHeaderBytes; at += 5) places.push_back(at);
  for (std::size_t at = kHeaderBytes; at < size; at += size / 50) places.push_back(at);
  places.push_back(size - 1);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  std::string note;
  for (const std::size_t place : places) {
    const auto at = static_cast<std::streamoff>(place);
    const auto sound = static_cast<char>(file.seekg(at).get());
    file.seekp(at).put(static_cast<char>(sound ^ 0x10)).flush();
    note.clear();
    EXPECT_FALSE(CacheOf("text").Open(note)) << place;
    EXPECT_NE(note.find("damaged"), std::string::npos) << place;
    file.seekp(at).put(sound).flush();
  }
  EXPECT_TRUE(CacheOf("text").Open(note));
}

TEST_F(CacheTest, WhatWasCutIsMadeAnew) {
  std::string note;
  for (const double left : {0.0, 0.00001, 0.5, 0.99}) {
    BuiltScene<double> built = LargeScene();
    ASSERT_TRUE(CacheOf("text").Keep(built));
    const std::string path = CacheOf("text").path();
    fs::resize_file(path,
                    static_cast<std::uintmax_t>(left * static_cast<double>(fs::file_size(path))));
    EXPECT_FALSE(CacheOf("text").Open(note)) << left;
  }
  BuiltScene<double> built = LargeScene();
  ASSERT_TRUE(CacheOf("text").Keep(built));
  EXPECT_TRUE(CacheOf("text").Open(note));
}

TEST_F(CacheTest, AFolderThatCannotBeMadeIsNoError) {
  setenv("XDG_CACHE_HOME", "/dev/null/none", 1);
  BuiltScene<double> built = LargeScene();
  const auto before = CopyOf(built);
  EXPECT_FALSE(CacheOf("text").Keep(built));
  EXPECT_EQ(CopyOf(built), before);
}

TEST_F(CacheTest, SmallScenesAreNotKept) {
  Scene scene = Balls(1);
  BuiltScene<double> built{{}, BuildModel<double>(std::move(scene.shapes))};
  EXPECT_FALSE(CacheOf("text").Keep(built));
  EXPECT_FALSE(fs::exists(CacheFolder()));
}

TEST_F(CacheTest, WhatWasUsedLongestAgoGoesFirst) {
  fs::create_directories(CacheFolder());
  const auto now = fs::file_time_type::clock::now();
  for (const int hours : {1, 2, 3}) {
    const std::string path = CacheFolder() + "/" + std::to_string(hours) + ".scene";
    std::ofstream(path).put('x');
    fs::resize_file(path, kCacheBytes / 4 + kCacheBytes / 8);  // sparse
    fs::last_write_time(path, now - std::chrono::hours(hours));
  }
  const std::string crashed = CacheFolder() + "/crashed.part";
  std::ofstream(crashed).put('x');
  fs::last_write_time(crashed, now - std::chrono::hours(48));
  BuiltScene<double> built = LargeScene();
  ASSERT_TRUE(CacheOf("text").Keep(built));
  EXPECT_TRUE(fs::exists(CacheFolder() + "/1.scene"));
  EXPECT_TRUE(fs::exists(CacheFolder() + "/2.scene"));
  EXPECT_FALSE(fs::exists(CacheFolder() + "/3.scene"));
  EXPECT_FALSE(fs::exists(crashed));
}

}  // namespace
}  // namespace stipple::raytracer
