// SPDX-License-Identifier: MIT
// Rays asked one by one, or in packets of 8 and 16, by the kind of ray: those of a picture through
// the corners of its pixels, recorded and asked again. Embree is given them in double as the own
// kernel is, so its time holds their conversion. The truth is the same rays in long double.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/ray_recorder.h"
#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/embree_kernel.h"

namespace stipple::raytracer {
namespace {

constexpr double kTolerance = 1e-5;  // relative, of distances: a hundred roundings of float
constexpr const char* kKindNames[kRayKinds] = {"eye rays", "shadow rays", "reflected rays"};

/// Rays that are neighbours in a small picture are no neighbours.
ImageSize ImageFor(const Session& session) {
  return session.quick ? session.image() : ImageSize{512, 512};
}

struct Answers {
  std::vector<Hit<double>> hits;     // of rays that look for the nearest object
  std::vector<std::uint8_t> hidden;  // of shadow rays
};

Answers RoomFor(const RayList& list, RayKind kind) {
  Answers answers;
  if (kind == RayKind::kShadow)
    answers.hidden.resize(list.rays.size());
  else
    answers.hits.resize(list.rays.size());
  return answers;
}

/// A way to answer rays, and what came of it.
struct Method {
  std::string series, label;
  std::function<void(const RayList&, RayKind, Answers&)> answer;
  double cpu_s = 0;  // least time of all rays
  double error = 0;  // share of the rays with another answer than the truth
};

template <class Real>
void AnswerSingly(const Kernel<Real>& kernel, const RayList& list, RayKind kind, Answers& answers) {
  TestCounts tests;
  for (std::size_t i = 0; i < list.rays.size(); ++i) {
    const Ray<Real> ray{Converted<Real>(list.rays[i].origin),
                        Converted<Real>(list.rays[i].direction)};
    if (kind == RayKind::kShadow) {
      answers.hidden[i] = kernel.Occluded(ray, static_cast<Real>(list.max_t[i]), tests) ? 1 : 0;
    } else {
      const Hit<Real> hit = kernel.Intersect(ray, tests);
      answers.hits[i] = {static_cast<double>(hit.t), hit.object, static_cast<double>(hit.u),
                         static_cast<double>(hit.v)};
    }
  }
}

Method Single(std::string series, std::string label, std::string_view kernel_name,
              const Model<double>& model) {
  const std::shared_ptr<Kernel<double>> kernel = MakeKernel(kernel_name, model);
  return {std::move(series), std::move(label),
          [kernel](const RayList& list, RayKind kind, Answers& answers) {
            AnswerSingly(*kernel, list, kind, answers);
          }};
}

Method InPackets(int width, RayKind kind_of_ray, const Model<double>& model) {
  const std::shared_ptr<EmbreePackets> packets =
      MakeEmbreePackets(model, width, kind_of_ray == RayKind::kEye);
  return {"Embree", fmt::format("{}", width),
          [packets](const RayList& list, RayKind kind, Answers& answers) {
            if (kind == RayKind::kShadow)
              packets->Occluded(list.rays, list.max_t, answers.hidden);
            else
              packets->Intersect(list.rays, answers.hits);
          }};
}

/// In the order that SentenceOf relies on; the first is what the program takes by default.
enum MethodNumber : std::size_t { kOwn, kScalar, kEmbree, kEight, kSixteen };

std::vector<Method> MethodsFor(RayKind kind, const Model<double>& model) {
  return {Single("own", "own", "bvh", model), Single("own", "scalar", "scalar", model),
          Single("Embree", "1", "embree", model), InPackets(8, kind, model),
          InPackets(16, kind, model)};
}

bool SameHit(const Hit<double>& a, const Hit<double>& b) {
  if (a.object != b.object) return false;
  return a.object == kNoObject || std::abs(a.t - b.t) <= kTolerance * b.t;
}

double ShareOfOthers(const Answers& answers, const Answers& truth) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < truth.hits.size(); ++i)
    others += SameHit(answers.hits[i], truth.hits[i]) ? 0 : 1;
  for (std::size_t i = 0; i < truth.hidden.size(); ++i)
    others += answers.hidden[i] == truth.hidden[i] ? 0 : 1;
  return static_cast<double>(others) / static_cast<double>(truth.hits.size() + truth.hidden.size());
}

/// The methods in turn, round after round, as Measure does with pictures.
void MeasureMethods(Session& session, const RayList& list, RayKind kind, const Answers& truth,
                    std::vector<Method>& methods) {
  Answers answers = RoomFor(list, kind);
  for (int round = 0; round < session.rounds(); ++round)
    for (Method& method : methods) {
      const double begin = CpuSeconds();
      method.answer(list, kind, answers);
      const double spent = CpuSeconds() - begin;
      method.cpu_s = round == 0 ? spent : std::min(method.cpu_s, spent);
      if (round == 0) method.error = ShareOfOthers(answers, truth);
      session.progress.Advance(1);
    }
}

/// What the sentence tells. Of packets the better width counts.
struct Gains {
  std::vector<double> of_packets[kRayKinds];  // Embree's rays one by one, over packets
  std::vector<double> own_over_packets;       // all rays of a picture
  std::vector<double> own_over_single;
  double own_error = 0, embree_error = 0;  // the largest of any panel
};

/// Times of all rays of one picture.
struct PictureTimes {
  double own = 0, single = 0, packets = 0;
};

void Add(std::span<const Method> methods, RayKind kind, PictureTimes& times, Gains& gains) {
  const double packets = std::min(methods[kEight].cpu_s, methods[kSixteen].cpu_s);
  times.own += methods[kOwn].cpu_s;
  times.single += methods[kEmbree].cpu_s;
  times.packets += packets;
  gains.of_packets[static_cast<std::size_t>(kind)].push_back(methods[kEmbree].cpu_s / packets);
  gains.own_error = std::max(gains.own_error, methods[kOwn].error);
  gains.embree_error = std::max(gains.embree_error, methods[kEmbree].error);
}

void AddPanel(const char* scene, RayKind kind, std::size_t rays, std::span<const Method> methods,
              ChartTable& table) {
  const auto count = static_cast<double>(rays);
  for (const Method& method : methods)
    table.points.push_back(
        {fmt::format("{}: {}", scene, kKindNames[static_cast<std::size_t>(kind)]),
         method.series,
         method.label,
         method.cpu_s / count * 1e6,
         method.error,
         &method == &methods[kOwn],
         {count}});
}

void AddScene(Session& session, const ChartScene& scene, ChartTable& table, Gains& gains) {
  const ReadyScene<double>& ready = session.Ready(scene);
  const auto exact = MakeReady<long double>(session.Load(scene), "bvh");
  const RayRecorder recorder(*ready.kernel, ready.scene);
  const ImageSize image = ImageFor(session);
  session.progress.Begin(fmt::format("packets, recording {}", scene.name),
                         EyeRays(image, Samples{}));
  const auto sampler = MakeSampler(ready.scene, ready.model, recorder, {}, image, {});
  Draw(session, *sampler, image, {});
  PictureTimes times;
  for (const RayKind kind : {RayKind::kEye, RayKind::kShadow, RayKind::kReflected}) {
    const RayList list = recorder.RaysOf(kind);
    if (list.rays.empty()) continue;
    Answers truth = RoomFor(list, kind);
    AnswerSingly(*exact->kernel, list, kind, truth);
    std::vector<Method> methods = MethodsFor(kind, ready.model);
    session.progress.Begin(
        fmt::format("packets, {}: {}", scene.name, kKindNames[static_cast<std::size_t>(kind)]),
        static_cast<double>(methods.size()) * session.rounds());
    MeasureMethods(session, list, kind, truth, methods);
    AddPanel(scene.name, kind, list.rays.size(), methods, table);
    Add(methods, kind, times, gains);
  }
  gains.own_over_packets.push_back(times.own / times.packets);
  gains.own_over_single.push_back(times.own / times.single);
}

std::string SentenceOf(const Gains& gains) {
  return fmt::format(
      "Ask rays one by one: a picture's rays take {} times the time of Embree's asked so, {} times "
      "that of its packets, and {} % of the answers are wrong, of Embree's up to {} %; packets "
      "make Embree {} times as fast on eye rays, {} on shadow rays, {} on reflected ones.",
      RangeText(gains.own_over_single), RangeText(gains.own_over_packets),
      ShortNumber(100 * gains.own_error), ShortNumber(100 * gains.embree_error),
      RangeText(gains.of_packets[0]), RangeText(gains.of_packets[1]),
      RangeText(gains.of_packets[2]));
}

}  // namespace

ChartTable PacketsChart(Session& session) {
  ChartTable table{.name = "packets", .title = "Rays in packets"};
  table.image = ImageFor(session);
  table.x.title = "CPU seconds for a million rays";
  table.y.title = "share of rays with another object or distance";
  table.more_columns = {"rays"};
  Gains gains;
  for (const ChartScene& scene : kChartScenes) AddScene(session, scene, table, gains);
  table.sentence = SentenceOf(gains);
  return table;
}

}  // namespace stipple::raytracer
