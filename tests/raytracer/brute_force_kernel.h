// SPDX-License-Identifier: MIT
// The kernel without a hierarchy: every ray tries every object. What the hierarchy is compared
// with.
#ifndef STIPPLE_TESTS_RAYTRACER_BRUTE_FORCE_KERNEL_H
#define STIPPLE_TESTS_RAYTRACER_BRUTE_FORCE_KERNEL_H

#include <span>
#include <utility>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {

class BruteForceKernel final : public Kernel<double> {
 public:
  explicit BruteForceKernel(Shapes shapes) : shapes_(std::move(shapes)) {}

  Hit<double> Intersect(const Ray<double>& ray, TestCounts& tests) const override {
    const ShearRay<double> shear(ray);
    Hit<double> best;
    for (std::uint32_t number = 0; number < shapes_.objects.size(); ++number) {
      const Hit<double> hit = Try(number, ray, shear, tests);
      if (hit.t < best.t) best = hit;
    }
    return best;
  }

  bool Occluded(const Ray<double>& ray, double max_t, TestCounts& tests) const override {
    const ShearRay<double> shear(ray);
    for (std::uint32_t number = 0; number < shapes_.objects.size(); ++number)
      if (Try(number, ray, shear, tests).t < max_t) return true;
    return false;
  }

 private:
  Hit<double> Try(std::uint32_t number, const Ray<double>& ray, const ShearRay<double>& shear,
                  TestCounts& tests) const {
    ++tests.primitive_tests;
    const Object& object = shapes_.objects[number];
    switch (object.kind) {
      case ShapeKind::kSphere:
        return {IntersectSphere(shapes_.spheres[object.index], ray), number};
      case ShapeKind::kCone:
        return {IntersectCone(shapes_.cones[object.index], ray), number};
      case ShapeKind::kTriangle: {
        const TriangleHit<double> hit = IntersectTriangle(shapes_.triangles[object.index], shear);
        return {hit.t, number, hit.u, hit.v};
      }
      case ShapeKind::kPolygon: {
        const Polygon<double>& polygon = shapes_.polygons[object.index];
        return {IntersectPolygon(
                    polygon,
                    std::span(shapes_.outlines.data() + polygon.first_vertex, polygon.vertex_count),
                    ray),
                number};
      }
      case ShapeKind::kPatch:
        break;  // the scenes have none
    }
    return {};
  }

  Shapes shapes_;
};

}  // namespace stipple::raytracer

#endif
