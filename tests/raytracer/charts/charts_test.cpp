// SPDX-License-Identifier: MIT
// What charts are made of; that whole charts come out is tested with stipple exemplar.
#include <gtest/gtest.h>

#include <cmath>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/jittered.h"
#include "raytracer/charts/measure.h"
#include "raytracer/charts/moved.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/ray_recorder.h"

namespace stipple::raytracer {
namespace {

TEST(ChartTable, WhatWasNotMeasuredIsEmptyAndErrorsKeepTheirDigits) {
  ChartTable table{.name = "name", .title = "Title", .sentence = "Take this, not that."};
  table.more_columns = {"bytes"};
  table.points = {{"balls", "own", "4", 0.125, 1.0 / 3, true, {kNotMeasured}}};
  const std::string csv = CsvOf(table);
  EXPECT_NE(csv.find("# sentence: Take this, not that.\n"), csv.npos) << csv;
  EXPECT_NE(csv.find("\npanel,series,label,cpu_s,error,recommended,bytes\n"), csv.npos) << csv;
  EXPECT_TRUE(csv.ends_with("balls,own,4,0.125,0.3333333333333333,1,\n")) << csv;
}

TEST(RangeText, OneNumberWhereBothReadTheSame) {
  EXPECT_EQ(RangeText(std::vector{0.2901, 0.3349}), "0.29 to 0.33");
  EXPECT_EQ(RangeText(std::vector{12.4, 11.9}), "12");
  EXPECT_EQ(ShortNumber(0), "0");
  EXPECT_EQ(ShortNumber(1578.2), "1578");
}

TEST(CostAtError, LiesOnTheLinesBetweenPointsAndBeyond) {
  // A straight line in logarithms: error = 1 / cost.
  const std::vector<CostAndError> curve{{1, 1}, {4, 0.25}, {16, 0.0625}};
  for (const double cost : {0.5, 1.0, 2.0, 7.0, 16.0, 40.0})
    EXPECT_NEAR(CostAtError(curve, 1 / cost), cost, 1e-9);
}

TEST(Pixels, AreEqualAsWrittenWhenTheyRoundToTheSameBytes) {
  const Pixels a{{2, 1}, {0.5, 0.5, 0.5, 1, 0, 0}};
  Pixels b = a;
  b.rgb[0] += 1e-6;
  EXPECT_EQ(ShareThatDiffers(a, b), 0);
  EXPECT_NEAR(RootMeanSquare(a, b), 1e-6 / std::sqrt(6), 1e-12);
  b.rgb[4] = 2.0 / 255;
  EXPECT_EQ(ShareThatDiffers(a, b), 0.5);
  EXPECT_NEAR(Decibels(0.01), 40, 1e-9);
  EXPECT_TRUE(std::isnan(Decibels(0)));
}

TEST(Jittered, RaysAreInTheirPixelAndElsewhereInEach) {
  Session session(true);
  const ReadyScene<double>& ready = session.Ready(kChartScenes[0]);
  const ImageSize image{16, 16};
  JitteredSampler sampler(ready, {}, image, 2);
  const Pixels once = Draw(session, sampler, image, {4});
  EXPECT_EQ(sampler.counts().eye_rays, 4 * 16 * 16);
  // The picture is that of the stratified rays but for noise.
  const auto own = MakeSampler(ready.scene, ready.model, *ready.kernel, {}, image, {4});
  const double noise = RootMeanSquare(once, Draw(session, *own, image, {4}));
  EXPECT_GT(noise, 0);
  EXPECT_LT(noise, 0.1);
  JitteredSampler again(ready, {}, image, 2);
  EXPECT_EQ(Draw(session, again, image, {4}).rgb, once.rgb);
}

TEST(Moved, ByAPowerOfTwoTheRaysAreTheSame) {
  Session session(true);
  for (const ChartScene& chart_scene : kChartScenes) {
    const Scene scene = session.Load(chart_scene);
    const Scene moved = Moved(scene, {64, -64, 64});
    ASSERT_EQ(moved.shapes.objects.size(), scene.shapes.objects.size()) << chart_scene.name;
    const auto here = MakeReady<double>(scene, "bvh"), there = MakeReady<double>(moved, "bvh");
    EXPECT_LT(RootMeanSquare(Draw(session, *here, {}, {1}), Draw(session, *there, {}, {1})), 1e-9)
        << chart_scene.name;
  }
}

TEST(RayRecorder, KeepsEachRayOfThePictureByKindDepthAndLight) {
  Session session(true);
  const ReadyScene<double>& ready = session.Ready(kChartScenes[0]);
  const RayRecorder recorder(*ready.kernel, ready.scene);
  const ImageSize image{16, 16};
  const auto sampler = MakeSampler(ready.scene, ready.model, recorder, {}, image, {});
  Draw(session, *sampler, image, {});
  const RayCounts& counts = sampler->counts();
  EXPECT_EQ(recorder.RaysOf(RayKind::kEye).rays.size(), counts.eye_rays);
  EXPECT_EQ(recorder.RaysOf(RayKind::kReflected).rays.size(), counts.reflected_rays);
  const RayList shadow = recorder.RaysOf(RayKind::kShadow);
  ASSERT_EQ(shadow.rays.size(), counts.shadow_rays);
  ASSERT_GT(shadow.rays.size(), 100U);
  // One light for the first depth's rays, then the next, and so on: few changes.
  int changes = 0;
  for (std::size_t i = 1; i < shadow.rays.size(); ++i) {
    const auto end = [&shadow](std::size_t ray) {
      return shadow.rays[ray].origin + shadow.rays[ray].direction * shadow.max_t[ray];
    };
    if (Length(end(i) - end(i - 1)) > 0.1) ++changes;  // lights are farther apart
  }
  const int lights = static_cast<int>(ready.scene.lights.size());
  EXPECT_GE(changes, lights - 1);
  EXPECT_LT(changes, lights * ShadingChoice{}.max_depth);
}

TEST(Measure, EachCandidateIsDrawnOnceARound) {
  Session session(false);
  std::vector<int> order;
  const auto draw = [&order](int which) {
    return [&order, which] {
      order.push_back(which);
      return Pixels{{1, 1}, {1, 1, static_cast<double>(order.size())}};
    };
  };
  std::vector<Candidate> candidates{{"a", "", 10, draw(1)}, {"b", "", 20, draw(2)}};
  Measure(session, candidates);
  EXPECT_EQ(order, (std::vector{1, 2, 1, 2, 1, 2}));
  EXPECT_EQ(RaysOf(session, candidates), 90);
  EXPECT_EQ(candidates[1].pixels.rgb[2], 2) << "the picture of the first round";
  EXPECT_GE(candidates[0].cpu_s, 0);
}

}  // namespace
}  // namespace stipple::raytracer
