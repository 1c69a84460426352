// SPDX-License-Identifier: MIT
// SPD's teapot: M. Newell's pot of 1975, lid and bottom included, on a checkerboard. The pot is 32
// bicubic Bezier patches; SPD cuts each into n x n cells of two triangles with normals, where cells
// at the middle of the lid and of the bottom are one triangle. The scene teapot-patches keeps them.
//
// The pot is stored by what it is. Rim, body, knob, lid and bottom are turned: a patch is a profile
// of four rings, each ring a quarter circle in Bezier form, and four quarters make a strip. Handle
// and spout are tubes: four cross sections, mirrored at the plane y = 0.
#include <array>
#include <cmath>
#include <span>

#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

/// A quarter circle's control points are (radius, 0), (radius, bend), (bend, radius), (0, radius).
struct Ring {
  double radius, bend, z;
};
struct TurnedStrip {
  Ring rings[4];
  double turn;  // -1: quarters follow each other from +x to -y, +1: from +x to +y
};
constexpr TurnedStrip kRim{
    {{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125}, {1.5, 0.84, 2.4}}, -1};
constexpr TurnedStrip kShoulder{
    {{1.5, 0.84, 2.4}, {1.75, 0.98, 1.875}, {2, 1.12, 1.35}, {2, 1.12, 0.9}}, -1};
constexpr TurnedStrip kBelly{
    {{2, 1.12, 0.9}, {2, 1.12, 0.45}, {1.5, 0.84, 0.225}, {1.5, 0.84, 0.15}}, -1};
constexpr TurnedStrip kKnob{{{0, 0, 3.15}, {0.8, 0.45, 3.15}, {0, 0, 2.85}, {0.2, 0.112, 2.7}}, -1};
constexpr TurnedStrip kLid{
    {{0.2, 0.112, 2.7}, {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}}, -1};
constexpr TurnedStrip kBottom{{{0, 0, 0}, {1.425, 0.798, 0}, {1.5, 0.84, 0.075}, {1.5, 0.84, 0.15}},
                              1};

/// A tube's cross section spans from one point of the plane y = 0 to another, `half_width` to each
/// side of it.
struct CrossSection {
  double first_x, first_z, second_x, second_z, half_width;
};
using TubeStrip = std::array<CrossSection, 4>;
constexpr TubeStrip kHandleTop{{{-1.6, 2.025, -1.5, 2.25, 0.3},
                                {-2.3, 2.025, -2.5, 2.25, 0.3},
                                {-2.7, 2.025, -3, 2.25, 0.3},
                                {-2.7, 1.8, -3, 1.8, 0.3}}};
constexpr TubeStrip kHandleEnd{{{-2.7, 1.8, -3, 1.8, 0.3},
                                {-2.7, 1.575, -3, 1.35, 0.3},
                                {-2.5, 1.125, -2.65, 0.9375, 0.3},
                                {-2, 0.9, -1.9, 0.6, 0.3}}};
constexpr TubeStrip kSpoutRoot{{{1.7, 1.425, 1.7, 0.6, 0.66},
                                {2.6, 1.425, 3.1, 0.825, 0.66},
                                {2.3, 2.1, 2.4, 2.025, 0.25},
                                {2.7, 2.4, 3.3, 2.4, 0.25}}};
constexpr TubeStrip kSpoutTip{{{2.7, 2.4, 3.3, 2.4, 0.25},
                               {2.8, 2.475, 3.525, 2.49375, 0.25},
                               {2.9, 2.475, 3.45, 2.5125, 0.15},
                               {2.8, 2.4, 3.2, 2.4, 0.15}}};

/// Control points, four rows of four.
using ControlNet = std::array<std::array<Vec3, 4>, 4>;

/// Powers of a parameter, highest first, and their derivatives.
struct Powers {
  double value[4];
  double slope[4];

  explicit Powers(double t) : value{t * t * t, t * t, t, 1}, slope{3 * t * t, 2 * t, 1, 0} {}
};

struct SurfacePoint {
  Vec3 position, normal;
};

/// A patch as a polynomial in both parameters. The order of all sums is SPD's: about 600
/// coordinates of a pot lie half-way between two numbers of six digits, and only the same rounding
/// errors send them the same way.
class PatchSurface {
 public:
  explicit PatchSurface(const ControlNet& patch)
      : coefficients_(TimesBezier(BezierTimes(patch))),
        pointed_(patch[0][0] == patch[0][3]),
        point_normal_{0, 0, patch[0][0].z > 1 ? 1.0 : -1.0} {}

  /// The first row of control points is a single point, as in the middle of lid and bottom.
  bool pointed() const { return pointed_; }

  SurfacePoint At(double row, double column) const {
    const Powers v(row), u(column);
    const Vec3 position = Blend(v.value, u.value);
    // Where a whole row is one point the surface has no tangent along it; its normal is the axis.
    if (row == 0 && pointed_) return {position, point_normal_};
    return {position, Normalized(Cross(Blend(v.value, u.slope), Blend(v.slope, u.value)))};
  }

 private:
  static constexpr double kBezier[4][4] = {
      {-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}};

  static ControlNet BezierTimes(const ControlNet& b) {
    ControlNet product;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) product[i][j] = product[i][j] + b[k][j] * kBezier[i][k];
    return product;
  }
  static ControlNet TimesBezier(const ControlNet& a) {
    ControlNet product;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) product[i][j] = product[i][j] + a[i][k] * kBezier[k][j];
    return product;
  }

  Vec3 Blend(const double (&rows)[4], const double (&columns)[4]) const {
    Vec3 sum;
    for (std::size_t c = 0; c < 4; ++c) {
      Vec3 column;
      for (std::size_t r = 0; r < 4; ++r) column = column + coefficients_[r][c] * rows[r];
      sum = sum + column * columns[c];
    }
    return sum;
  }

  ControlNet coefficients_;
  bool pointed_;
  Vec3 point_normal_;
};

/// The four patches of a turned strip.
template <class Use>
void ForEachPatch(const TurnedStrip& strip, Use use) {
  // The quarter from one axis to the next, then the same turned about z three times.
  for (int quarter = 0; quarter < 4; ++quarter) {
    ControlNet patch;
    for (std::size_t r = 0; r < 4; ++r) {
      const auto& [radius, bend, z] = strip.rings[r];
      const double flat[4][2] = {{radius, 0}, {radius, bend}, {bend, radius}, {0, radius}};
      for (std::size_t c = 0; c < 4; ++c) {
        double x = flat[c][0], y = flat[c][1];
        for (int turn = 0; turn < quarter; ++turn) std::swap(x, y), x = -x;
        patch[r][c] = {x, strip.turn * y, z};
      }
    }
    use(patch);
  }
}

/// The two patches of a tube.
template <class Use>
void ForEachPatch(const TubeStrip& strip, Use use) {
  ControlNet half, mirrored;
  for (std::size_t r = 0; r < 4; ++r) {
    const CrossSection& s = strip[r];
    half[r] = {Vec3{s.first_x, 0, s.first_z}, Vec3{s.first_x, -s.half_width, s.first_z},
               Vec3{s.second_x, -s.half_width, s.second_z}, Vec3{s.second_x, 0, s.second_z}};
    for (std::size_t c = 0; c < 4; ++c) {
      const Vec3 p = half[r][3 - c];
      mirrored[r][c] = {p.x, -p.y, p.z};
    }
  }
  use(half);
  use(mirrored);
}

/// The pot's 32 patches in SPD's order.
template <class Use>
void ForEachPotPatch(Use use) {
  for (const TurnedStrip* strip : {&kRim, &kShoulder, &kBelly}) ForEachPatch(*strip, use);
  for (const TubeStrip* strip : {&kHandleTop, &kHandleEnd, &kSpoutRoot, &kSpoutTip})
    ForEachPatch(*strip, use);
  for (const TurnedStrip* strip : {&kKnob, &kLid, &kBottom}) ForEachPatch(*strip, use);
}

void AddTriangle(ShapeStream& shapes, const SurfacePoint& a, const SurfacePoint& b,
                 const SurfacePoint& c, std::uint32_t material) {
  const Vec3 corners[] = {a.position, b.position, c.position};
  const Vec3 normals[] = {a.normal, b.normal, c.normal};
  shapes.AddPolygon(corners, normals, material);
}

/// A patch as SPD cuts it.
void AddCells(ShapeStream& shapes, const ControlNet& patch, int cells, std::uint32_t material) {
  const PatchSurface surface(patch);
  const auto at = [&](int row, int column) {
    return surface.At(static_cast<double>(row) / cells, static_cast<double>(column) / cells);
  };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const SurfacePoint near_left = at(row, column), near_right = at(row, column + 1);
      const SurfacePoint far_left = at(row + 1, column), far_right = at(row + 1, column + 1);
      if (row > 0 || !surface.pointed())
        AddTriangle(shapes, near_left, near_right, far_right, material);
      AddTriangle(shapes, far_right, far_left, near_left, material);
    }
  }
}

/// The squares of one colour of an n x n board from -4 to 4.
void AddBoard(ShapeStream& shapes, int squares, int parity, std::uint32_t material) {
  const auto edge = [&](int i) { return -4 + 8.0 * i / squares; };
  for (int i = 0; i < squares; ++i) {
    for (int j = 0; j < squares; ++j) {
      if ((i + j) % 2 != parity) continue;
      const Vec3 square[] = {{edge(i), edge(j), 0},
                             {edge(i + 1), edge(j), 0},
                             {edge(i + 1), edge(j + 1), 0},
                             {edge(i), edge(j + 1), 0}};
      shapes.AddPolygon(square, {}, material);
    }
  }
}

/// All but the pot, whose material is the last one.
void SetTable(int squares, Scene& scene, ShapeStream& shapes) {
  scene.background = kSpdBackground;
  scene.view = {{4.86, 7.2, 5.4}, {0, 0, 0}, {0, 0, 1}, 45, 1, {512, 512}};
  scene.lights = {{{-3.1, 9.8, 12.1}}, {{11.3, 5.1, 8.8}}};
  scene.materials = {{{1, 1, 1}, 0.5, 0.5, 4.81884, 0, 0},
                     {{0.5, 0.5, 0.5}, 0.5, 0.5, 4.81884, 0, 0},
                     {{1, 0.5, 0.1}, 0.75, 0.25, 3.0827, 0, 0}};
  AddBoard(shapes, squares, 1, 0);
  AddBoard(shapes, squares, 0, 1);
}

constexpr std::uint32_t kPotMaterial = 2;

}  // namespace

double TeapotObjects(double size) { return 65 * size * size - 8 * size; }

Scene Teapot(int size, const TakeShapes& take) {
  Scene scene;
  ShapeStream shapes(scene.shapes, take);
  SetTable(size, scene, shapes);
  ForEachPotPatch([&](const ControlNet& patch) { AddCells(shapes, patch, size, kPotMaterial); });
  return scene;
}

double TeapotPatchesObjects(double size) { return size * size + 32; }

Scene TeapotPatches(int size, const TakeShapes& take) {
  Scene scene;
  ShapeStream shapes(scene.shapes, take);
  SetTable(size, scene, shapes);
  ForEachPotPatch([&](const ControlNet& patch) {
    std::array<Vec3, 16> control;
    for (std::size_t k = 0; k < 16; ++k) control[k] = patch[k / 4][k % 4];
    shapes.AddPatch(control, kPotMaterial);
  });
  return scene;
}

View TeapotSideView(int) { return {{0.2, 10.2, 2.2}, {0.2, 0, 1.5}, {0, 0, 1}, 45, 1, {512, 512}}; }

}  // namespace stipple::raytracer
