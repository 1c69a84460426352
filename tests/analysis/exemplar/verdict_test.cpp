// SPDX-License-Identifier: MIT
// Verdicts from made-up numbers: some that hold, some that fail, some that flip.
#include "analysis/exemplar/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/exemplar/f12.h"
#include "analysis/exemplar/f15.h"
#include "analysis/exemplar/f17.h"
#include "analysis/exemplar/f8.h"
#include "analysis/exemplar/paper.h"
#include "analysis/exemplar/run_measures.h"
#include "analysis/exemplar/study.h"

namespace stipple {
namespace {

using Verdicts = std::vector<std::optional<Verdict>>;
constexpr auto kHolds = Verdict::kHolds, kInPart = Verdict::kInPart, kRefuted = Verdict::kRefuted,
               kUnstable = Verdict::kUnstable;

Verdicts VerdictsOf(const std::vector<ClaimPart>& parts) {
  Verdicts verdicts;
  for (const ClaimPart& part : parts) verdicts.push_back(VerdictOf(part));
  return verdicts;
}

/// One part with one check for each number: at least 1.
std::vector<ClaimPart> AtLeastOne(std::vector<double> values) {
  ClaimPart part{"at least 1", {}};
  for (const double value : values) part.checks.push_back({"x", value, Relation::kAtLeast, 1});
  return {part};
}

PartsAt At(const std::string& parameter, const std::string& value, double place,
           std::vector<double> values) {
  return {{parameter, value, "normal", place}, AtLeastOne(std::move(values))};
}

TEST(Verdict, FollowsFromTheChecksAndANumberThatIsNoneFails) {
  EXPECT_EQ(VerdictOf(AtLeastOne({1, 2})), kHolds);
  EXPECT_EQ(VerdictOf(AtLeastOne({1, 0.9})), kInPart);
  EXPECT_EQ(VerdictOf(AtLeastOne({0.9})), kRefuted);
  EXPECT_EQ(VerdictOf(AtLeastOne({std::nan("")})), kRefuted);
  EXPECT_EQ(VerdictOf(AtLeastOne({})), std::nullopt);
  EXPECT_FALSE((Check{"", 1, Relation::kAbove, 1}.Holds()));
  EXPECT_FALSE((Check{"", 1, Relation::kBelow, 1}.Holds()));
  EXPECT_TRUE((Check{"", 1, Relation::kAtMost, 1}.Holds()));
}

TEST(Verdict, AClaimOfWhichAPartDoesNotAriseHoldsInPartAtMost) {
  const ClaimPart holds = AtLeastOne({1})[0], fails = AtLeastOne({0})[0], silent{"silent", {}};
  EXPECT_EQ(VerdictOf(std::vector{holds, silent}), kInPart);
  EXPECT_EQ(VerdictOf(std::vector{fails, fails}), kRefuted);
  EXPECT_EQ(VerdictOf(std::vector{silent, silent}), std::nullopt);
}

TEST(Judge, AVerdictThatIsTheSameEverywhereStands) {
  const Judgement j = Judge(std::vector{At("", "", 0, {2}), At("work", "more", 1, {1.5})});
  EXPECT_EQ(j.verdict, kHolds);
  EXPECT_TRUE(j.turns.empty());
}

TEST(Judge, AVerdictThatFlipsIsUnstableAndNamesWhere) {
  // Given in any order; the reference lies between "less" and "more".
  const Judgement j = Judge(std::vector{At("", "", 0, {2}), At("host", "most", 2, {0.5}),
                                        At("host", "less", -1, {3}), At("host", "more", 1, {1}),
                                        At("work", "less", -1, {0.5})});
  EXPECT_EQ(j.verdict, kUnstable);
  EXPECT_EQ(j.reference, kHolds);
  ASSERT_EQ(j.turns.size(), 2U);
  EXPECT_EQ(j.turns[0].parameter, "host");
  EXPECT_EQ(j.turns[0].from, "more");
  EXPECT_EQ(j.turns[0].to, "most");
  EXPECT_EQ(j.turns[1].parameter, "work");
  EXPECT_EQ(j.turns[1].from, "less");
  EXPECT_EQ(j.turns[1].to, "normal");
  EXPECT_EQ(j.turns[1].before, kRefuted);
}

TEST(Judge, ComparisonsAndSettingsWithoutChecksTurnNothing) {
  std::vector settings{At("", "", 0, {2}), At("host", "more", 1, {}), At("machine", "new", 1, {0})};
  settings.back().variation.compared = true;
  EXPECT_EQ(Judge(settings).verdict, kHolds);
}

TEST(Judge, VariationsOfAReducedRunAreComparedWithIt) {
  std::vector settings{At("", "", 0, {2}), At("picture", "reduced", 1, {0.5}),
                       At("work", "more", 1, {0.5})};
  settings[2].variation.reference = 1;
  const Judgement j = Judge(settings);
  ASSERT_EQ(j.turns.size(), 1U) << "only the picture's size turns it";
  EXPECT_EQ(j.turns[0].parameter, "picture");
}

TEST(F8, HoldsFailsAndAsksForTheCauseOnlyOfALoss) {
  const F8Scene lost{"a", 20, 10, 11, 8, 6}, won{"b", 20, 10, 9.8, 8, 1};
  EXPECT_EQ(VerdictsOf(JudgeF8(std::vector{lost})), (Verdicts{kHolds, kHolds, kHolds}));
  EXPECT_EQ(VerdictsOf(JudgeF8(std::vector{won})), (Verdicts{kHolds, kHolds, std::nullopt}));
  const F8Scene other_cause{"c", 10, 12, 13, 8, 3}, much_better{"d", 20, 10, 9, 1, 1};
  EXPECT_EQ(VerdictsOf(JudgeF8(std::vector{other_cause})), (Verdicts{kRefuted, kHolds, kRefuted}));
  EXPECT_EQ(VerdictsOf(JudgeF8(std::vector{lost, much_better})),
            (Verdicts{kHolds, kInPart, kHolds}));
}

TEST(F12, ImbalanceMustBeRealAndSavingsSmall) {
  const F12Bundles row{100, 0.005, 0.02, 1.05};
  EXPECT_EQ(VerdictsOf(JudgeF12(row, {130, 0.002, 0.25, 1.5})), (Verdicts{kHolds, kHolds, kHolds}));
  EXPECT_EQ(VerdictsOf(JudgeF12(row, {100, 0.004, 0.02, 1.04})),
            (Verdicts{kHolds, kRefuted, kInPart}));
  EXPECT_EQ(VerdictsOf(JudgeF12({100, 0.2, 0.02, 1.05}, {90, 0.05, 0.1, 1.2})),
            (Verdicts{kRefuted, kInPart, kRefuted}));
}

F15Scene Curve(const std::string& scene, double worst, double bend, double last) {
  F15Scene s{scene, 10, {}};
  for (int k = 1; k < 15; ++k) {
    const double place = (k - 1) / 15.0;
    s.points.push_back({k / 16.0, 10 * (worst - (worst - 1) * std::pow(place, bend))});
  }
  s.points.push_back({15 / 16.0, 10 * last});
  return s;
}

TEST(F15, ABentCurveHoldsAStraightOneDoesNot) {
  const std::vector bent{Curve("rings", 1.8, 4, 1.2), Curve("tree", 1.3, 4, 1.1)};
  EXPECT_EQ(VerdictsOf(JudgeF15(bent)), (Verdicts{kHolds, kHolds, kHolds}));
  const F15Scene straight = Curve("rings", 3, 1, 1 + 2 / 15.0);
  EXPECT_NEAR(FarthestFromLine(straight), 0, 1e-9);
  const std::vector worse{straight, Curve("tree", 4, 4, 1.1)};
  EXPECT_EQ(VerdictsOf(JudgeF15(worse)), (Verdicts{kRefuted, kInPart, kInPart}));
}

TEST(F17, EvenThenUneven) {
  const std::vector<F17Run> as_claimed{{0.75, 1.05, 1.5, 10, 0.9}, {0.5, 1.08, 1.6, 20, 0.8}};
  EXPECT_EQ(VerdictsOf(JudgeF17(as_claimed)), (Verdicts{kHolds, kHolds, kHolds, kHolds}));
  const std::vector<F17Run> not_so{{0.75, 2, 1.5, 20, 0.9}, {0.5, 1.9, 1.2, 10, 0.1}};
  EXPECT_EQ(VerdictsOf(JudgeF17(not_so)), (Verdicts{kRefuted, kInPart, kRefuted, kInPart}));
}

TEST(RunMeasures, AreTheSameAfterTheyWereKept) {
  RunMeasures m{.simulated_s = 1.5, .hash = "ab", .messages = 7, .host = 2};
  m.nodes = {{0, 1, 0.1, 0.2, 0.2}, {1, 0.5, 0.1, 0.2, 0.7}};
  m.waits = {{"late-sender", 2, 0.4}, {"end-imbalance", 0, 0.2}};
  m.supply_s = 0.7;
  m.utilisation = {{0.1, 0.9, 0.8, 1}};
  m.counters["rays sent"] = {{0, 4}, {1, 6}};
  const std::string text = JsonOf(m, "stipple simulate");
  const std::optional<RunMeasures> read = MeasuresFrom(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(JsonOf(*read, "stipple simulate"), text);
  EXPECT_EQ(WaitsFor(*read, 2), 0.4);
  EXPECT_NEAR(WaitsFor(*read, -1), 0.6, 1e-12);
  EXPECT_NEAR(MaxOverMean(read->nodes), 1 / 0.75, 1e-12);
  EXPECT_FALSE(MeasuresFrom(text.substr(0, text.size() / 2))) << "cut: run again";
}

TEST(PaperExperiments, EveryCaseIsADifferentCommandAtEachSetting) {
  for (const PaperExperiment& e : PaperExperiments())
    for (const bool quick : {false, true}) {
      std::vector<std::string> keys;
      for (const PlannedSetting& s : SettingsFor(e, "ipsc2", quick))
        for (const Case& c : e.cases(s.setting, quick)) keys.push_back(KeyOf(c.run, "build"));
      const std::size_t count = keys.size();
      std::ranges::sort(keys);
      keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
      EXPECT_EQ(keys.size(), count) << e.name;
    }
}

}  // namespace
}  // namespace stipple
