// SPDX-License-Identifier: MIT
#include "raytracer/scene/check.h"

#include <algorithm>
#include <cmath>

namespace stipple::raytracer {
namespace {

constexpr double kSmallest = 1e-30;  // its square and cube are still normal numbers
constexpr double kSmallestOfDistance = 1e-12;
constexpr double kThinnest = 1e-12;     // area over the square of the extent
constexpr double kOffPlane = 0.01;      // of the extent
constexpr double kSixDigits = 1e-5;     // of the distance from the origin: rounding to six digits
constexpr double kSmallestSine = 1e-9;  // of the angle between sight and up
constexpr double kBrightest = 1000;

bool TooSmall(double size, Vec3 place) {
  return !(std::abs(size) >= std::max(kSmallest, kSmallestOfDistance * MaxNorm(place)));
}

bool Within(double low, double value, double high) { return value >= low && value <= high; }

bool IsColor(Vec3 color) {
  return Within(0, color.x, kBrightest) && Within(0, color.y, kBrightest) &&
         Within(0, color.z, kBrightest);
}

/// How far the points reach from the first, along the axis where they reach farthest.
double Extent(std::span<const Vec3> points) {
  double extent = 0;
  for (const Vec3& point : points) extent = std::max(extent, MaxNorm(point - points[0]));
  return extent;
}

}  // namespace

std::string_view ProblemOf(const View& view) {
  const Vec3 forward = view.at - view.from;
  if (TooSmall(MaxNorm(forward), view.from)) return "the view's 'from' and 'at' are the same point";
  const double up = MaxNorm(view.up);
  if (!(up >= kSmallest) ||
      !(Length(Cross(Normalized(forward), Normalized(view.up))) > kSmallestSine))
    return "the view's 'up' is zero or points along the line of sight";
  if (!(view.angle_deg >= 1e-6 && view.angle_deg < 180))
    return "the view's 'angle' should be at least 1e-6 and below 180 degrees";
  return "";
}

std::string_view ProblemOf(const Material& m) {
  if (!IsColor(m.color)) return "the fill's colour should be from 0 to 1000";
  if (!Within(0, m.diffuse, kBrightest)) return "the fill's Kd should be from 0 to 1000";
  if (!Within(0, m.specular, 1)) return "the fill's Ks should be from 0 to 1";
  if (m.shine < 0) return "the fill's shine should not be negative";
  if (!Within(0, m.transmission, 1)) return "the fill's T should be from 0 to 1";
  if (m.transmission > 0 && !(m.refraction >= kSmallest))
    return "a fill that lets light through needs an index of refraction above 0";
  return "";
}

std::string_view ProblemOf(const Light& light) {
  if (!IsColor(light.color)) return "the light's colour should be from 0 to 1000";
  if (light.radius < 0) return "the light's radius should not be negative";
  return "";
}

std::string_view ProblemOfSphere(Vec3 center, double radius) {
  if (radius == 0) return "sphere of radius 0";
  if (TooSmall(radius, center)) return "sphere too small for its place";
  return "";
}

std::string_view ProblemOfCone(Vec3 base, double base_radius, Vec3 apex, double apex_radius) {
  if (base == apex) return "the cone's base and apex coincide";
  if (TooSmall(MaxNorm(apex - base), base)) return "cone too short for its place";
  if (base_radius == 0 && apex_radius == 0) return "cone of radius 0 at both ends";
  if ((base_radius < 0 && apex_radius > 0) || (base_radius > 0 && apex_radius < 0))
    return "the cone's radii have different signs";
  if (TooSmall(std::max(std::abs(base_radius), std::abs(apex_radius)), base))
    return "cone too thin for its place";
  return "";
}

std::string_view ProblemOfPatch(std::span<const Vec3, 16> control) {
  const double extent = Extent(control);
  if (TooSmall(extent, control[0])) return "patch too small for its place";
  for (const Vec3& a : control)
    for (const Vec3& b : control)
      if (MaxNorm(Cross(a - control[0], b - control[0])) > kThinnest * extent * extent) return "";
  return "patch of zero area";
}

std::string_view ProblemOfPolygon(std::span<const Vec3> vertices) {
  const double extent = Extent(vertices);
  if (extent == 0) return "polygon of zero area";
  if (TooSmall(extent, vertices[0])) return "polygon too small for its place";
  const Vec3 normal = NewellNormal(vertices);
  if (!(Length(normal) > kThinnest * extent * extent)) return "polygon of zero area";
  if (vertices.size() == 3) return "";
  const Vec3 direction = Normalized(normal);
  const double allowed = kOffPlane * extent + kSixDigits * MaxNorm(vertices[0]);
  for (const Vec3& vertex : vertices)
    if (std::abs(Dot(direction, vertex - vertices[0])) > allowed)
      return "the polygon's corners do not lie in one plane";
  return "";
}

}  // namespace stipple::raytracer
