// SPDX-License-Identifier: MIT
// Row B: rays at the edges and vertices that triangles share.
//
// Each triangle is a test of its own, so that a ray along a shared edge may be outside both by
// rounding, and pass through a closed surface. Woop's test computes an edge's sign from the same
// numbers for both triangles. And the boxes around them have to be as generous as the test: a
// kernel in float whose boxes were exact lost 2.5 % of the rays at vertices.
//
// Rays are aimed as near at the edge as the kind of number allows, so that double fails as often as
// float: it is no cure.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/crack_trial.h"

namespace stipple::raytracer {
namespace {

constexpr int kRays = 34000;  // at edges, and as many at vertices: 2e5 over three offsets
constexpr double kOffsets[] = {0, 10, 1000};

template <class Real>
void CheckTests() {
  for (const TriangleTest<Real>& test : TriangleTests<Real>()) {
    const CrackRates rates = TryCracks(test, 10, kRays);
    if (test.name == "watertight") {
      EXPECT_EQ(rates.edges, 0);
      EXPECT_EQ(rates.vertices, 0);
    } else {
      EXPECT_GT(rates.edges, 0.05) << test.name;
      EXPECT_GT(rates.vertices, 0.05) << test.name;
    }
  }
}

TEST(Cracks, MoellerTrumboreHasThemAndTheWatertightTestHasNone) {
  CheckTests<float>();
  CheckTests<double>();
}

template <class Real>
void CheckKernel(std::string_view name) {
  for (const double offset : kOffsets) {
    const CrackRates rates = TryCracks<Real>(name, offset, kRays);
    EXPECT_EQ(rates.edges, 0) << name << ' ' << sizeof(Real) << ' ' << offset;
    EXPECT_EQ(rates.vertices, 0) << name << ' ' << sizeof(Real) << ' ' << offset;
  }
}

TEST(Cracks, KernelsHaveNone) {
  CheckKernel<float>("bvh");
  CheckKernel<double>("bvh");
  CheckKernel<double>("scalar");
}

}  // namespace
}  // namespace stipple::raytracer
