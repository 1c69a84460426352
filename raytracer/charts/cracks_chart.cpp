// SPDX-License-Identifier: MIT
// Rays that slip through a closed mesh where its triangles meet, by the test that finds triangles,
// against what the test costs. No ray should: the truth is none.
#include <fmt/format.h>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/trials/crack_trial.h"

namespace stipple::raytracer {
namespace {

constexpr double kOffsets[] = {0, 10, 1000};

/// What CPU time a million rays take: each tries the triangles of one edge or vertex.
template <class Real>
void AddTests(const Session& session, std::string_view precision, ChartTable& table) {
  const int rays = session.quick ? 2000 : 200000;
  for (const TriangleTest<Real>& test : TriangleTests<Real>())
    for (const double offset : kOffsets) {
      double least = 0;
      CrackRates rates;
      for (int round = 0; round < session.rounds(); ++round) {
        const double begin = CpuSeconds();
        rates = TryCracks(test, offset, rays);
        const double spent = CpuSeconds() - begin;
        least = round == 0 ? spent : std::min(least, spent);
      }
      const std::string series = fmt::format("{} {}", precision, test.name);
      table.points.push_back({fmt::format("{:g} from the origin", offset),
                              series,
                              series,
                              least,
                              (rates.edges + rates.vertices) / 2,
                              series == "double watertight",
                              {offset, rates.edges, rates.vertices}});
    }
}

double ErrorOf(const ChartTable& table, std::string_view series, double offset) {
  for (const ChartPoint& p : table.points)
    if (p.series == series && p.more[0] == offset) return p.error;
  return kNotMeasured;
}

}  // namespace

ChartTable CracksChart(Session& session) {
  ChartTable table{.name = "cracks", .title = "Rays lost between triangles"};
  table.x.title = "CPU seconds, with the making of the rays";
  table.y.title = "share of rays at edges and vertices that are lost";
  table.more_columns = {"offset", "at_edges", "at_vertices"};
  AddTests<double>(session, "double", table);
  AddTests<float>(session, "float", table);
  std::ranges::stable_sort(table.points, {}, [](const ChartPoint& p) { return p.more[0]; });
  table.sentence = fmt::format(
      "Take the watertight test: it loses {} % of the rays at edges and vertices, in float {} %; "
      "Moeller and Trumbore's loses {} % in double and {} % in float.",
      ShortNumber(100 * ErrorOf(table, "double watertight", 0)),
      ShortNumber(100 * ErrorOf(table, "float watertight", 0)),
      ShortNumber(100 * ErrorOf(table, "double moeller-trumbore", 0)),
      ShortNumber(100 * ErrorOf(table, "float moeller-trumbore", 0)));
  return table;
}

}  // namespace stipple::raytracer
