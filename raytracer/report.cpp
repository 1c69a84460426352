// SPDX-License-Identifier: MIT
#include "raytracer/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>

namespace stipple::raytracer {
namespace {

static_assert(std::is_trivially_copyable_v<RankReport>);

struct CountRow {
  std::string_view key;
  std::uint64_t (*value)(const RankReport& report);
};
constexpr CountRow kCounts[] = {
    {"eye_rays", [](const RankReport& r) { return r.counts.eye_rays; }},
    {"eye_hits", [](const RankReport& r) { return r.counts.eye_hits; }},
    {"shadow_rays", [](const RankReport& r) { return r.counts.shadow_rays; }},
    {"shadow_hits", [](const RankReport& r) { return r.counts.shadow_hits; }},
    {"reflected_rays", [](const RankReport& r) { return r.counts.reflected_rays; }},
    {"refracted_rays", [](const RankReport& r) { return r.counts.refracted_rays; }},
    {"box_tests", [](const RankReport& r) { return r.counts.tests.box_tests; }},
    {"primitive_tests", [](const RankReport& r) { return r.counts.tests.primitive_tests; }},
    {"repeated_tests", [](const RankReport& r) { return r.counts.repeated_tests; }},
    {"messages", [](const RankReport& r) { return r.messages; }},
};

struct TimeRow {
  std::string_view key;
  double RankReport::*seconds;
};
constexpr TimeRow kTimes[] = {{"load_s", &RankReport::load_s},
                              {"build_s", &RankReport::build_s},
                              {"render_s", &RankReport::render_s},
                              {"build_cpu_s", &RankReport::build_cpu_s},
                              {"render_cpu_s", &RankReport::render_cpu_s}};

std::uint64_t Sum(const RunReport& report, std::uint64_t (*value)(const RankReport&)) {
  std::uint64_t sum = 0;
  for (const RankReport& rank : report.ranks) sum += value(rank);
  return sum;
}

double Slowest(const RunReport& report, double RankReport::*seconds) {
  double slowest = 0;
  for (const RankReport& rank : report.ranks) slowest = std::max(slowest, rank.*seconds);
  return slowest;
}

std::uint64_t WorkOf(const RankReport& report) { return report.counts.Work(); }

/// Only one rank has the picture.
LossBound LossIn(const RunReport& report) {
  return std::ranges::max(report.ranks, {}, [](const RankReport& r) { return r.loss.worst; }).loss;
}

std::string CountLines(const RunReport& report, std::uint64_t rays) {
  RayCounts sum;
  std::uint64_t messages = 0;
  for (const RankReport& rank : report.ranks) {
    sum.eye_rays += rank.counts.eye_rays;
    sum.eye_hits += rank.counts.eye_hits;
    sum.shadow_rays += rank.counts.shadow_rays;
    sum.shadow_hits += rank.counts.shadow_hits;
    sum.reflected_rays += rank.counts.reflected_rays;
    sum.refracted_rays += rank.counts.refracted_rays;
    sum.tests.box_tests += rank.counts.tests.box_tests;
    sum.tests.primitive_tests += rank.counts.tests.primitive_tests;
    messages += rank.messages;
  }
  const auto per_ray = [&](std::uint64_t tests) {
    return static_cast<double>(tests) / static_cast<double>(std::max<std::uint64_t>(rays, 1));
  };
  const auto slowest = [&](double RankReport::*seconds) { return Slowest(report, seconds); };
  return fmt::format(
      "  rays: {} eye ({} met an object), {} shadow ({} in shadow), {} reflected, {} refracted\n"
      "  tests per ray: {:.1f} boxes, {:.1f} primitives\n"
      "  seconds: {:.3f} to load, {:.3f} to build, {:.3f} to render; CPU {:.3f} and {:.3f}\n"
      "  memory for objects: {:.1f} MB; messages: {}\n",
      sum.eye_rays, sum.eye_hits, sum.shadow_rays, sum.shadow_hits, sum.reflected_rays,
      sum.refracted_rays, per_ray(sum.tests.box_tests), per_ray(sum.tests.primitive_tests),
      slowest(&RankReport::load_s), slowest(&RankReport::build_s), slowest(&RankReport::render_s),
      slowest(&RankReport::build_cpu_s), slowest(&RankReport::render_cpu_s),
      static_cast<double>(report.model_bytes) * 1e-6, messages);
}

/// Rays that travelled, over all ranks; of `most_held` the largest.
TravelCounts TravelOf(const RunReport& report) {
  TravelCounts sum;
  for (const RankReport& rank : report.ranks) {
    sum.rays_sent += rank.travel.rays_sent;
    sum.packages_sent += rank.travel.packages_sent;
    sum.most_held = std::max(sum.most_held, rank.travel.most_held);
  }
  return sum;
}

double RaysPerPackage(const TravelCounts& travel) {
  return static_cast<double>(travel.rays_sent) /
         static_cast<double>(std::max<std::uint64_t>(travel.packages_sent, 1));
}

std::string TravelLine(const RunReport& report, std::uint64_t rays) {
  if (report.parts == 0) return "";
  const TravelCounts travel = TravelOf(report);
  return fmt::format(
      "  objects in {} parts, {} with their copies; {:.2f} journeys per ray, {:.1f} rays per "
      "package, at "
      "most "
      "{} rays on a rank\n",
      report.parts, report.copies,
      static_cast<double>(travel.rays_sent) / static_cast<double>(std::max<std::uint64_t>(rays, 1)),
      RaysPerPackage(travel), travel.most_held);
}

}  // namespace

std::vector<RankReport> GatherReports(const World& world, const RankReport& report) {
  std::vector<RankReport> all(world.rank == 0 ? static_cast<std::size_t>(world.size) : 0);
  MPI_Gather(&report, sizeof report, MPI_BYTE, all.data(), sizeof report, MPI_BYTE, 0, world.comm);
  return all;
}

std::string StatsJson(const RunReport& report) {
  nlohmann::ordered_json json;
  json["objects"] = report.objects;
  json["model_bytes"] = report.model_bytes;
  json["ranks"] = report.ranks.size();
  for (const CountRow& row : kCounts) json[std::string(row.key)] = Sum(report, row.value);
  for (const TimeRow& row : kTimes) json[std::string(row.key)] = Slowest(report, row.seconds);
  if (report.parts > 0) {
    const TravelCounts travel = TravelOf(report);
    json["parts"] = report.parts;
    json["copies"] = report.copies;
    json["rays_sent"] = travel.rays_sent;
    json["packages_sent"] = travel.packages_sent;
    json["rays_per_package"] = RaysPerPackage(travel);
    json["most_rays_held"] = travel.most_held;
    if (report.forecast) {
      json["predicted_balance"] = report.forecast->balance;
      json["predicted_journeys"] = report.forecast->journeys;
    }
  }
  const LossBound loss = LossIn(report);
  json["lost_mean"] = loss.mean;
  json["lost_worst"] = loss.worst;
  for (const RankReport& rank : report.ranks) json["work"].push_back(WorkOf(rank));
  return json.dump(2) + "\n";
}

std::string Summary(const RunReport& report) {
  const double seconds = Slowest(report, &RankReport::render_s);
  const std::uint64_t rays = Sum(report, [](const RankReport& r) { return r.counts.Rays(); });
  const auto tracing = static_cast<double>(std::ranges::count_if(
      report.ranks, [](const RankReport& r) { return r.counts.eye_rays > 0; }));
  std::uint64_t most = 0;
  for (const RankReport& rank : report.ranks) most = std::max(most, WorkOf(rank));
  const auto work = static_cast<double>(Sum(report, WorkOf));
  std::string text = fmt::format(
      "{} rays through {} objects in {:.3f} s on {} {}: {:.2f} million rays per second.\n", rays,
      report.objects, seconds, report.ranks.size(), report.ranks.size() == 1 ? "rank" : "ranks",
      seconds > 0 ? static_cast<double>(rays) / seconds * 1e-6 : 0.0);
  text += CountLines(report, rays);
  text += TravelLine(report, rays);
  const LossBound loss = LossIn(report);
  text += loss.worst > 0
              ? fmt::format(
                    "  rays not followed could have added at most {:.2g} of a pixel's range "
                    "on average, {:.2g} at the worst pixel\n",
                    loss.mean, loss.worst)
              : "  every ray was followed to its end\n";
  if (tracing > 1 && work > 0) {
    text += fmt::format("  work of the busiest tracing rank over the mean: {:.2f}",
                        static_cast<double>(most) * tracing / work);
    if (report.forecast)
      text += fmt::format("; the pilot foretold {:.2f}, and {:.2f} journeys per ray",
                          report.forecast->balance, report.forecast->journeys);
    text += "\n";
  }
  return text;
}

}  // namespace stipple::raytracer
