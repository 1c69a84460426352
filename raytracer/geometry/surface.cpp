// SPDX-License-Identifier: MIT
#include "raytracer/geometry/surface.h"

#include "raytracer/geometry/patch.h"

namespace stipple::raytracer {
namespace {

template <class Real>
Vec<Real> ConeNormal(const Cone<Real>& cone, Vec<Real> point) {
  const Vec<Real> from_base = point - cone.base;
  const Real along = Dot(from_base, cone.axis);
  const Vec<Real> across = from_base - cone.axis * along;
  const Real slope = SlopeOf(cone);
  const Real radius = std::abs(cone.base_radius + slope * along);
  const Real sign = cone.base_radius < 0 || cone.apex_radius < 0 ? -1 : 1;
  // At the very tip there is no direction across; the axis is as good as any.
  const Vec<Real> normal = across - cone.axis * (sign * slope * radius);
  const Real length = Length(normal);
  return length > 0 ? normal * (sign / length) : cone.axis * sign;
}

/// Weights of all vertices that vary smoothly over any outline: mean value coordinates, in the
/// tangent form. Source: M. Floater, "Mean value coordinates", Computer Aided Geometric Design
/// 20(1), 2003.
template <class Real>
Vec<Real> PolygonShading(const Model<Real>& model, const Polygon<Real>& polygon, Vec<Real> point) {
  const auto vertex = [&](std::uint32_t i) {
    return model.vertices[polygon.first_vertex + i % polygon.vertex_count];
  };
  const auto half_tangent =
      [&](std::uint32_t i) {  // of the angle at `point` between vertices i and i + 1
        const Vec<Real> a = vertex(i) - point, b = vertex(i + 1) - point;
        const Real sine = Dot(Cross(a, b), polygon.normal);
        return (Length(a) * Length(b) - Dot(a, b)) /
               (sine != 0 ? sine : std::numeric_limits<Real>::min());
      };
  Vec<Real> sum;
  for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
    const Vec<Real> normal = model.normals[polygon.first_normal + i];
    const Real distance = Length(vertex(i) - point);
    if (distance == 0) return normal;
    const Real weight = (half_tangent(i + polygon.vertex_count - 1) + half_tangent(i)) / distance;
    sum = sum + normal * weight;
  }
  const Real length = Length(sum);
  return length > 0 && std::isfinite(length) ? sum * (1 / length) : polygon.normal;
}

template <class Real>
Normals<Real> TriangleNormals(const Model<Real>& model, const Triangle<Real>& t,
                              const Hit<Real>& hit) {
  const auto corner = [&](int i) {
    return Vec<Real>{t.corner[i][0], t.corner[i][1], t.corner[i][2]};
  };
  const Vec<Real> face = Normalized(Cross(corner(1) - corner(0), corner(2) - corner(0)));
  if (t.first_normal == kNoNormals) return {face, face};
  const Vec<Real>* const n = model.normals.data() + t.first_normal;
  const Vec<Real> blend = n[0] * (1 - hit.u - hit.v) + n[1] * hit.u + n[2] * hit.v;
  const Real length = Length(blend);
  if (!(length > 0)) return {face, face};
  // The vertex normals say which side is outside, whatever the order of the corners.
  return {Dot(face, blend) < 0 ? -face : face, blend * (1 / length)};
}

}  // namespace

template <class Real>
Normals<Real> NormalsAt(const Model<Real>& model, const Hit<Real>& hit, Vec<Real> point) {
  const Object& object = model.objects[hit.object];
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<Real> sphere = model.SphereAt(object.index);
      const Vec<Real> normal =
          Normalized(sphere.radius < 0 ? sphere.center - point : point - sphere.center);
      return {normal, normal};
    }
    case ShapeKind::kCone: {
      const Vec<Real> normal = ConeNormal(model.ConeAt(object.index), point);
      return {normal, normal};
    }
    case ShapeKind::kTriangle:
      return TriangleNormals(model, model.TriangleAt(object.index), hit);
    case ShapeKind::kPatch: {
      const Vec<Real> normal =
          PointOn(model.patches[object.index], Parameter<Real>(hit.u), Parameter<Real>(hit.v))
              .normal;
      return {normal, normal};
    }
    case ShapeKind::kPolygon: {
      const Polygon<Real> polygon = model.PolygonAt(object.index);
      if (polygon.first_normal == kNoNormals) return {polygon.normal, polygon.normal};
      const Vec<Real> shading = PolygonShading(model, polygon, point);
      return {Dot(polygon.normal, shading) < 0 ? -polygon.normal : polygon.normal, shading};
    }
  }
  return {};
}

template Normals<float> NormalsAt(const Model<float>&, const Hit<float>&, Vec<float>);
template Normals<double> NormalsAt(const Model<double>&, const Hit<double>&, Vec<double>);
template Normals<long double> NormalsAt(const Model<long double>&, const Hit<long double>&,
                                        Vec<long double>);

}  // namespace stipple::raytracer
