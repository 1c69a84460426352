// SPDX-License-Identifier: MIT
// How far reflections are followed: to a fixed depth, or as long as they can change a pixel by C.
// Both at 16 rays per pixel, and the truth is the same rays followed to the end, so that the error
// is that of stopping and nothing else. The tree has no mirrors and is left out.
#include <fmt/format.h>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"

namespace stipple::raytracer {
namespace {

constexpr Samples kSamples{16};
constexpr int kToTheEnd = 16;  // what is left after so many halvings is less than a colour's step
constexpr double kCuts[] = {.1, .05, .02, .01};
constexpr double kRecommendedCut = .02;

std::vector<Candidate> CandidatesOf(Session& session, const ReadyScene<double>& ready) {
  const double rays = EyeRays(session.image(), kSamples);
  const auto draw = [&session, &ready](ShadingChoice shading) {
    return [&session, &ready, shading] { return Draw(session, ready, shading, kSamples); };
  };
  std::vector<Candidate> candidates;
  for (int depth = 1; depth <= 5; ++depth)
    candidates.push_back({"depth", fmt::format("D={}", depth), rays, draw({depth, 0})});
  for (const double cut : kCuts)
    candidates.push_back({"contribution", fmt::format("C={:g}", cut), rays, draw({kToTheEnd, cut}),
                          cut == kRecommendedCut});
  candidates.push_back({"contribution", "C=0", rays, draw({kToTheEnd, 0})});
  return candidates;
}

/// What the recommended point takes and loses, against no cut at all.
struct CutGain {
  std::vector<double> time, decibels;
};

void AddScene(Session& session, const ChartScene& scene, ChartTable& table, CutGain& gain) {
  const ReadyScene<double>& ready = session.Ready(scene);
  std::vector<Candidate> candidates = CandidatesOf(session, ready);
  session.progress.Begin(fmt::format("depth, {}", scene.name), RaysOf(session, candidates));
  Measure(session, candidates);
  const Candidate& full = candidates.back();
  for (const Candidate& c : candidates) {
    const double error = RootMeanSquare(c.pixels, full.pixels);
    table.points.push_back(
        {scene.name, c.series, c.label, c.cpu_s, error, c.recommended, {Decibels(error)}});
    if (!c.recommended) continue;
    gain.time.push_back(c.cpu_s / full.cpu_s);
    gain.decibels.push_back(Decibels(error));
  }
}

}  // namespace

ChartTable DepthChart(Session& session) {
  ChartTable table{.name = "depth", .title = "Depth of reflections"};
  table.y.title = "RMS error of a colour, of 1";
  table.more_columns = {"decibels"};
  CutGain gain;
  for (const ChartScene& scene : kChartScenes)
    if (scene.name != std::string_view("tree")) AddScene(session, scene, table, gain);
  table.sentence = fmt::format(
      "Cut rays that can change a pixel by less than C = {:g}: {} dB from the picture without any "
      "cut, for {} of its time.",
      kRecommendedCut, RangeText(gain.decibels), RangeText(gain.time));
  return table;
}

}  // namespace stipple::raytracer
