// SPDX-License-Identifier: MIT
// The short answer at the end of a run, and the numbers for scripts.
#ifndef STIPPLE_RAYTRACER_REPORT_H
#define STIPPLE_RAYTRACER_REPORT_H

#include <cstdint>
#include <string>
#include <vector>

#include "raytracer/render/divided.h"
#include "raytracer/render/picture.h"
#include "raytracer/render/tracer.h"
#include "raytracer/render/world.h"

namespace stipple::raytracer {

/// What one rank has to say about a run. It travels in messages as it is.
struct RankReport {
  RayCounts counts;
  std::uint64_t messages = 0;
  TravelCounts travel;
  LossBound loss;  // of the picture; nothing on ranks that do not have it
  double load_s = 0, build_s = 0, render_s = 0;
  double build_cpu_s = 0, render_cpu_s = 0;  // of the process, all its threads
};

struct RunReport {
  std::uint64_t objects = 0;
  std::uint64_t model_bytes =
      0;  // of the shapes and their hierarchy, Model's arrays; the most on a rank
  // Of a divided scene; else 0.
  int parts = 0;
  std::uint64_t copies = 0;          // objects in all parts together
  std::optional<Forecast> forecast;  // of a coupled scene
  std::vector<RankReport> ranks;
};

/// On rank 0 the reports of all ranks in order, elsewhere nothing; every rank calls it.
std::vector<RankReport> GatherReports(const World& world, const RankReport& report);

/// JSON with the keys objects model_bytes eye_rays eye_hits shadow_rays shadow_hits reflected_rays
/// refracted_rays box_tests primitive_tests load_s build_s render_s build_cpu_s render_cpu_s
/// messages ranks (integers, seconds; times are the slowest rank's), where objects are divided also
/// parts copies rays_sent packages_sent rays_per_package most_rays_held (on one rank), lost_mean
/// lost_worst (how much brighter pixels could be if every ray had been followed; of 1), and `work`:
/// box and primitive tests of each rank.
std::string StatsJson(const RunReport& report);

/// A headline and a few lines.
std::string Summary(const RunReport& report);

}  // namespace stipple::raytracer

#endif
