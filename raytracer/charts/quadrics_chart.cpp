// SPDX-License-Identifier: MIT
// Spheres as they are, or as triangles between circles of latitude and longitude, with the sphere's
// normals at their corners. The time is that of building and drawing; the truth is the spheres in
// long double, as written to a file.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/moved.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/scene/load.h"

namespace stipple::raytracer {
namespace {

constexpr int kBands[] = {4, 8, 16};  // from pole to pole; twice as many around

Scene BallsScene(const Session& session) {
  return LoadScene({.scene = "balls", .size = session.quick ? 1 : 3});
}

Vec3 OnUnitSphere(int band, int sector, int bands) {
  const double down = std::numbers::pi * band / bands;
  const double around = std::numbers::pi * sector / bands;
  return {std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)};
}

void AddTriangles(const Sphere<double>& sphere, int bands, std::uint32_t material, Shapes& shapes) {
  const auto add = [&](std::initializer_list<Vec3> normals) {
    std::vector<Vec3> corners;
    for (const Vec3& normal : normals) corners.push_back(sphere.center + normal * sphere.radius);
    shapes.AddPolygon(corners, normals, material);
  };
  for (int band = 0; band < bands; ++band)
    for (int sector = 0; sector < 2 * bands; ++sector) {
      const Vec3 a = OnUnitSphere(band, sector, bands), b = OnUnitSphere(band + 1, sector, bands);
      const Vec3 c = OnUnitSphere(band + 1, sector + 1, bands);
      const Vec3 d = OnUnitSphere(band, sector + 1, bands);
      if (band + 1 < bands) add({a, b, c});
      if (band > 0) add({a, c, d});
    }
}

/// The same scene with every sphere replaced.
Scene Tessellated(const Scene& scene, int bands) {
  Scene result{scene.background, scene.view, scene.lights, scene.materials, {}};
  for (const Object& object : scene.shapes.objects)
    if (object.kind == ShapeKind::kSphere)
      AddTriangles(scene.shapes.spheres[object.index], bands, object.material, result.shapes);
    else
      AddMoved(scene.shapes, object, {}, result.shapes);
  return result;
}

double BytesOf(const Model<double>& model) {
  double bytes = 0;
  const_cast<Model<double>&>(model).ForEachArray([&bytes](const auto& array) {
    bytes += static_cast<double>(array.size() * sizeof(array[0]));
  });
  return bytes;
}

/// A way to hold the spheres, and what its model takes.
struct Form {
  std::string label;
  Scene scene;
  double bytes = 0;
};

std::vector<Form> FormsOf(const Scene& scene) {
  std::vector<Form> forms{{"exact", scene}};
  for (const int bands : kBands)
    forms.push_back({fmt::format("{} x {}", bands, 2 * bands), Tessellated(scene, bands)});
  return forms;
}

Candidate CandidateOf(Session& session, Form& form) {
  const bool exact = form.label == "exact";
  return {exact ? "spheres" : "triangles", form.label, EyeRays(session.image(), Samples{}),
          [&session, &form] {
            const auto ready = MakeReady<double>(form.scene, "bvh");
            form.bytes = BytesOf(ready->model);
            return Draw(session, *ready, ShadingChoice{}, Samples{});
          },
          exact};
}

}  // namespace

ChartTable QuadricsChart(Session& session) {
  ChartTable table{.name = "quadrics", .title = "Spheres exact or as triangles"};
  table.x.title = "CPU seconds to build and draw";
  table.y.title = "RMS error of a colour, of 1";
  table.more_columns = {"decibels", "model_bytes"};
  std::vector<Form> forms = FormsOf(BallsScene(session));
  std::vector<Candidate> candidates;
  for (Form& form : forms) candidates.push_back(CandidateOf(session, form));
  session.progress.Begin("quadrics", RaysOf(session, candidates));
  Measure(session, candidates);
  const auto truth_scene = MakeReady<long double>(forms.front().scene, "bvh");
  const Pixels truth = AsWritten(Draw(session, *truth_scene, ShadingChoice{}, Samples{}));
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const Candidate& c = candidates[i];
    const double error = RootMeanSquare(AsWritten(c.pixels), truth);
    table.points.push_back({"balls",
                            c.series,
                            c.label,
                            c.cpu_s,
                            error,
                            c.recommended,
                            {Decibels(error), forms[i].bytes}});
  }
  const ChartPoint &exact = table.points.front(), &finest = table.points.back();
  table.sentence = fmt::format(
      "Keep spheres as they are: even {} triangles a sphere miss by {} dB and take {} times the "
      "time and {} times the memory.",
      2 * kBands[2] * (2 * kBands[2] - 2), ShortNumber(finest.more[0]),
      ShortNumber(finest.cpu_s / exact.cpu_s), ShortNumber(finest.more[1] / exact.more[1]));
  return table;
}

}  // namespace stipple::raytracer
