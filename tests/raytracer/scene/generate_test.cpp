// SPDX-License-Identifier: MIT
// The generated scenes are SPD's, object by object. The digests were computed from the files that
// SPD's own generators write; ours gives the same ones.
#include "raytracer/scene/generate.h"

#include <gtest/gtest.h>

#include "raytracer/errors.h"
#include "raytracer/scene/load.h"
#include "scene/digest.h"

namespace stipple::raytracer {
namespace {

struct KnownScene {
  std::string_view name;
  int size;
  std::size_t objects;
  std::uint64_t digest;
};
constexpr KnownScene kKnownScenes[] = {
    {"balls", 4, 7382, 0xefc95becb89147c5},   {"rings", 5, 3301, 0xd0b0f3743dbd07a4},
    {"rings", 7, 8401, 0x3f1023bfb1d554ca},   {"teapot", 8, 4096, 0x887cc3bb8ecec7d7},
    {"teapot", 12, 9264, 0xb51adab04046be8a}, {"tree", 10, 4095, 0x70db11e0e3048022},
    {"tree", 11, 8191, 0xbfea19cdb32290e6},
};

const Generator& GeneratorOf(std::string_view name) {
  return *std::ranges::find(kGenerators, name, &Generator::name);
}

TEST(Generate, ScenesAreThoseOfSpd) {
  for (const KnownScene& known : kKnownScenes) {
    const Scene scene = GeneratorOf(known.name).scene(known.size, {});
    EXPECT_EQ(scene.shapes.objects.size(), known.objects) << known.name << ' ' << known.size;
    EXPECT_EQ(DigestOf(scene), known.digest) << known.name << ' ' << known.size;
  }
}

TEST(Generate, ObjectCountsFollowTheFormulas) {
  for (const Generator& generator : kGenerators)
    for (int size = generator.smallest; size < generator.smallest + 5; ++size)
      EXPECT_EQ(static_cast<double>(generator.scene(size, {}).shapes.objects.size()),
                generator.objects(size))
          << generator.name << ' ' << size;
}

TEST(Generate, FirstAndLastObjectsAreThoseOfSpd) {
  const Scene balls = Balls(4);
  EXPECT_NEAR(balls.shapes.spheres[1].center.z, 0.544331, 5e-7);
  EXPECT_NEAR(balls.shapes.spheres.back().center.x, 0.436486, 5e-7);
  EXPECT_NEAR(balls.shapes.spheres.back().center.y, -0.541242, 5e-7);
  const Scene rings = Rings(5);
  EXPECT_NEAR(rings.shapes.cones.back().apex.y, 13.3104, 5e-5);
  const Scene tree = Tree(11);
  EXPECT_NEAR(tree.shapes.spheres.back().center.z, 3.13626, 5e-6);
  const Scene teapot = Teapot(12);
  EXPECT_NEAR(teapot.shapes.triangles.back().corner[2][2], 0.131293, 5e-7);
}

TEST(Generate, AnObjectLimitKeepsTheLargestBalls) {
  const Scene scene = LoadScene({"balls", 4, 4096, "default"});
  ASSERT_EQ(scene.shapes.objects.size(), 4096U);
  EXPECT_EQ(scene.shapes.objects[0].kind, ShapeKind::kPolygon);
  // All of the first four sizes (1 + 9 + 81 + 729) are kept, and the smallest fill up, in file
  // order.
  std::size_t large = 0;
  for (const Sphere<double>& sphere : scene.shapes.spheres) large += sphere.radius > 0.01 ? 1 : 0;
  EXPECT_EQ(large, 820U);
  EXPECT_NEAR(scene.shapes.spheres[0].radius, 0.5, 0);
  EXPECT_NEAR(scene.shapes.spheres[3].radius, 0.5 / 27, 1e-15);
  const Scene teapot = LoadScene({"teapot", 4, 10, "default"});
  EXPECT_EQ(DigestOf(teapot) == DigestOf(Teapot(4)), false);
  EXPECT_EQ(teapot.shapes.polygons.size(), 10U);  // others keep the first of the file
}

TEST(Generate, EachFurtherViewBelongsToOneScene) {
  EXPECT_EQ(LoadScene({"teapot", 2, 0, "side"}).view.from.y, 10.2);
  EXPECT_EQ(LoadScene({"rings", 2, 0, "above"}).view.from.z, 4.3 * 2 + 3);
  EXPECT_THROW(LoadScene({"teapot", 2, 0, "above"}), UsageError);
  EXPECT_THROW(LoadScene({"balls", 2, 0, "side"}), UsageError);
}

TEST(Generate, AbsurdSizesAreRefused) {
  EXPECT_THROW(LoadScene({"balls", 60, 0, "default"}), UsageError);
  EXPECT_THROW(LoadScene({"teapot", 0, 0, "default"}), UsageError);
  EXPECT_THROW(LoadScene({"tree", 100000, 0, "default"}), UsageError);
}

}  // namespace
}  // namespace stipple::raytracer
