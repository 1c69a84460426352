// SPDX-License-Identifier: MIT
#include "raytracer/scene/patches.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "raytracer/geometry/patch.h"

namespace stipple::raytracer {
namespace {

/// Weights of four control points in a point of a curve and in its two derivatives.
struct CubicWeights {
  double point[4], slope[4], bend[4];

  explicit CubicWeights(double t) {
    const double s = 1 - t;
    point[0] = s * s * s, point[1] = 3 * s * s * t, point[2] = 3 * s * t * t, point[3] = t * t * t;
    slope[0] = -3 * s * s, slope[1] = 3 * s * (s - 2 * t), slope[2] = 3 * t * (2 * s - t);
    slope[3] = 3 * t * t;
    bend[0] = 6 * s, bend[1] = 6 * (t - 2 * s), bend[2] = 6 * (s - 2 * t), bend[3] = 6 * t;
  }
};

/// The sum of the control points, weighted along v (rows) and u.
Vec3 Blend(const Patch<double>& patch, const double (&along_v)[4], const double (&along_u)[4]) {
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      sum = sum + patch.control[4 * i + j] * (along_v[i] * along_u[j]);
  return sum;
}

/// An edge is off across its own direction, whatever the surface does.
double EdgeBend(Vec3 slope, Vec3 bend) {
  const double length = Length(slope);
  return length > 0 ? Length(Cross(slope, bend)) / length : 0;
}

/// Distance between the patch and two triangles as large as it is, if it were bent everywhere as it
/// is at (u, v). Bends within the surface only move points along it, except at edges.
double ErrorAt(const Patch<double>& patch, double u, double v) {
  const CubicWeights at_u(u), at_v(v);
  const Vec3 normal = PointOn(patch, Parameter<double>(u), Parameter<double>(v)).normal;
  const Vec3 bend_u = Blend(patch, at_v.point, at_u.bend);
  const Vec3 bend_v = Blend(patch, at_v.bend, at_u.point);
  const Vec3 twist = Blend(patch, at_v.slope, at_u.slope);
  double bend = std::abs(Dot(normal, bend_u)) + 2 * std::abs(Dot(normal, twist)) +
                std::abs(Dot(normal, bend_v));
  if (v == 0 || v == 1)
    bend = std::max(bend, EdgeBend(Blend(patch, at_v.point, at_u.slope), bend_u));
  if (u == 0 || u == 1)
    bend = std::max(bend, EdgeBend(Blend(patch, at_v.slope, at_u.point), bend_v));
  return bend / 8;
}

/// The largest on a grid of places.
double ErrorOfOneCell(const Patch<double>& patch) {
  constexpr int kSteps = 8;
  double largest = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j)
      largest = std::max(largest, ErrorAt(patch, static_cast<double>(j) / kSteps,
                                          static_cast<double>(i) / kSteps));
  return largest;
}

double DistanceTo(const Patch<double>& patch, Vec3 eye) {
  Bounds box;
  for (const Vec3& point : patch.control) box.Include(point);
  return Length(Max(Max(box.low - eye, eye - box.high), Vec3{}));
}

/// Pixels that a length of 1 across a ray of length 1 covers, at most: in the picture's corner.
double PixelsPerRadian(const View& view) {
  const auto [width, height] = view.resolution;
  const double half_height = std::tan(view.angle_deg * std::numbers::pi / 360);
  const double half_width = half_height * width / height;
  return height / (2 * half_height) * (1 + half_height * half_height + half_width * half_width);
}

/// A grid of points on a patch; the same bits on edges that patches share.
class CellGrid {
 public:
  CellGrid(const Patch<double>& patch, int cells) : cells_(cells) {
    for (int row = 0; row <= cells; ++row)
      for (int column = 0; column <= cells; ++column)
        points_.push_back(
            PointOn(patch, Parameter<double>(column, cells), Parameter<double>(row, cells)));
  }

  void AddTo(Shapes& shapes, std::uint32_t material) const {
    for (int row = 0; row < cells_; ++row) {
      for (int column = 0; column < cells_; ++column) {
        const PatchPoint<double>&near_left = At(row, column), &near_right = At(row, column + 1),
              &far_left = At(row + 1, column), &far_right = At(row + 1, column + 1);
        AddTriangle(shapes, near_left, near_right, far_right, material);
        AddTriangle(shapes, far_right, far_left, near_left, material);
      }
    }
  }

 private:
  const PatchPoint<double>& At(int row, int column) const {
    return points_[static_cast<std::size_t>(row * (cells_ + 1) + column)];
  }

  /// None without an area: at an edge that is one point.
  static void AddTriangle(Shapes& shapes, const PatchPoint<double>& a, const PatchPoint<double>& b,
                          const PatchPoint<double>& c, std::uint32_t material) {
    const Vec3 corners[] = {a.position, b.position, c.position};
    const Vec3 normals[] = {a.normal, b.normal, c.normal};
    if (Length(NewellNormal(corners)) > 0) shapes.AddPolygon(corners, normals, material);
  }

  int cells_;
  std::vector<PatchPoint<double>> points_;
};

}  // namespace

double PatchErrorPixels(const Patch<double>& patch, const View& view) {
  const double error = ErrorOfOneCell(patch);
  return error > 0 ? PixelsPerRadian(view) * error / DistanceTo(patch, view.from) : 0;
}

double PatchErrorPixels(const Scene& scene) {
  double largest = 0;
  for (const Patch<double>& patch : scene.shapes.patches)
    largest = std::max(largest, PatchErrorPixels(patch, scene.view));
  return largest;
}

PatchChoice ChoosePatches(const Scene& scene, std::string_view rule) {
  return ChoosePatches(scene.shapes.patches.size(), PatchErrorPixels(scene), rule);
}

PatchChoice ChoosePatches(std::size_t patches, double error, std::string_view rule) {
  PatchChoice choice;
  choice.patches = patches;
  choice.cells_needed = std::max(1.0, std::ceil(std::sqrt(error / kPatchErrorPixels)));
  if (rule == "auto")
    choice.cells =
        choice.cells_needed <= kMostPatchCells ? static_cast<int>(choice.cells_needed) : 0;
  else if (rule != "direct")
    std::from_chars(rule.data(), rule.data() + rule.size(), choice.cells);
  if (choice.cells > 0) choice.error_pixels = error / (choice.cells * choice.cells);
  return choice;
}

void AddTriangles(const Patch<double>& patch, int cells, std::uint32_t material, Shapes& to) {
  CellGrid(patch, cells).AddTo(to, material);
}

void TessellatePatches(Scene& scene, int cells) {
  Shapes& shapes = scene.shapes;
  const std::vector<Object> objects = std::exchange(shapes.objects, {});
  const std::vector<Patch<double>> patches = std::exchange(shapes.patches, {});
  for (const Object& object : objects) {
    if (object.kind == ShapeKind::kPatch)
      AddTriangles(patches[object.index], cells, object.material, shapes);
    else
      shapes.objects.push_back(object);
  }
}

void AdaptPatches(Scene& scene, std::string_view rule) {
  if (scene.shapes.patches.empty()) return;
  scene.patches = ChoosePatches(scene, rule);
  if (scene.patches.cells > 0) TessellatePatches(scene, scene.patches.cells);
}

}  // namespace stipple::raytracer
