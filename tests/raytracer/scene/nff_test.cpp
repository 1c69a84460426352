// SPDX-License-Identifier: MIT
#include "raytracer/scene/nff.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "raytracer/errors.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

constexpr const char* kView = "v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 resolution 8 8\n";

Scene EveryEntity() { return ReadNff(std::string(STIPPLE_TEST_DATA) + "/every_entity.nff"); }

std::string ProblemOf(const std::string& text) {
  try {
    ParseNff(text, "x.nff");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Nff, EveryEntityIsReadInAnyOrder) {
  const Scene scene = EveryEntity();
  EXPECT_EQ(scene.background, (Vec3{0.1, 0.2, 0.3}));
  EXPECT_EQ(scene.view.from, (Vec3{0, 0, 9}));
  EXPECT_EQ(scene.view.resolution, (ImageSize{16, 12}));
  EXPECT_EQ(scene.view.angle_deg, 30);
  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_FALSE(scene.lights[0].colored);
  EXPECT_EQ(scene.lights[1].color, (Vec3{1, 0.5, 0}));
  const Shapes& shapes = scene.shapes;
  ASSERT_EQ(shapes.objects.size(), 8U);
  ASSERT_EQ(shapes.spheres.size(), 2U);
  EXPECT_EQ(shapes.spheres[1].radius, -0.25);
  ASSERT_EQ(shapes.cones.size(), 2U);
  EXPECT_EQ(shapes.cones[0].apex, (Vec3{0, 0, 2}));
  EXPECT_EQ(shapes.cones[1].base_radius, -0.25);
  ASSERT_EQ(shapes.polygons.size(), 2U);
  EXPECT_EQ(shapes.polygons[0].vertex_count, 6U);
  ASSERT_EQ(shapes.triangles.size(), 2U);
  EXPECT_EQ(shapes.triangles[0].first_normal, kNoNormals);
  EXPECT_NE(shapes.triangles[1].first_normal, kNoNormals);
}

TEST(Nff, AFillHoldsUntilTheNext) {
  const Scene scene = EveryEntity();
  const auto material = [&](std::size_t object) {
    return scene.materials[scene.shapes.objects[object].material];
  };
  EXPECT_EQ(material(0), Material{});
  EXPECT_EQ(material(1).color, (Vec3{1, 0, 0}));
  EXPECT_EQ(material(3), material(1));
  EXPECT_EQ(material(4).transmission, 0.8);
  EXPECT_EQ(material(7).refraction, 1.5);
}

TEST(Nff, NormalsGetUnitLength) {
  const Scene scene = EveryEntity();
  for (const Vec3& normal : scene.shapes.normals) EXPECT_NEAR(Length(normal), 1, 1e-5);
}

TEST(Nff, WritingAndReadingGivesTheSameScene) {
  for (const Scene& scene : {EveryEntity(), Balls(1), Rings(1), Teapot(2), Tree(3)}) {
    const std::string text = FormatNff(scene);
    EXPECT_EQ(FormatNff(ParseNff(text, "again")), text);
  }
}

TEST(Nff, AFileIsWrittenAsFormatted) {
  const std::string path = testing::TempDir() + "nff_test_" + std::to_string(getpid()) + ".nff";
  WriteNff(Tree(2), path);
  EXPECT_EQ(FormatNff(ReadNff(path)), FormatNff(Tree(2)));
  std::remove(path.c_str());
}

TEST(Nff, NothingButAViewIsAnEmptyScene) {
  EXPECT_TRUE(ParseNff(kView, "view").shapes.objects.empty());
}

struct BadText {
  const char* text;     // after a line that holds a sound view
  const char* problem;  // how the message goes on after the file's name
};
constexpr BadText kBadTexts[] = {
    {"s 0 0 0 0\n", ":2: sphere of radius 0"},
    {"s 0 0 nan 1\n", ":2: the sphere's centre is not a finite number: nan"},
    {"s 0 0 inf 1\n", ":2: the sphere's centre is not a finite number: inf"},
    {"s 0 0 1e999 1\n", ":2: the sphere's centre is not a finite number: 1e999"},
    {"s 0 0 1e40 1\n", ":2: the sphere's centre is too large: 1e40"},
    {"s 0 0\n\n0x1 1\n", ":4: the sphere's centre should be a number, found '0x1'"},
    {"s 0 0 0 1s\n", ":2: the sphere's radius should be a number, found '1s'"},
    {"s 0 0\n# more\n", ":2: the file ends where the sphere's centre should be"},
    {"c 1 1 1 1 1 1 1 2\n", ":2: the cone's base and apex coincide"},
    {"c 0 0 0 0 1 1 1 0\n", ":2: cone of radius 0 at both ends"},
    {"c 0 0 0 1 1 1 1 -1\n", ":2: the cone's radii have different signs"},
    {"p 2 0 0 0 1 0 0\n", ":2: the polygon's number of vertices is 2, it should be from 3"},
    {"p -1\n", ":2: the polygon's number of vertices is -1"},
    {"p 3.5\n", ":2: the polygon's number of vertices should be a whole number"},
    {"p 200000000 0 0 0\n", ":2: polygon of 200000000 vertices, but the rest of the file is too"},
    {"p 1e20\n", ":2: the polygon's number of vertices is 1e+20"},
    {"p 3 0 0 0 1 1 1 2 2 2\n", ":2: polygon of zero area"},
    {"p 4 0 0 0 0 0 0 0 0 0 0 0 0\n", ":2: polygon of zero area"},
    {"pp 3 0 0 0 0 0 1\n1 0 0 0 0 0\n0 1 0 0 0 1\n", ":3: normal of length 0"},
    {"f 1 1 1 1 0 0 0.5 0\n", ":2: a fill that lets light through needs an index"},
    {"f 1 1 1 1 0\n", ":2: the file ends where the fill's shine should be"},
    {"\n\nx 1 2 3\n", ":4: unknown entity 'x'; known are v b l f s c p pp"},
    {"l 1 2 3 4\n", ":2: the file ends where the light's colour should be"},
    {"v from 0 0 1\n", ":2: the view lacks 'at', 'up', 'angle', 'resolution'"},
    {"v from 0 0 1 at 0 0 1 up 0 1 0 angle 45 resolution 8 8\n", ":2: the view's 'from' and 'at'"},
    {"v from 0 0 1 at 0 0 0 up 0 0 2 angle 45 resolution 8 8\n", ":2: the view's 'up' is zero or"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 180 resolution 8 8\n", ":2: the view's 'angle'"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 0 8\n", ":2: 'resolution' is 0"},
    {"\x7f\x01\xff", ":2: unknown entity '?\?\?'"},
};

TEST(Nff, WhatIsWrongIsSaidWithItsLine) {
  for (const BadText& bad : kBadTexts)
    EXPECT_EQ(ProblemOf(std::string(kView) + bad.text).find(std::string("x.nff") + bad.problem), 0U)
        << bad.text << ProblemOf(std::string(kView) + bad.text);
}

TEST(Nff, ASceneNeedsAView) {
  EXPECT_EQ(ProblemOf("b 0 0 0\n").find("x.nff:1: no view"), 0U);
  EXPECT_EQ(ProblemOf("").find("x.nff:1: no view"), 0U);
}

TEST(Nff, TinyNumbersAreZeroNotErrors) {
  const Scene scene = ParseNff(std::string(kView) + "s 1e-400 0 0.0000000001 1\n", "tiny");
  EXPECT_EQ(scene.shapes.spheres[0].center.x, 0);
}

// Whatever a file is cut to, the reader answers with a scene or a message, and never with anything
// else.
TEST(Nff, AnyPrefixIsReadOrRefused) {
  std::ifstream file(std::string(STIPPLE_TEST_DATA) + "/every_entity.nff");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  int refused = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::string problem = ProblemOf(text.substr(0, length));
    if (problem == "accepted") continue;
    ++refused;
    EXPECT_EQ(problem.find("x.nff:"), 0U) << problem;
  }
  EXPECT_GT(refused, 100);
}

TEST(Nff, MissingFilesAndFoldersAreRefused) {
  EXPECT_THROW(ReadNff("/nowhere/none.nff"), InputError);
  EXPECT_THROW(ReadNff("/"), InputError);
  EXPECT_THROW(WriteNff(Balls(0), "/nowhere/none.nff"), InputError);
}

}  // namespace
}  // namespace stipple::raytracer
