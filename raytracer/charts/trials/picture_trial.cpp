// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/picture_trial.h"

#include <time.h>

#include <cmath>
#include <cstdlib>

#include "raytracer/errors.h"
#include "raytracer/render/picture.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

/// CPU seconds of this thread.
double ThreadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// The scene without its shapes.
Scene WithoutShapes(const Scene& scene) {
  return {scene.background, scene.view, scene.lights, scene.materials, {}};
}

template <class Map>
void AddMapped(const Shapes& shapes, const Object& object, double scale, Map map, Shapes& mapped) {
  const auto normals = [&](std::uint32_t first, std::size_t count) {
    return first == kNoNormals ? std::span<const Vec3>()
                               : std::span(shapes.normals).subspan(first, count);
  };
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& sphere = shapes.spheres[object.index];
      mapped.AddSphere(map(sphere.center), sphere.radius * scale, object.material);
      break;
    }
    case ShapeKind::kCone: {
      const Cone<double>& cone = shapes.cones[object.index];
      mapped.AddCone(map(cone.base), cone.base_radius * scale, map(cone.apex),
                     cone.apex_radius * scale, object.material);
      break;
    }
    case ShapeKind::kTriangle: {
      const Triangle<double>& t = shapes.triangles[object.index];
      std::vector<Vec3> corners;
      for (const auto& corner : t.corner)
        corners.push_back(map(Vec3{corner[0], corner[1], corner[2]}));
      mapped.AddPolygon(corners, normals(t.first_normal, 3), object.material);
      break;
    }
    case ShapeKind::kPolygon: {
      const Polygon<double>& p = shapes.polygons[object.index];
      std::vector<Vec3> corners;
      for (std::uint32_t i = 0; i < p.vertex_count; ++i)
        corners.push_back(map(shapes.vertices[p.first_vertex + i]));
      mapped.AddPolygon(corners, normals(p.first_normal, p.vertex_count), object.material);
      break;
    }
    case ShapeKind::kPatch: {
      Patch<double> patch = shapes.patches[object.index];
      for (Vec3& point : patch.control) point = map(point);
      mapped.AddPatch(patch.control, object.material);
      break;
    }
  }
}

/// Part of the pixels with a channel that differs by more than one step.
double ChangedPixels(const Image& a, const Image& b) {
  std::size_t changed = 0;
  const std::size_t pixels = a.rgb.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    bool differs = false;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      differs = differs || std::abs(a.rgb[c] - b.rgb[c]) > 1;
    changed += differs ? 1 : 0;
  }
  return static_cast<double>(changed) / static_cast<double>(pixels);
}

template <class Real>
void AddRow(std::string_view name, std::string_view precision, std::string_view kernel,
            double shift, const Scene& scene, const PictureRun& truth,
            std::vector<ShiftRow>& rows) {
  const ImageSize image = truth.picture.size;
  try {
    const PictureRun run = TracePicture<Real>(scene, kernel, image);
    rows.push_back(
        {name, precision, kernel, shift, run.cpu_s, ChangedPixels(run.picture, truth.picture)});
  } catch (const UsageError&) {
    // A kernel that cannot trace this scene has no row.
  }
}

}  // namespace

Scene Moved(const Scene& scene, double scale, double shift) {
  const auto map = [&](Vec3 p) { return p * scale + Vec3{shift, shift, shift}; };
  Scene moved = WithoutShapes(scene);
  for (const Object& object : scene.shapes.objects)
    AddMapped(scene.shapes, object, scale, map, moved.shapes);
  moved.view.from = map(scene.view.from);
  moved.view.at = map(scene.view.at);
  for (Light& light : moved.lights) {
    light.position = map(light.position);
    light.radius *= scale;
  }
  return moved;
}

template <class Real>
PictureRun TracePicture(Scene scene, std::string_view kernel_name, ImageSize image) {
  const double start = ThreadSeconds();
  const Model<Real> model = BuildModel<Real>(std::move(scene.shapes));
  const auto kernel = MakeKernel(kernel_name, model);
  const Samples corners;
  const auto sampler = MakeSampler(scene, model, *kernel, {}, image, corners);
  Raster raster;
  const RasterPoint points = PointCount(RasterOf(image, corners));
  raster.reserve(points);
  for (RasterPoint point = 0; point < points; ++point) raster.push_back(sampler->Sample(point));
  const double cpu_s = ThreadSeconds() - start;
  return {sampler->counts(), PictureOf(raster, image, corners), cpu_s};
}

template PictureRun TracePicture<float>(Scene, std::string_view, ImageSize);
template PictureRun TracePicture<double>(Scene, std::string_view, ImageSize);
template PictureRun TracePicture<long double>(Scene, std::string_view, ImageSize);

std::vector<ShiftRow> ShiftRows(int image_side, const std::vector<std::string_view>& kernels) {
  std::vector<ShiftRow> rows;
  const std::pair<std::string_view, Scene> scenes[] = {
      {"balls", Balls(4)}, {"rings", Rings(7)}, {"teapot", Teapot(12)}, {"tree", Tree(11)}};
  for (const auto& [name, scene] : scenes)
    for (int power = -1; power <= 6; ++power) {
      const double shift = power < 0 ? 0 : std::pow(10.0, power);
      const Scene moved = Moved(scene, 1, shift);
      const PictureRun truth = TracePicture<long double>(moved, "scalar", {image_side, image_side});
      rows.push_back({name, "long double", "scalar", shift, truth.cpu_s, 0});
      for (const std::string_view kernel : kernels) {
        AddRow<float>(name, "float", kernel, shift, moved, truth, rows);
        AddRow<double>(name, "double", kernel, shift, moved, truth, rows);
      }
    }
  return rows;
}

}  // namespace stipple::raytracer
