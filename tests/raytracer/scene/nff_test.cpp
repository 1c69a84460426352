// SPDX-License-Identifier: MIT
#include "raytracer/scene/nff.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>
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
  ASSERT_EQ(scene.lights.size(), 3U);
  EXPECT_FALSE(scene.lights[0].colored);
  EXPECT_EQ(scene.lights[1].color, (Vec3{1, 0.5, 0}));
  const Shapes& shapes = scene.shapes;
  ASSERT_EQ(shapes.objects.size(), 9U);
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

TEST(Nff, ExtensionsAreReadAndWrittenOnlyWhereUsed) {
  const Scene scene = EveryEntity();
  EXPECT_EQ(scene.lights[0].radius, 0);
  EXPECT_EQ(scene.lights[2].radius, 0.75);
  EXPECT_EQ(scene.materials.back().priority, 2);
  ASSERT_EQ(scene.shapes.patches.size(), 1U);
  EXPECT_EQ(scene.shapes.patches[0].control[5], (Vec3{-2, 1, 2}));
  const std::string text = FormatNff(scene);
  EXPECT_NE(text.find("l 0 6 6 1 1 1 0.75\n"), std::string::npos);
  EXPECT_NE(text.find("f 0.2 0.4 0.6 0 0.2 3 0.8 1.5 2\n"), std::string::npos);
  EXPECT_NE(text.find("l 5 5 5\nl -5 5 5 1 0.5 0\n"), std::string::npos);
  EXPECT_NE(text.find("f 1 0 0 0.5 0.5 10 0 0\n"), std::string::npos);
}

TEST(Nff, EqualFillsAreOneMaterial) {
  std::string text = kView;
  for (int i = 0; i < 100; ++i)
    text += i % 2 == 0 ? "f 1 0 0 1 0 1 0 0\ns 0 0 0 1\n" : "f 0 1 0 1 0 1 0 0\ns 0 0 0 1\n";
  const Scene scene = ParseNff(text, "fills");
  EXPECT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[scene.shapes.objects[99].material].color, (Vec3{0, 1, 0}));
}

// What editors of other systems leave: a byte order mark, line ends of two characters or of one.
TEST(Nff, LineEndsOfAnyKindEndComments) {
  const std::string body = "# eye\r\nv from 0 0 9 at 0 0 0 up 0 1 0 angle 45 resolution 8 8\r\n";
  EXPECT_EQ(ParseNff("\xef\xbb\xbf" + body + "s 0 0 0 1\r\n", "dos").shapes.objects.size(), 1U);
  const std::string mac = "# eye\rv from 0 0 9 at 0 0 0 up 0 1 0 angle 45 resolution 8 8\r";
  EXPECT_EQ(ParseNff(mac + "# ball\rs 0 0 0 1", "mac").shapes.objects.size(), 1U);
}

// SPD's gears are such polygons: 144 corners, concave.
TEST(Nff, AGearIsOnePolygon) {
  std::string text = std::string(kView) + "p 144\n";
  for (int i = 0; i < 144; ++i) {
    const double angle = 2 * std::numbers::pi * i / 144, radius = i / 2 % 2 == 0 ? 1 : 0.8;
    text +=
        fmt::format("{:g} {:g} 0.5 # {}\n", radius * std::cos(angle), radius * std::sin(angle), i);
  }
  const Scene scene = ParseNff(text, "gear");
  ASSERT_EQ(scene.shapes.polygons.size(), 1U);
  EXPECT_EQ(scene.shapes.polygons[0].vertex_count, 144U);
  EXPECT_NEAR(scene.shapes.polygons[0].normal.z, 1, 1e-12);
}

TEST(Nff, OutlinesMayTouchAndCrossThemselves) {
  const Scene scene = ParseNff(std::string(kView) +
                                   "p 4 0 0 0 3 3 0 3 0 0 0 1 0\n"                 // a crossing
                                   "p 6 0 0 0 2 0 0 2 2 0 0 0 0 -1 1 0 -1 0 0\n",  // a touch
                               "outlines");
  EXPECT_EQ(scene.shapes.polygons.size(), 2U);
}

TEST(Nff, ACameraFileNeedsNothingButItsView) {
  const std::string path = testing::TempDir() + "nff_view_" + std::to_string(getpid()) + ".nff";
  std::ofstream(path) << "b 0 0 0\n" << kView << "what follows is not read";
  EXPECT_EQ(ReadNffView(path).from, (Vec3{0, 0, 9}));
  std::remove(path.c_str());
}

TEST(Nff, AFileIsWrittenAsFormatted) {
  const std::string path = testing::TempDir() + "nff_test_" + std::to_string(getpid()) + ".nff";
  WriteNff(Tree(2), path);
  EXPECT_EQ(FormatNff(ReadNff(path)), FormatNff(Tree(2)));
  std::remove(path.c_str());
}

/// What `read` says of a text that is wrong.
std::string Complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

// Files come through a window of 64 kB: nothing may depend on where it cuts them.
TEST(Nff, AFileIsReadAsItsTextIs) {
  const std::string path = testing::TempDir() + "nff_window_" + std::to_string(getpid()) + ".nff";
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::string text = kView;
    while (text.size() < 300000) {
      const std::string digits(random() % 50 == 0 ? 5000 + random() % 90000 : random() % 12, '3');
      text += "s 0." + digits + "1 -2 " + std::to_string(random() % 1000) + " 1\n";
      if (random() % 20 == 0) text += '#' + std::string(random() % 3000, 'p') + '\n';
      if (random() % 500 == 0) text += '#' + std::string(70000 + random() % 70000, '\t') + "s 1\r";
      if (random() % 500 == 0) text += std::string(70000 + random() % 70000, '\n');
      if (random() % 2 == 0) text += "p 3 0 0 0  1 0 0\n\n0 1 0";
      text += std::string(random() % 9 + 1, ' ');
    }
    std::ofstream(path, std::ios::binary) << text;
    EXPECT_EQ(FormatNff(ReadNff(path)), FormatNff(ParseNff(text, path)));
    const std::string wrong = text + "# end\n s 1 2 3\n";
    std::ofstream(path, std::ios::binary) << wrong;
    EXPECT_EQ(Complaint([&] { ReadNff(path); }), Complaint([&] { ParseNff(wrong, path); }));
    EXPECT_NE(Complaint([&] { ReadNff(path); }), "none");
  }
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
    {"\n\nx 1 2 3\n", ":4: unknown entity 'x'; known are v b l f s c p pp bezier"},
    {"l 1 2 3 4\n", ":2: the file ends where the light's colour should be"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 8 8\n", ":2: a second view; the first"},
    {"b 0 0 0\nb 1 1 1\n", ":3: a second background; the first stands in line 2"},
    {"b 0 0 -1\n", ":2: the background's colour should be from 0 to 1000"},
    {"l 0 0 0 1 1 1e9\n", ":2: the light's colour should be from 0 to 1000"},
    {"l 0 0 0 1 1 1 -2\n", ":2: the light's radius should not be negative"},
    {"f 1 1 1 1 1.5 10 0 0\n", ":2: the fill's Ks should be from 0 to 1"},
    {"f 1 1 1 1 0 -1 0 0\n", ":2: the fill's shine should not be negative"},
    {"f 1 1 1 1 0 1 -0.5 1\n", ":2: the fill's T should be from 0 to 1"},
    {"f 1 1 1 1 0 1 0.5 1 2.5\n", ":2: the fill's priority should be a whole number"},
    {"f 1 1 1 1 0 1 0.5 1 -1\n", ":2: the fill's priority is -1, it should be from 0 to 1000"},
    {"s 1e300 0 0 1\n", ":2: the sphere's centre is too large: 1e300"},
    {"s 0 0 0 1e-320\n", ":2: sphere too small for its place"},
    {"s 1e10 0 0 1e-3\n", ":2: sphere too small for its place"},
    {"c 0 0 0 1 0 0 1e-40 1\n", ":2: cone too short for its place"},
    {"c 0 0 0 1e-40 0 0 1 0\n", ":2: cone too thin for its place"},
    {"p 3 0 0 0 1e-100 0 0 0 1e-100 0\n", ":2: polygon too small for its place"},
    {"p 4 0 0 0 1 1 0 1 0 0 0 1 0\n", ":2: polygon of zero area"},  // a bow-tie of equal wings
    {"p 4 0 0 0 1 0 0 1 1 1 0 1 0\n", ":2: the polygon's corners do not lie in one plane"},
    {"bezier 0 0 0 1 1 1\n", ":2: the file ends where the patch's control point should be"},
    {"bezier 0 0 0 1 1 1 2 2 2 3 3 3 0 0 0 1 1 1 2 2 2 3 3 3 0 0 0 1 1 1 2 2 2 3 3 3 0 0 0 1 1 1 "
     "2 2 2 3 3 3\n",
     ":2: patch of zero area"},
    {"\x7f\x01\xff", ":2: unknown entity '?\?\?'"},
};

TEST(Nff, WhatIsWrongIsSaidWithItsLine) {
  for (const BadText& bad : kBadTexts)
    EXPECT_EQ(ProblemOf(std::string(kView) + bad.text).find(std::string("x.nff") + bad.problem), 0U)
        << bad.text << ProblemOf(std::string(kView) + bad.text);
}

constexpr BadText kBadViews[] = {
    {"v from 0 0 1\n", ":1: the view lacks 'at', 'up', 'angle', 'resolution'"},
    {"v from 0 0 1 at 0 0 1 up 0 1 0 angle 45 resolution 8 8\n", ":1: the view's 'from' and 'at'"},
    {"v from 0 0 1 at 0 0 0 up 0 0 2 angle 45 resolution 8 8\n", ":1: the view's 'up' is zero or"},
    {"v from 0 0 1 at 0 0 0 up 0 0 0 angle 45 resolution 8 8\n", ":1: the view's 'up' is zero or"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 0 resolution 8 8\n", ":1: the view's 'angle'"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 180 resolution 8 8\n", ":1: the view's 'angle'"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 0 8\n", ":1: 'resolution' is 0"},
    {"v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 8 99999\n", ":1: 'resolution' is 99999"},
};

TEST(Nff, ViewsThatShowNothingAreRefused) {
  for (const BadText& bad : kBadViews)
    EXPECT_EQ(ProblemOf(bad.text).find(std::string("x.nff") + bad.problem), 0U)
        << bad.text << ProblemOf(bad.text);
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
