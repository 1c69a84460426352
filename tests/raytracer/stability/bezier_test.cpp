// SPDX-License-Identifier: MIT
// Row G: bicubic Bezier patches.
//
// Newton's method goes where its start leads it: from the middle of a patch to a sheet that lies
// behind another, or out of the patch. More starts help, and how many are enough depends on the
// patch. The shipped method divides until a part is proved to hold at most one root.
#include <gtest/gtest.h>

#include "raytracer/charts/trials/patch_trial.h"

namespace stipple::raytracer {
namespace {

const PatchTrial& Trial() {
  static const PatchTrial trial(80);  // 25600 rays; 160 gives the same rates
  return trial;
}

TEST(Bezier, NewtonsMethodFindsWrongSheets) {
  const PatchRates middle = Trial().Try<double>(1);
  EXPECT_GT(middle.missed, 0.02);
  EXPECT_LT(middle.missed, 0.08);
  EXPECT_GT(middle.wrong_sheet, 0.10);
  EXPECT_LT(middle.wrong_sheet, 0.30);
  EXPECT_GT(Trial().Try<double>(2).wrong_sheet, 0.01);
  EXPECT_GT(Trial().Try<double>(4).wrong_sheet, 5e-4);
  EXPECT_LT(Trial().Try<double>(16).wrong_sheet, 5e-4);  // the trial sees that more starts help
}

TEST(Bezier, DividingFindsTheNearestSheet) {
  const PatchRates rates = Trial().Try<double>(0);
  EXPECT_EQ(rates.missed, 0);
  EXPECT_EQ(rates.wrong_sheet, 0);
  EXPECT_EQ(rates.not_there, 0);
  EXPECT_LT(rates.t_error, 1e-12);
  const PatchRates wide = Trial().Try<long double>(0);
  EXPECT_EQ(wide.missed + wide.wrong_sheet + wide.not_there, 0);
  EXPECT_LT(wide.t_error, 1e-15);
}

// In float rays that pass an outline closer than rounding may fall to either side.
TEST(Bezier, FloatDiffersAtOutlinesOnly) {
  const PatchRates rates = Trial().Try<float>(0);
  EXPECT_LT(rates.missed + rates.wrong_sheet + rates.not_there, 1e-3);
  EXPECT_LT(rates.t_error, 1e-4);
}

}  // namespace
}  // namespace stipple::raytracer
