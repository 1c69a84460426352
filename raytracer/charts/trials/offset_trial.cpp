// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/offset_trial.h"

#include <array>
#include <cmath>

#include "raytracer/charts/rejected/offset.h"
#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/render/offset.h"

namespace stipple::raytracer {
namespace {

constexpr long double kGap = 1e-3L;  // between surface and wall, in sizes
constexpr int kPlacements = 16;      // of the shape, each turned another way

template <class Real>
Vec<Real> StartRelative(Vec<Real> point, Vec<Real> normal, Real t) {
  return point + normal * SurfaceOffset(point, t, std::numeric_limits<Real>::epsilon());
}

/// Where a shape of unit size stands in the scene.
struct Placement {
  Axes frame;
  WideVec center;
  long double size;

  WideVec At(WideVec local) const { return center + frame.At(local) * size; }
};

void AddPolygon(Shapes& shapes, const Placement& placement, int corners, long double radius,
                long double height) {
  std::vector<Vec3> polygon;
  for (int i = 0; i < corners; ++i) {
    const long double angle = 6.283185307179586L * static_cast<long double>(i) / corners;
    polygon.push_back(Rounded<double>(
        placement.At({radius * std::cos(angle), radius * std::sin(angle), height})));
  }
  shapes.AddPolygon(polygon, {}, 0);
}

/// The surface (`gap` 0) or its wall. Spheres and cones are surrounded by larger ones.
Shapes MakeShape(ShapeKind kind, const Placement& placement, long double gap) {
  Shapes shapes;
  const auto radius = static_cast<double>(placement.size * (1 + gap));
  const long double extent = gap > 0 ? 4 : 1;
  if (kind == ShapeKind::kTriangle || kind == ShapeKind::kPolygon) {
    AddPolygon(shapes, placement, kind == ShapeKind::kTriangle ? 3 : 6, extent, gap);
  } else if (kind == ShapeKind::kSphere) {
    shapes.AddSphere(Rounded<double>(placement.center), radius, 0);
  } else {
    shapes.AddCone(Rounded<double>(placement.At({0, -extent, 0})), radius,
                   Rounded<double>(placement.At({0, extent, 0})), radius, 0);
  }
  return shapes;
}

/// A point of the unit shape's upper side.
WideVec RandomPoint(ShapeKind kind, Random& random) {
  if (kind == ShapeKind::kSphere) return random.DirectionAround({0, 0, 1}, 0.2L);
  const long double x = random.Between(-0.3L, 0.3L), y = random.Between(-0.3L, 0.3L);
  return {x, y, kind == ShapeKind::kCone ? std::sqrt(1 - x * x) : 0};
}

/// One shape with what finds its hits.
template <class Real>
struct Alone {
  explicit Alone(Shapes shapes)
      : model(BuildModel<Real>(std::move(shapes))), kernel(MakeKernel("bvh", model)) {}

  Hit<Real> Intersect(const Ray<Real>& ray) const {
    TestCounts tests;
    return kernel->Intersect(ray, tests);
  }

  Model<Real> model;
  std::unique_ptr<Kernel<Real>> kernel;
};

template <class Real>
void TryPlacement(const OffsetRule<Real>& rule, ShapeKind kind, const Placement& placement,
                  int rays, Random& random, OffsetRates& sums) {
  const Alone<Real> surface(MakeShape(kind, placement, 0));
  const Alone<Real> wall(MakeShape(kind, placement, kGap));
  for (int i = 0; i < rays; ++i) {
    const WideVec target = RandomPoint(kind, random);
    const WideVec eye = target + random.DirectionAround({0, 0, 1}, 0.5L) * 3;
    const Ray<Real> ray = RoundedRay<Real>(placement.At(eye), placement.At(target));
    const Hit<Real> hit = surface.Intersect(ray);
    if (hit.object == kNoObject) continue;  // float cannot place so small a shape so far out
    const Vec<Real> point = ray.origin + ray.direction * hit.t;
    Vec<Real> normal = NormalsAt(surface.model, hit, point).face;
    if (Dot(normal, ray.direction) > 0) normal = -normal;
    const WideVec away = random.DirectionAround(Rounded<long double>(normal), 0.1L);
    const Ray<Real> second{rule.start(point, normal, hit.t), Rounded<Real>(away)};
    sums.acne += surface.Intersect(second).object != kNoObject ? 1 : 0;
    sums.leak += wall.Intersect(second).object == kNoObject ? 1 : 0;
  }
}

template <class Real>
void AddRows(std::string_view precision, int rays, std::vector<OffsetRow>& rows) {
  for (const OffsetRule<Real>& rule : OffsetRules<Real>())
    for (int size = -3; size <= 6; ++size)
      for (int distance = -1; distance <= 6; ++distance) {
        const OffsetScene scene{ShapeKind::kTriangle, std::pow(10.0, size),
                                distance < 0 ? 0 : std::pow(10.0, distance)};
        rows.push_back(
            {precision, rule.name, scene.size, scene.distance, TryOffset(rule, scene, rays)});
      }
}

}  // namespace

template <class Real>
std::vector<OffsetRule<Real>> OffsetRules() {
  using Point = Vec<Real>;
  std::vector<OffsetRule<Real>> rules{
      {"none", [](Point point, Point, Real) { return point; }},
      {"fixed",
       [](Point point, Point normal, Real) { return rejected::StartFixed(point, normal); }},
      {"relative", StartRelative<Real>}};
  if constexpr (std::is_same_v<Real, float>)
    rules.push_back({"integer", [](Point point, Point normal, Real) {
                       return rejected::StartByInteger(point, normal);
                     }});
  return rules;
}

template <class Real>
OffsetRates TryOffset(const OffsetRule<Real>& rule, OffsetScene scene, int rays) {
  Random random(1);
  OffsetRates sums;
  for (int i = 0; i < kPlacements; ++i) {
    const auto size = static_cast<long double>(scene.size);
    const WideVec center = random.Direction() * (size * static_cast<long double>(scene.distance));
    const Placement placement{Axes(random.Direction()), center, size};
    TryPlacement(rule, scene.shape, placement, rays / kPlacements, random, sums);
  }
  const int traced = rays / kPlacements * kPlacements;
  return {sums.acne / traced, sums.leak / traced};
}

template std::vector<OffsetRule<float>> OffsetRules();
template std::vector<OffsetRule<double>> OffsetRules();
template OffsetRates TryOffset(const OffsetRule<float>&, OffsetScene, int);
template OffsetRates TryOffset(const OffsetRule<double>&, OffsetScene, int);

std::vector<OffsetRow> OffsetMap(int rays) {
  std::vector<OffsetRow> rows;
  AddRows<float>("float", rays, rows);
  AddRows<double>("double", rays, rows);
  return rows;
}

}  // namespace stipple::raytracer
