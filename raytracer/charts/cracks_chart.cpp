// SPDX-License-Identifier: MIT
// Rays that slip through a closed mesh where its triangles meet, by the test that finds triangles,
// with the mesh at the origin and away from it. No ray should: the truth is none.
#include <fmt/format.h>

#include <algorithm>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/trials/crack_trial.h"

namespace stipple::raytracer {
namespace {

constexpr double kOffsets[] = {0, 10, 1000};
constexpr std::string_view kShipped = "double watertight";

/// CPU time of a million tests of a triangle that the rays hit in half of the cases.
template <class Real>
double SecondsPerMillion(const Session& session, const TriangleTest<Real>& test) {
  const int count = session.quick ? 10000 : 1000000;
  const Triangle<Real> triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, kNoNormals};
  double least = 0;
  for (int round = 0; round < session.rounds(); ++round) {
    const double begin = CpuSeconds();
    Real sum = 0;
    for (int i = 0; i < count; ++i) {
      const Real x = static_cast<Real>(i % 1000) / 1000, y = static_cast<Real>(i % 997) / 997;
      const Real t = test.intersect(triangle, {{x, y, -1}, {0, 0, 1}});
      if (t < 2) sum += t;
    }
    const double spent = CpuSeconds() - begin;
    if (sum < 0) return 0;  // never; but no test may be optimised away
    least = round == 0 ? spent : std::min(least, spent);
  }
  return least * 1e6 / count;
}

template <class Real>
void AddTests(const Session& session, std::string_view precision, ChartTable& table) {
  const int rays = session.quick ? 2000 : 200000;
  for (const TriangleTest<Real>& test : TriangleTests<Real>()) {
    if (test.name.ends_with("guarded")) continue;  // differs from the other on slivers only
    const double cpu_s = SecondsPerMillion(session, test);
    const std::string series = fmt::format("{} {}", precision, test.name);
    for (const double offset : kOffsets) {
      const CrackRates rates = TryCracks(test, offset, rays);
      const bool recommended = series == kShipped && offset == *std::rbegin(kOffsets);
      const std::string label = fmt::format("{:g}", offset);
      table.points.push_back(
          {"rays at edges", series, label, cpu_s, rates.edges, recommended, {offset}});
      table.points.push_back(
          {"rays at vertices", series, label, cpu_s, rates.vertices, recommended, {offset}});
    }
  }
}

/// Least and most of a series, as percentages.
std::string PercentOf(const ChartTable& table, std::string_view series) {
  std::vector<double> percent;
  for (const ChartPoint& p : table.points)
    if (p.series == series) percent.push_back(100 * p.error);
  return RangeText(percent) + " %";
}

double CpuOf(const ChartTable& table, std::string_view series) {
  return std::ranges::find(table.points, series, &ChartPoint::series)->cpu_s;
}

}  // namespace

ChartTable CracksChart(Session& session) {
  ChartTable table{.name = "cracks", .title = "Rays lost between triangles"};
  table.x = {"offset", "distance of the mesh from the origin on each axis, in radii"};
  table.y.title = "share of the rays that are lost; CPU: of a million tests";
  table.more_columns = {"offset"};
  AddTests<double>(session, "double", table);
  AddTests<float>(session, "float", table);
  table.sentence = fmt::format(
      "Take the watertight test: it loses {} of the rays along edges and through vertices, in "
      "float {}; that of Moeller and Trumbore {} in double, for {} of the time.",
      PercentOf(table, kShipped), PercentOf(table, "float watertight"),
      PercentOf(table, "double moeller-trumbore"),
      ShortNumber(CpuOf(table, "double moeller-trumbore") / CpuOf(table, kShipped)));
  return table;
}

}  // namespace stipple::raytracer
