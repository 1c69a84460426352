// SPDX-License-Identifier: MIT
// Rays per pixel, and where they go. The truth is 1024 stratified rays per pixel: its own noise is
// less than half of that of 256.
#include <fmt/format.h>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/jittered.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"

namespace stipple::raytracer {
namespace {

constexpr ShadingChoice kShading{};  // SPD's depth, nothing cut off

struct SamplingEffort {
  int truth;
  int most_across;           // rays per pixel are squares of 1, 2, 4, ... this
  int most_across_jittered;  // which are for comparison only
};
SamplingEffort EffortOf(const Session& session) {
  return session.quick ? SamplingEffort{100, 4, 4} : SamplingEffort{1024, 16, 8};
}

std::vector<Candidate> CandidatesOf(Session& session, const ReadyScene<double>& ready) {
  const ImageSize image = session.image();
  const auto own = [&session, &ready, image](std::string series, std::string label,
                                             Samples samples) {
    return Candidate{
        std::move(series), std::move(label), EyeRays(image, samples),
        [&session, &ready, samples] { return Draw(session, ready, kShading, samples); }};
  };
  std::vector<Candidate> candidates{own("corners", "corners", Samples{})};
  candidates.back().recommended = true;
  const SamplingEffort effort = EffortOf(session);
  for (int across = 1; across <= effort.most_across; across *= 2) {
    const Samples samples{.per_pixel = across * across};
    candidates.push_back(own("stratified", std::to_string(samples.per_pixel), samples));
    if (across > effort.most_across_jittered) continue;
    candidates.push_back({"jittered", std::to_string(samples.per_pixel), EyeRays(image, samples),
                          [&session, &ready, image, samples, across] {
                            JitteredSampler sampler(ready, kShading, image, across);
                            return Draw(session, sampler, image, samples);
                          }});
  }
  for (const double tolerance : {0.004, 0.002, 0.001, 0.0005, 0.00025})
    candidates.push_back(own("adaptive", fmt::format("E {}", tolerance),
                             Samples{.adaptive = true, .tolerance = tolerance}));
  return candidates;
}

void AddScene(Session& session, const ChartScene& scene, ChartTable& table) {
  const ReadyScene<double>& ready = session.Ready(scene);
  std::vector<Candidate> candidates = CandidatesOf(session, ready);
  const Samples truth_samples{.per_pixel = EffortOf(session).truth};
  session.progress.Begin(fmt::format("sampling, {}", scene.name),
                         EyeRays(session.image(), truth_samples) + RaysOf(session, candidates));
  const Pixels truth = Draw(session, ready, kShading, truth_samples);
  Measure(session, candidates);
  for (const Candidate& c : candidates) {
    const double error = RootMeanSquare(c.pixels, truth);
    table.points.push_back({scene.name,
                            c.series,
                            c.label,
                            c.cpu_s,
                            error,
                            c.recommended,
                            {c.pixels.eye_rays, Decibels(error)}});
  }
}

/// What the sentence says of one scene.
struct CornersGain {
  double same_error_time;  // of stratified rays with the corners' error, over the corners' time
  double error_of_16, time_of_16;  // over the corners'
  double adaptive_time;            // of stratified rays with adaptive's error, over its time
};

CornersGain GainOf(const ChartTable& table, std::string_view scene) {
  CostAndError corners{}, sixteen{}, adaptive{};
  std::vector<CostAndError> stratified;
  for (const ChartPoint& p : table.points) {
    if (p.panel != scene) continue;
    if (p.series == "corners") corners = {p.cpu_s, p.error};
    if (p.series == "adaptive" && p.label == "E 0.001") adaptive = {p.cpu_s, p.error};
    if (p.series == "stratified") stratified.push_back({p.cpu_s, p.error});
    if (p.series == "stratified" && p.label == "16") sixteen = stratified.back();
  }
  return {CostAtError(stratified, corners.error) / corners.cpu_s, sixteen.error / corners.error,
          sixteen.cpu_s / corners.cpu_s, CostAtError(stratified, adaptive.error) / adaptive.cpu_s};
}

std::string SentenceOf(const ChartTable& table) {
  std::vector<double> same_error_time, error_of_16, time_of_16, adaptive_time;
  for (const ChartScene& scene : kChartScenes) {
    const CornersGain gain = GainOf(table, scene.name);
    same_error_time.push_back(gain.same_error_time);
    error_of_16.push_back(gain.error_of_16);
    time_of_16.push_back(gain.time_of_16);
    adaptive_time.push_back(gain.adaptive_time);
  }
  return fmt::format(
      "Take corners, one ray a pixel: stratified rays need {} times the time for the same error; "
      "for a better picture take 16 of them, {} of the error for {} times the time, or adaptive "
      "ones, whose error stratified rays reach in {} times their time.",
      RangeText(same_error_time), RangeText(error_of_16), RangeText(time_of_16),
      RangeText(adaptive_time));
}

}  // namespace

ChartTable SamplingChart(Session& session) {
  ChartTable table{.name = "sampling", .title = "Rays per pixel", .quiet = "jittered"};
  table.y.title = "RMS error of a colour, of 1";
  table.more_columns = {"eye_rays", "decibels"};
  for (const ChartScene& scene : kChartScenes) AddScene(session, scene, table);
  table.sentence = SentenceOf(table);
  return table;
}

}  // namespace stipple::raytracer
