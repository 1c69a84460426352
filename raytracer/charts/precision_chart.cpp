// SPDX-License-Identifier: MIT
// Kinds of number and kernels, with the scene at the origin and farther and farther from it. The
// truth is the same program in long double, of the scene at the same place as double holds it.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/moved.h"
#include "raytracer/charts/range_text.h"

namespace stipple::raytracer {
namespace {

constexpr Samples kCorners{};
constexpr ShadingChoice kShading{};
constexpr double kMostOffset = 1e6;

template <class Real>
Candidate CandidateIn(Session& session, std::string series, const Scene& scene,
                      std::string_view kernel, double slowness) {
  const std::shared_ptr<ReadyScene<Real>> ready = MakeReady<Real>(scene, kernel);
  return {std::move(series), "", slowness * EyeRays(session.image(), kCorners),
          [&session, ready] { return Draw(session, *ready, kShading, kCorners); }};
}

/// The first is what the program takes by default, the last is the truth.
std::vector<Candidate> CandidatesOf(Session& session, const Scene& scene) {
  constexpr double kSlow = 3;  // about, of long double
  std::vector<Candidate> candidates;
  candidates.push_back(CandidateIn<double>(session, "double", scene, "bvh", 1));
  candidates.push_back(CandidateIn<double>(session, "double scalar", scene, "scalar", 1));
  candidates.push_back(CandidateIn<float>(session, "float", scene, "bvh", 1));
  candidates.push_back(CandidateIn<double>(session, "Embree", scene, "embree", 1));
  candidates.push_back(CandidateIn<long double>(session, "long double", scene, "bvh", kSlow));
  return candidates;
}

std::vector<double> OffsetsFor(const Session& session) {
  if (session.quick) return {0, 1000, kMostOffset};
  std::vector<double> offsets{0};
  for (double offset = 1; offset <= kMostOffset; offset *= 10) offsets.push_back(offset);
  return offsets;
}

void AddOffset(Session& session, const char* panel, const Scene& scene, double offset,
               ChartTable& table) {
  std::vector<Candidate> candidates = CandidatesOf(session, Moved(scene, {offset, offset, offset}));
  session.progress.Begin(fmt::format("precision, {} at {:g}", panel, offset),
                         RaysOf(session, candidates));
  Measure(session, candidates);
  const Pixels& truth = candidates.back().pixels;
  for (const Candidate& c : candidates)
    table.points.push_back({panel,
                            c.series,
                            fmt::format("{:g}", offset),
                            c.cpu_s,
                            ShareThatDiffers(c.pixels, truth),
                            false,
                            {offset, RootMeanSquare(AsWritten(c.pixels), AsWritten(truth))}});
}

/// The farthest place at which the default's picture of this panel is the truth's.
void Recommend(std::string_view panel, ChartTable& table) {
  ChartPoint* farthest = nullptr;
  for (ChartPoint& p : table.points)
    if (p.panel == panel && p.series == "double" && (farthest == nullptr || p.error == 0))
      farthest = &p;
  farthest->recommended = true;
}

/// CPU time of all scenes at the origin.
double TimeAtOrigin(const ChartTable& table, std::string_view series) {
  double sum = 0;
  for (const ChartPoint& p : table.points)
    if (p.series == series && p.more[0] == 0) sum += p.cpu_s;
  return sum;
}

/// Least and most of a series' errors over the scenes at one offset, as percentages.
std::string PercentAt(const ChartTable& table, std::string_view series, double offset) {
  std::vector<double> percent;
  for (const ChartPoint& p : table.points)
    if (p.series == series && p.more[0] == offset) percent.push_back(100 * p.error);
  return RangeText(percent) + " %";
}

/// The farthest offset at which no picture of a series differs; below 0: there is none.
double EqualUpTo(const ChartTable& table, std::string_view series) {
  double first_different = std::numeric_limits<double>::infinity();
  for (const ChartPoint& p : table.points)
    if (p.series == series && p.error > 0) first_different = std::min(first_different, p.more[0]);
  double farthest = -1;
  for (const ChartPoint& p : table.points)
    if (p.more[0] < first_different) farthest = std::max(farthest, p.more[0]);
  return farthest;
}

std::string SentenceOf(const ChartTable& table) {
  const double time = TimeAtOrigin(table, "double");
  const double equal = EqualUpTo(table, "double");
  return fmt::format(
      "Take double: {} in {} of its time; float takes {} times double's at the origin, where "
      "it changes {} of the pixels, and {} at 1000 from it.",
      equal < 0 ? "nearly long double's picture"
                : fmt::format("long double's picture to the byte up to {} from the origin",
                              ShortNumber(equal)),
      ShortNumber(time / TimeAtOrigin(table, "long double")),
      ShortNumber(TimeAtOrigin(table, "float") / time), PercentAt(table, "float", 0),
      PercentAt(table, "float", 1e3));
}

}  // namespace

ChartTable PrecisionChart(Session& session) {
  ChartTable table{.name = "precision", .title = "Kinds of number and kernels"};
  table.x = {"offset", "distance of the scene from the origin on each axis"};
  table.y.title = "share of pixels that differ from long double's";
  table.more_columns = {"offset", "rms_error"};
  for (const ChartScene& chart_scene : kChartScenes) {
    const Scene scene = session.Load(chart_scene);
    for (const double offset : OffsetsFor(session))
      AddOffset(session, chart_scene.name, scene, offset, table);
    Recommend(chart_scene.name, table);
  }
  table.sentence = SentenceOf(table);
  return table;
}

}  // namespace stipple::raytracer
