// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/distance_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "raytracer/charts/rejected/quadric.h"
#include "raytracer/charts/rejected/triangle.h"
#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {
namespace {

constexpr int kPlacements = 100;

/// The value that 99 of 100 do not exceed.
double Percentile99(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Shapes MakeQuadric(Quadric quadric, WideVec center, WideVec axis) {
  Shapes shapes;
  const auto base = Rounded<double>(center - axis), apex = Rounded<double>(center + axis);
  if (quadric == Quadric::kSphere) shapes.AddSphere(Rounded<double>(center), 1, 0);
  if (quadric == Quadric::kCylinder) shapes.AddCone(base, 1, apex, 1, 0);
  if (quadric == Quadric::kCone) shapes.AddCone(base, 1, apex, 0, 0);
  return shapes;
}

template <class Real>
using Intersection = std::function<Real(const Ray<Real>&)>;

/// Of the only shape.
template <class Real>
Intersection<Real> Naive(const Shapes& shapes) {
  if (shapes.cones.empty())
    return [sphere = Converted<Real>(shapes.spheres[0])](const Ray<Real>& ray) {
      return rejected::NaiveSphere(sphere, ray);
    };
  return [cone = Converted<Real>(shapes.cones[0])](const Ray<Real>& ray) {
    return rejected::NaiveCone(cone, ray);
  };
}

template <class Real>
Intersection<Real> OfKernel(std::string_view name, const Model<Real>& model) {
  const std::shared_ptr<Kernel<Real>> kernel = MakeKernel(name, model);
  return [kernel](const Ray<Real>& ray) {
    TestCounts tests;
    return kernel->Intersect(ray, tests).t;
  };
}

Shapes InReal(Shapes shapes, auto real) {
  using Real = decltype(real);
  const auto round = [](Vec3 v) { return Rounded<double>(Rounded<Real>(v)); };
  for (Sphere<double>& sphere : shapes.spheres) sphere.center = round(sphere.center);
  for (Cone<double>& cone : shapes.cones) {
    cone.base = round(cone.base);
    cone.apex = round(cone.apex);
  }
  return shapes;
}

}  // namespace

template <class Real>
DistanceRates TryDistance(Quadric quadric, std::string_view method, double distance, int rays) {
  Random random(1);
  std::vector<double> errors;
  int wrong = 0;
  for (int i = 0; i < kPlacements; ++i) {
    const WideVec center = random.Direction() * static_cast<long double>(distance);
    const Axes across(Normalized(center));
    const Shapes shapes = InReal(MakeQuadric(quadric, center, random.Direction()), Real{});
    const Model<Real> model = BuildModel<Real>(Shapes(shapes));
    const Model<long double> true_model = BuildModel<long double>(Shapes(shapes));
    const auto intersect = method == "naive" ? Naive<Real>(shapes) : OfKernel(method, model);
    const auto true_hit = Naive<long double>(shapes), true_t = OfKernel("scalar", true_model);
    for (int j = 0; j < rays / kPlacements; ++j) {
      const WideVec target =
          across.At({random.Between(-1.5L, 1.5L), random.Between(-1.5L, 1.5L), 0});
      const Ray<Real> ray = RoundedRay<Real>(random.Direction(), center + target);
      // The same line, with a direction whose length is 1 to more digits.
      const WideVec direction = Rounded<long double>(ray.direction);
      const long double length = Length(direction);
      const Ray<long double> line{Rounded<long double>(ray.origin), direction * (1 / length)};
      const Real t = intersect(ray);
      const bool hit = t != kMiss<Real>, truly = true_hit(line) != kMiss<long double>;
      wrong += hit != truly ? 1 : 0;
      if (hit && truly) errors.push_back(static_cast<double>(std::abs(t * length - true_t(line))));
    }
  }
  return {static_cast<double>(wrong) / (rays / kPlacements * kPlacements), Percentile99(errors)};
}

namespace {

/// Volume of the tetrahedron with the ray, six times: its signs tell where a line passes.
template <class Real>
bool Inside(const Triangle<Real>& triangle, WideVec origin, WideVec direction) {
  WideVec c[3];
  for (int i = 0; i < 3; ++i)
    c[i] = WideVec{triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]} - origin;
  const long double a = Dot(direction, Cross(c[0], c[1])), b = Dot(direction, Cross(c[1], c[2])),
                    d = Dot(direction, Cross(c[2], c[0]));
  return (a > 0 && b > 0 && d > 0) || (a < 0 && b < 0 && d < 0);
}

long double PlaneDistance(const Triangle<double>& triangle, WideVec origin, WideVec direction) {
  WideVec c[3];
  for (int i = 0; i < 3; ++i)
    c[i] = {triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]};
  const WideVec normal = Cross(c[1] - c[0], c[2] - c[0]);
  return Dot(normal, c[0] - origin) / Dot(normal, direction);
}

/// A sliver, its corners rounded to `Real`.
template <class Real>
std::array<Vec3, 3> Sliver(double width, Random& random) {
  const Axes frame(random.Direction());
  const auto w = static_cast<long double>(width);
  const auto corner = [&](WideVec local) {
    return Rounded<double>(Rounded<Real>(frame.At(local)));
  };
  return {corner({0, 0, 0}), corner({1, 0, 0}), corner({0.5L, w, 0})};
}

}  // namespace

template <class Real>
SliverRates TrySlivers(std::string_view method, double width, int rays) {
  Random random(1);
  std::vector<double> errors;
  int hits = 0, missed = 0;
  for (int i = 0; i < kPlacements; ++i) {
    const std::array<Vec3, 3> corners = Sliver<Real>(width, random);
    Shapes shapes;
    shapes.AddPolygon(corners, {}, 0);
    const Triangle<double> true_triangle = shapes.triangles[0];
    const Triangle<Real> triangle = Converted<Real>(true_triangle);
    const Model<Real> model = BuildModel<Real>(std::move(shapes));
    const Real smallest =
        method.ends_with("guarded") ? static_cast<Real>(rejected::kSmallDeterminant) : Real{0};
    const Intersection<Real> intersect =
        method.starts_with("moeller")
            ? [&](const Ray<Real>&
                      ray) { return rejected::MoellerTrumbore(triangle, ray, smallest); }
            : OfKernel(method, model);
    for (int j = 0; j < rays / kPlacements; ++j) {
      const long double u = random.Between(0.2L, 0.5L), v = random.Between(0.2L, 0.5L);
      const auto wide = [&](std::size_t k) { return Rounded<long double>(corners[k]); };
      const WideVec target = wide(0) * (1 - u - v) + wide(1) * u + wide(2) * v;
      const WideVec normal = Normalized(Cross(wide(1) - wide(0), wide(2) - wide(0)));
      const Ray<Real> ray = RoundedRay<Real>(target + random.DirectionAround(normal, 0.3L), target);
      const WideVec origin = Rounded<long double>(ray.origin),
                    direction = Rounded<long double>(ray.direction);
      if (!Inside(true_triangle, origin, direction)) continue;
      ++hits;
      const Real t = intersect(ray);
      if (t == kMiss<Real>)
        ++missed;
      else
        errors.push_back(static_cast<double>(std::abs(
            static_cast<long double>(t) - PlaneDistance(true_triangle, origin, direction))));
    }
  }
  return {hits > 0 ? static_cast<double>(missed) / hits : 0, Percentile99(errors)};
}

std::vector<DistanceRow> DistanceRows(int rays) {
  std::vector<DistanceRow> rows;
  constexpr std::pair<Quadric, std::string_view> kQuadrics[] = {
      {Quadric::kSphere, "sphere"}, {Quadric::kCylinder, "cylinder"}, {Quadric::kCone, "cone"}};
  for (const auto& [quadric, name] : kQuadrics)
    for (const std::string_view method : {"naive", "scalar"})
      for (int power = 1; power <= 6; ++power) {
        const double distance = std::pow(10.0, power);
        rows.push_back(
            {"float", method, name, distance, TryDistance<float>(quadric, method, distance, rays)});
        rows.push_back({"double", method, name, distance,
                        TryDistance<double>(quadric, method, distance, rays)});
      }
  return rows;
}

template DistanceRates TryDistance<float>(Quadric, std::string_view, double, int);
template DistanceRates TryDistance<double>(Quadric, std::string_view, double, int);
template SliverRates TrySlivers<float>(std::string_view, double, int);
template SliverRates TrySlivers<double>(std::string_view, double, int);

}  // namespace stipple::raytracer
