// SPDX-License-Identifier: MIT
// Patches as triangles: how far off they are, and that nobody sees it where they are chosen.
#include "raytracer/scene/patches.h"

#include <gtest/gtest.h>

#include <map>

#include "raytracer/geometry/patch.h"
#include "raytracer/image/compare.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/sampling.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

Scene PotOnly(ImageSize image) {
  Scene scene = TeapotPatches(1);
  scene.view.resolution = image;
  scene.shapes.objects.erase(scene.shapes.objects.begin());
  return scene;
}

/// What eye rays through the pixels meet.
struct Seen {
  Seen(Scene scene, ImageSize image) : model(BuildModel<double>(std::move(scene.shapes))) {
    const auto kernel = MakeKernel("bvh", model);
    const Camera<double> camera(scene.view, image);
    TestCounts tests;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        rays.push_back(camera.RayThrough(x, y));
        hits.push_back(kernel->Intersect(rays.back(), tests));
      }
  }

  Model<double> model;
  std::vector<Ray<double>> rays;
  std::vector<Hit<double>> hits;
};

struct TriangleErrors {
  double mean_t = 0;      // along the rays
  double largest = 0;     // across the surface, where both are the same sheet
  double silhouette = 0;  // part of the hits that only one of the two has
};

TriangleErrors ErrorsOf(const Seen& direct, const Seen& triangles) {
  TriangleErrors errors;
  double both = 0, either = 0;
  for (std::size_t i = 0; i < direct.hits.size(); ++i) {
    const Hit<double>&d = direct.hits[i], &t = triangles.hits[i];
    const bool d_met = d.object != kNoObject, t_met = t.object != kNoObject;
    if (d_met || t_met) ++either;
    if (d_met != t_met) ++errors.silhouette;
    if (!d_met || !t_met || std::abs(d.t - t.t) > 0.05) continue;  // another sheet, at an outline
    ++both;
    errors.mean_t += std::abs(d.t - t.t);
    const Patch<double>& patch = direct.model.patches[direct.model.objects[d.object].index];
    const Vec3 normal = PointOn(patch, Parameter<double>(d.u), Parameter<double>(d.v)).normal;
    const double cosine = std::abs(Dot(normal, direct.rays[i].direction));
    errors.largest = std::max(errors.largest, std::abs(d.t - t.t) * cosine);
  }
  return {errors.mean_t / both, errors.largest, errors.silhouette / either};
}

constexpr ImageSize kImage{128, 128};

Seen SeenAs(int cells, ImageSize image) {
  Scene scene = PotOnly(image);
  if (cells > 0) TessellatePatches(scene, cells);
  return {std::move(scene), image};
}

TEST(Patches, ErrorOfTrianglesFallsWithTheSquareOfTheCells) {
  const Seen direct = SeenAs(0, kImage);
  TriangleErrors coarse = ErrorsOf(direct, SeenAs(8, kImage));
  for (const int cells : {16, 32, 64}) {
    const TriangleErrors fine = ErrorsOf(direct, SeenAs(cells, kImage));
    EXPECT_NEAR(coarse.mean_t / fine.mean_t, 4, 1) << cells;
    EXPECT_LE(fine.silhouette, coarse.silhouette) << cells;
    coarse = fine;
  }
}

// The promise of the rule, at several resolutions: a quarter of a pixel, in the middle of the pot.
TEST(Patches, ChosenTrianglesAreOffByLessThanAQuarterOfAPixel) {
  int last = 0;
  for (const int side : {32, 64, 128, 256, 512}) {
    const Scene scene = PotOnly({side, side});
    const PatchChoice choice = ChoosePatches(scene, "auto");
    ASSERT_GT(choice.cells, last);
    last = choice.cells;
    EXPECT_LE(choice.error_pixels, kPatchErrorPixels);
    EXPECT_GT(choice.error_pixels, kPatchErrorPixels / 4);  // and not finer than needed
    const TriangleErrors errors = ErrorsOf(SeenAs(0, kImage), SeenAs(choice.cells, kImage));
    const double pixel = 2 * std::tan(22.5 * 3.14159265 / 180) / side * 6.5;  // at the nearest spot
    EXPECT_LT(errors.largest, kPatchErrorPixels * pixel) << side;
    EXPECT_LT(errors.mean_t, kPatchErrorPixels * pixel) << side;
  }
}

TEST(Patches, RuleChooses) {
  Scene scene = PotOnly({512, 512});
  EXPECT_EQ(ChoosePatches(scene, "direct").cells, 0);
  EXPECT_EQ(ChoosePatches(scene, "direct").error_pixels, 0);
  EXPECT_EQ(ChoosePatches(scene, "7").cells, 7);
  EXPECT_GT(ChoosePatches(scene, "7").error_pixels, kPatchErrorPixels);
  EXPECT_EQ(ChoosePatches(scene, "auto").patches, 32U);
  scene.view.resolution = {4096, 4096};
  EXPECT_GT(ChoosePatches(scene, "auto").cells_needed, kMostPatchCells);
  EXPECT_EQ(ChoosePatches(scene, "auto").cells, 0);
  scene.view.resolution = {64, 64};
  scene.view.from = {0, 0, 1};  // inside the pot: near, but not within any patch's own box
  EXPECT_GT(ChoosePatches(scene, "auto").cells_needed, 1);
  scene.view.from = {1.9, 0.1, 1};
  EXPECT_EQ(ChoosePatches(scene, "auto").cells, 0);
}

TEST(Patches, AdaptingLeavesOtherObjectsWhereTheyAre) {
  Scene scene = TeapotPatches(2);
  const Scene before = scene;
  AdaptPatches(scene, "2");
  EXPECT_TRUE(scene.shapes.patches.empty());
  EXPECT_EQ(scene.patches.cells, 2);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(scene.shapes.objects[i].kind, ShapeKind::kPolygon);
  // Two triangles a cell; one for those at the points in which eight patches end.
  EXPECT_EQ(scene.shapes.objects.size(), 4U + 8 * 32 - 2 * 8);
  EXPECT_EQ(scene.shapes.objects.back().material, before.shapes.objects.back().material);
  Scene balls = Balls(1);
  AdaptPatches(balls, "auto");
  EXPECT_EQ(balls.patches.patches, 0U);
  EXPECT_EQ(balls.shapes.objects.size(), 11U);
}

// Every inner edge has two triangles with the same two corners, to the bit: also between patches.
TEST(Patches, TrianglesOfNeighboursShareTheirCorners) {
  Scene scene = PotOnly({64, 64});
  TessellatePatches(scene, 5);
  std::map<std::array<double, 6>, int> edges;
  for (const Triangle<double>& t : scene.shapes.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double *a = t.corner[i], *b = t.corner[(i + 1) % 3];
      if (std::lexicographical_compare(b, b + 3, a, a + 3)) std::swap(a, b);
      ++edges[{a[0], a[1], a[2], b[0], b[1], b[2]}];
    }
  }
  int open = 0;
  for (const auto& [edge, triangles] : edges)
    if (triangles == 1) ++open;
  // Open ends: rim, body's and bottom's shared outline apart, each a ring of 4 x 5 or 2 x 5 edges.
  EXPECT_EQ(open % 10, 0);
  EXPECT_LT(open, 201);
}

// As fine triangles the pot looks as it does when patches are met directly.
TEST(Patches, PicturesAgree) {
  constexpr ImageSize kSmall{160, 160};
  const auto picture = [&](int cells) {
    Scene scene = TeapotPatches(12);
    if (cells > 0) TessellatePatches(scene, cells);
    const auto model = BuildModel<double>(std::move(scene.shapes));
    const auto kernel = MakeKernel("bvh", model);
    const auto sampler = MakeSampler(scene, model, *kernel, {}, kSmall, {});
    Raster raster(PointCount(RasterOf(kSmall, {})));
    for (RasterPoint point = 0; point < raster.size(); ++point)
      raster[point] = sampler->Sample(point);
    return PictureOf(raster, kSmall, {}).picture;
  };
  const Image direct = picture(0);
  double last = 1;
  for (const int cells : {8, 64}) {
    const ImageDifference difference = Compare(Linear(direct), Linear(picture(cells)));
    EXPECT_LT(difference.rmse, last / 2);
    last = difference.rmse;
  }
  EXPECT_LT(last, 1 / std::pow(10, 50 / 20.0));  // 50 dB
}

}  // namespace
}  // namespace stipple::raytracer
