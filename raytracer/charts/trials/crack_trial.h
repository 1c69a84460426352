// SPDX-License-Identifier: MIT
// How many rays slip through a closed mesh along the edges and corners that its triangles share.
#ifndef STIPPLE_RAYTRACER_CHARTS_TRIALS_CRACK_TRIAL_H
#define STIPPLE_RAYTRACER_CHARTS_TRIALS_CRACK_TRIAL_H

#include <string_view>
#include <vector>

#include "raytracer/geometry/intersect.h"
#include "raytracer/geometry/shapes.h"

namespace stipple::raytracer {

/// A ray/triangle intersection: distance or infinity.
template <class Real>
struct TriangleTest {
  std::string_view name;
  Real (*intersect)(const Triangle<Real>& triangle, const Ray<Real>& ray);
};

/// "moeller-trumbore", "moeller-trumbore guarded" (small determinants are misses) and "watertight",
/// the shipped one.
template <class Real>
std::vector<TriangleTest<Real>> TriangleTests();

/// Parts of the rays at edges and at vertices that pass between the triangles there.
struct CrackRates {
  double edges = 0;
  double vertices = 0;
};

/// The mesh is an icosahedron divided to 320 triangles on the unit sphere around (offset, offset,
/// offset), as `Real` holds it; rays come from 5 away.
template <class Real>
CrackRates TryCracks(const TriangleTest<Real>& test, double offset, int rays);

/// The same rays through the whole kernel of a name of --kernel: what it misses or finds only on
/// the mesh's far side.
template <class Real>
CrackRates TryCracks(std::string_view kernel, double offset, int rays);

/// A row of the chart.
struct CrackRow {
  std::string_view precision, test;
  double offset;
  CrackRates rates;
};

/// Each test at the origin and at offsets of 10 and 1000, of float and of double.
std::vector<CrackRow> CrackRows(int rays);

}  // namespace stipple::raytracer

#endif
