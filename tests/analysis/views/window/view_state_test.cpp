// SPDX-License-Identifier: MIT
// What zooms, pans, steps back and plays keep, for any run.
#include "analysis/views/window/view_state.h"

#include <gtest/gtest.h>

#include <random>

namespace stipple {
namespace {

constexpr double kRuns[] = {1e-6, 0.5, 12.75, 36000};

double Share(const TimeSpan& span, double time_s) {
  return (time_s - span.begin_s) / span.length();
}

TEST(ViewState, ZoomingKeepsTheTimeUnderThePointer) {
  for (const double run_s : kRuns)
    for (const double place : {0.0, 0.2, 0.5, 0.99, 1.0}) {
      ViewState state(run_s, {0});
      const double time_s = place * run_s;
      for (int i = 0; i < 20; ++i) {
        const double before = Share(state.visible(), time_s);
        state.ZoomAbout(time_s, 0.8);
        EXPECT_NEAR(Share(state.visible(), time_s), before, 1e-3) << run_s << ' ' << place;
      }
      EXPECT_LT(state.visible().length(), run_s);
    }
}

TEST(ViewState, WhateverIsDoneTheViewStaysInTheRunAndIsNeitherTooShortNorTooLong) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0, 1);
  for (const double run_s : kRuns) {
    ViewState state(run_s, {0, 1});
    for (int i = 0; i < 3000; ++i) {
      const double a = any(random) * 1.4 * run_s - 0.2 * run_s, b = any(random) * run_s;
      switch (random() % 6) {
        case 0:
          state.Show({a, b});
          break;
        case 1:
          state.ZoomAbout(a, any(random) * 2);
          break;
        case 2:
          state.PanBy(a - b);
          break;
        case 3:
          state.Back();
          break;
        case 4:
          state.Forward();
          break;
        default:
          state.Centre({b, b + any(random) * 1e-6});
          break;
      }
      const TimeSpan& visible = state.visible();
      ASSERT_GE(visible.begin_s, 0);
      ASSERT_LE(visible.end_s, run_s);
      ASSERT_GE(visible.length(), std::min(kShortestSpan_s, run_s) * 0.99);
    }
  }
}

TEST(ViewState, PanningKeepsTheLengthUpToTheEnds) {
  ViewState state(10, {0});
  state.Show({2, 4});
  state.PanBy(3);
  EXPECT_EQ(state.visible(), (TimeSpan{5, 7}));
  state.PanBy(100);
  EXPECT_EQ(state.visible(), (TimeSpan{8, 10}));
  state.PanBy(-100);
  EXPECT_EQ(state.visible(), (TimeSpan{0, 2}));
}

TEST(ViewState, BackUndoesEachStepAndForwardRepeatsIt) {
  ViewState state(10, {0});
  const TimeSpan steps[] = {{0, 10}, {2, 8}, {3, 5}, {3.5, 4}};
  for (const TimeSpan& step : steps) state.Show(step);
  for (int i = 2; i >= 0; --i) {
    ASSERT_TRUE(state.Back());
    EXPECT_EQ(state.visible(), steps[i]);
  }
  EXPECT_FALSE(state.Back());
  for (int i = 1; i < 4; ++i) {
    ASSERT_TRUE(state.Forward());
    EXPECT_EQ(state.visible(), steps[i]);
  }
  EXPECT_FALSE(state.Forward());
}

TEST(ViewState, AGestureIsOneStepBack) {
  ViewState state(10, {0});
  for (int i = 0; i < 12; ++i) state.ZoomAbout(4, 0.8);
  EXPECT_EQ(state.StepsBack(), 1u);
  for (int i = 0; i < 5; ++i) state.PanBy(0.01);
  EXPECT_EQ(state.StepsBack(), 2u);
  state.EndGesture();
  state.PanBy(0.01);
  EXPECT_EQ(state.StepsBack(), 3u);
  state.Back();
  state.Back();
  state.Back();
  EXPECT_EQ(state.visible(), state.run());
}

TEST(ViewState, ANewStepForgetsTheWayForward) {
  ViewState state(10, {0});
  state.Show({2, 8});
  state.Back();
  state.Show({1, 3});
  EXPECT_FALSE(state.Forward());
}

TEST(ViewState, PlayingReachesTheEndAndStops) {
  ViewState state(10, {0});
  state.Show({2, 4});
  state.TogglePlay();
  EXPECT_EQ(state.cursor_s(), 2);
  double before = state.cursor_s();
  for (int i = 0; i < 100000 && state.playing(); ++i) {
    state.Advance(0.016);
    ASSERT_GE(state.cursor_s(), before);
    ASSERT_TRUE(state.visible().Has(state.cursor_s())) << "the view follows";
    before = state.cursor_s();
  }
  EXPECT_FALSE(state.playing());
  EXPECT_EQ(state.cursor_s(), 10);
}

TEST(ViewState, RanksAreNarrowedHiddenAndComeBack) {
  ViewState state(1, {0, 1, 2, 3});
  state.Hide({1});
  EXPECT_EQ(state.ranks(), (std::vector<int>{0, 2, 3}));
  state.NarrowTo({2});
  EXPECT_EQ(state.ranks(), (std::vector<int>{2}));
  state.Hide({2});
  EXPECT_EQ(state.ranks(), (std::vector<int>{2})) << "the last one stays";
  state.NarrowTo({2});
  EXPECT_TRUE(state.AllRanks());
  state.ShowRanks({9});
  EXPECT_TRUE(state.AllRanks()) << "unknown ranks change nothing";
}

TEST(ViewState, CyclingDisplaysKeepsTheirNumber) {
  ViewState state(1, {0});
  const auto shown = [&] {
    int count = 0;
    for (std::size_t p = 0; p < kPanelCount; ++p) count += state.Shows(static_cast<Panel>(p));
    return count;
  };
  const int before = shown();
  for (int i = 0; i < 20; ++i) {
    state.CycleDisplay();
    EXPECT_EQ(shown(), before);
  }
}

}  // namespace
}  // namespace stipple
