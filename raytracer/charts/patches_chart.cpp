// SPDX-License-Identifier: MIT
// Bezier patches met directly, or as triangles, coarse to fine. The time is that of building and
// drawing; the truth is the patches met directly in long double, as written to a file. Further
// figures compare the eye rays' hits: distance, normal, and rays that meet the pot in one and not
// in the other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/geometry/surface.h"
#include "raytracer/scene/load.h"
#include "raytracer/scene/patches.h"

namespace stipple::raytracer {
namespace {

constexpr Samples kCorners{};

/// What an eye ray found; t is infinite for nothing.
struct EyeHit {
  double t = 0;
  Vec3 normal{};
};

template <class Real>
std::vector<EyeHit> EyeHits(const ReadyScene<Real>& ready, ImageSize image) {
  const Camera<Real> camera(ready.scene.view, image);
  TestCounts tests;
  std::vector<EyeHit> hits;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Ray<Real> ray = camera.RayThrough(static_cast<Real>(x), static_cast<Real>(y));
      const Hit<Real> hit = ready.kernel->Intersect(ray, tests);
      EyeHit& eye = hits.emplace_back();
      eye.t = static_cast<double>(hit.t);
      if (hit.object == kNoObject) continue;
      const Vec<Real> normal =
          NormalsAt(ready.model, hit, ray.origin + ray.direction * hit.t).shading;
      eye.normal = {static_cast<double>(normal.x), static_cast<double>(normal.y),
                    static_cast<double>(normal.z)};
    }
  return hits;
}

/// Hits of one form against the truth's.
struct HitErrors {
  double mean_t = 0;          // mean difference of distances
  double normal_deg_999 = 0;  // exceeded by one normal in a thousand
  double silhouette = 0;      // share of rays that meet something only in one of both
};

HitErrors ErrorsOf(const std::vector<EyeHit>& hits, const std::vector<EyeHit>& truth) {
  HitErrors errors;
  std::vector<double> angles;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (std::isfinite(hits[i].t) != std::isfinite(truth[i].t)) ++errors.silhouette;
    if (!std::isfinite(hits[i].t) || !std::isfinite(truth[i].t)) continue;
    errors.mean_t += std::abs(hits[i].t - truth[i].t);
    const double cosine = std::clamp(Dot(hits[i].normal, truth[i].normal), -1.0, 1.0);
    angles.push_back(std::acos(cosine) * 180 / std::numbers::pi);
  }
  errors.silhouette /= static_cast<double>(hits.size());
  if (angles.empty()) return errors;
  errors.mean_t /= static_cast<double>(angles.size());
  const auto at = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() * 999 / 1000);
  std::ranges::nth_element(angles, at);
  errors.normal_deg_999 = *at;
  return errors;
}

/// A form of the pot: triangles, or the patches themselves.
struct PotForm {
  int cells;  // per side of a patch; 0: direct
  Scene scene;
};

Scene PotScene(const Session& session, int cells) {
  Scene scene = LoadScene({.scene = "teapot-patches", .size = session.quick ? 4 : 12});
  scene.view.resolution = session.image();
  if (cells > 0) TessellatePatches(scene, cells);
  return scene;
}

std::vector<PotForm> FormsOf(const Session& session, int chosen) {
  std::vector<int> cells{chosen};
  for (int n = 4; n <= (session.quick ? 16 : 128); n *= 2) cells.push_back(n);
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  if (cells.front() != 0) cells.insert(cells.begin(), 0);
  std::vector<PotForm> forms;
  for (const int n : cells) forms.push_back({n, PotScene(session, n)});
  return forms;
}

Candidate CandidateOf(Session& session, const PotForm& form, int chosen) {
  return {form.cells == 0 ? "direct" : "triangles",
          form.cells == 0 ? "direct" : fmt::format("n={}", form.cells),
          EyeRays(session.image(), kCorners),
          [&session, &form] {
            const auto ready = MakeReady<double>(form.scene, "bvh");
            return Draw(session, *ready, ShadingChoice{}, kCorners);
          },
          form.cells == chosen};
}

const ChartPoint* PointNamed(const ChartTable& table, std::string_view label) {
  for (const ChartPoint& p : table.points)
    if (p.label == label) return &p;
  return nullptr;
}

std::string SentenceOf(const ChartTable& table, int chosen) {
  const ChartPoint& taken = *std::ranges::find(table.points, true, &ChartPoint::recommended);
  const ChartPoint& direct = *PointNamed(table, "direct");
  const ChartPoint& finest = table.points.back();
  return fmt::format(
      "Take what --patches auto takes, here {}: {} dB in {} of the time of {}; {} {} dB.",
      chosen == 0 ? "the patches themselves" : fmt::format("{0} x {0} cells a patch", chosen),
      ShortNumber(taken.more[0]), ShortNumber(taken.cpu_s / (chosen == 0 ? finest : direct).cpu_s),
      chosen == 0 ? "the finest triangles" : "meeting patches directly", finest.label + " gives",
      ShortNumber(finest.more[0]));
}

}  // namespace

ChartTable PatchesChart(Session& session) {
  ChartTable table{.name = "patches", .title = "Bezier patches direct or as triangles"};
  table.x.title = "CPU seconds to build and draw";
  table.y.title = "RMS error of a colour, of 1";
  table.more_columns = {"decibels", "mean_t_error", "normal_deg_999", "silhouette_share"};
  const int chosen = ChoosePatches(PotScene(session, 0), "auto").cells;
  const std::vector<PotForm> forms = FormsOf(session, chosen);
  std::vector<Candidate> candidates;
  for (const PotForm& form : forms) candidates.push_back(CandidateOf(session, form, chosen));
  session.progress.Begin("patches", RaysOf(session, candidates));
  Measure(session, candidates);
  const auto truth_scene = MakeReady<long double>(forms.front().scene, "bvh");
  const Pixels truth = AsWritten(Draw(session, *truth_scene, ShadingChoice{}, kCorners));
  const std::vector<EyeHit> true_hits = EyeHits(*truth_scene, session.image());
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const Candidate& c = candidates[i];
    const double error = RootMeanSquare(AsWritten(c.pixels), truth);
    const auto ready = MakeReady<double>(forms[i].scene, "bvh");
    const HitErrors errors = ErrorsOf(EyeHits(*ready, session.image()), true_hits);
    table.points.push_back(
        {"teapot",
         c.series,
         c.label,
         c.cpu_s,
         error,
         c.recommended,
         {Decibels(error), errors.mean_t, errors.normal_deg_999, errors.silhouette}});
  }
  table.sentence = SentenceOf(table, chosen);
  return table;
}

}  // namespace stipple::raytracer
