// SPDX-License-Identifier: MIT
// The budget: what loses its clock and its events, and that no visit is ever lost count of.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "run_writer.h"
#include "walker.h"

namespace {

using stipple::CountedPurpose;
using stipple::EventWord;
using stipple::RecordKind;
using stipple::RegionModeKind;
using stipple_test::Directory;
using stipple_test::RunWriter;
using stipple_test::WalkArchive;
using stipple_test::WalkedStream;

constexpr std::uint32_t kOuter = 1, kMiddle = 2, kInner = 3;
constexpr const char* kBudget = "export STIPPLE_CLOCK=budget:5;";
using Visits = std::map<std::uint32_t, std::uint64_t>;

/// By region: enters of any kind, and visits without an event.
Visits VisitsOf(const WalkedStream& stream) {
  Visits visits;
  for (const auto& [region, count] : stream.counts)
    if (count != 0) visits[region] += count;
  for (const auto& [index, thread] : stream.threads)
    for (const EventWord word : thread.Events())
      if (!stipple::IsLeave(word)) ++visits[static_cast<std::uint32_t>(stipple::RegionOf(word))];
  return visits;
}

/// What the writer printed, the last of each region; with `first`, the first.
Visits Printed(const std::string& output, bool first = false) {
  Visits visits;
  std::istringstream lines(output);
  std::uint32_t region = 0;
  std::uint64_t count = 0;
  while (lines >> region >> count) {
    if (count == 0 || (first && visits.count(region) != 0)) continue;
    visits[region] = count;
  }
  return visits;
}

std::vector<stipple::RegionMode> StepsOf(const WalkedStream& stream) {
  std::vector<stipple::RegionMode> steps;
  for (const auto& [index, thread] : stream.threads)
    steps.insert(steps.end(), thread.steps.begin(), thread.steps.end());
  std::stable_sort(steps.begin(), steps.end(),
                   [](const auto& a, const auto& b) { return a.ticks < b.ticks; });
  return steps;
}

std::vector<stipple::CountedEnter> CountedEntersOf(const WalkedStream& stream) {
  std::vector<stipple::CountedEnter> enters;
  for (const auto& [index, thread] : stream.threads)
    for (const stipple::CountedEnter& enter : thread.CountedEnters()) enters.push_back(enter);
  return enters;
}

/// Every leave has its enter.
bool IsBalanced(const std::vector<EventWord>& events) {
  std::vector<stipple::RegionId> open;
  for (const EventWord word : events) {
    if (!stipple::IsLeave(word)) {
      open.push_back(stipple::RegionOf(word));
      continue;
    }
    if (open.empty() || open.back() != stipple::RegionOf(word)) return false;
    open.pop_back();
  }
  return open.empty();
}

WalkedStream Record(const std::string& arguments, const char* clock, Visits* printed) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), arguments, clock);
  EXPECT_EQ(run.status, 0) << run.errors;
  *printed = Printed(run.output);
  const auto streams = WalkArchive(archive.path());
  EXPECT_FALSE(streams.empty());
  if (streams.empty()) return {};
  EXPECT_TRUE(streams.front().problems.empty());
  for (const auto& [index, thread] : streams.front().threads) EXPECT_EQ(thread.lost, 0u);
  return streams.front();
}

TEST(Budget, IsTheDefault) {
  Visits printed;
  const WalkedStream stream = Record("leaf 10", "unset STIPPLE_CLOCK;", &printed);
  EXPECT_STREQ(stream.header.settings, "clock=budget:5");
}

TEST(Budget, NothingIsDegradedBefore100000Visits) {
  Visits printed;
  const WalkedStream stream = Record("leaf 99999", kBudget, &printed);
  EXPECT_TRUE(StepsOf(stream).empty());
  EXPECT_EQ(stream.threads.at(0).Events().size(), 2u * 99999);
}

TEST(Budget, OtherClocksNeverDegrade) {
  for (const char* clock : {"export STIPPLE_CLOCK=exact;", "export STIPPLE_CLOCK=sparse:8;"}) {
    Visits printed;
    const WalkedStream stream = Record("leaf 400000", clock, &printed);
    EXPECT_TRUE(StepsOf(stream).empty());
    EXPECT_EQ(stream.threads.at(0).Events().size(), 800000u);
  }
}

TEST(Budget, VisitsAreCountedExactlyWhateverHappens) {
  for (const char* behaviour :
       {"leaf 500000", "nest 200000", "counted 20000", "threads 30000", "jump 120000",
        "throw 120000", "switch 120000", "storm 100000", "exec 120000"}) {
    Visits printed;
    const WalkedStream stream = Record(behaviour, kBudget, &printed);
    EXPECT_EQ(VisitsOf(stream), printed) << behaviour;
    EXPECT_FALSE(CountedEntersOf(stream).empty()) << behaviour;
  }
}

TEST(Budget, TheShortestGoFirstOneStepAtATime) {
  Visits printed;
  const WalkedStream stream = Record("nest 400000", kBudget, &printed);
  const auto steps = StepsOf(stream);
  ASSERT_GE(steps.size(), 2u);
  EXPECT_EQ(steps[0].region, kInner);
  std::map<std::uint32_t, RegionModeKind> modes;
  std::vector<std::uint32_t> first_steps;
  for (const auto& step : steps) {
    EXPECT_GE(step.visits, 100000u);
    const auto before = static_cast<int>(modes[step.region]), now = static_cast<int>(step.mode);
    EXPECT_EQ(std::abs(now - before), 1) << step.region;
    modes[step.region] = step.mode;
    if (std::find(first_steps.begin(), first_steps.end(), step.region) == first_steps.end())
      first_steps.push_back(step.region);
  }
  EXPECT_TRUE(std::is_sorted(first_steps.rbegin(), first_steps.rend()));
  EXPECT_EQ(modes[kInner], RegionModeKind::kCounted);
}

TEST(Budget, SamplesAreAStrideApartAndHaveTwoTimes) {
  Visits printed;
  const WalkedStream stream = Record("leaf 2000000", kBudget, &printed);
  const auto samples = CountedEntersOf(stream);
  ASSERT_GT(samples.size(), 1000u);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].purpose, CountedPurpose::kSample);
    EXPECT_LE(samples[i].visits, 1151u);
    EXPECT_GT(samples[i].ticks, samples[i - 1].ticks);
  }
  EXPECT_TRUE(IsBalanced(stream.threads.at(0).Events()));
}

TEST(Budget, VisitsDirectlyInsideASampleAreTimedDeeperOnesAreNot) {
  Visits printed;
  const WalkedStream stream = Record("counted 100000", "export STIPPLE_CLOCK=exact;", &printed);
  struct Open {
    std::uint32_t region;
    CountedPurpose purpose;
    int inside;
  };
  std::vector<Open> open;
  int samples = 0;
  const auto& thread = stream.threads.at(0);
  const auto counted_enters = thread.CountedEnters();
  auto counted = counted_enters.begin();
  for (const EventWord word : thread.Events()) {
    EXPECT_NE(stipple::TimeOf(word), 0u);
    if (!stipple::IsLeave(word)) {
      const bool inside = counted->purpose == CountedPurpose::kInside;
      EXPECT_EQ(inside, !open.empty() && open.back().purpose == CountedPurpose::kSample);
      if (inside) {
        EXPECT_EQ(counted->region, open.back().region + 1);
        ++open.back().inside;
      }
      open.push_back({counted->region, counted->purpose, 0});
      ++counted;
      continue;
    }
    ASSERT_FALSE(open.empty());
    if (open.back().purpose == CountedPurpose::kSample && open.back().region != kInner) {
      EXPECT_EQ(open.back().inside, 2);
      ++samples;
    }
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
  EXPECT_GT(samples, 200);
}

TEST(Budget, ARegionThatGrowsLongGetsItsClockBack) {
  Visits printed;
  const WalkedStream stream = Record("grow 300000", kBudget, &printed);
  const auto steps = StepsOf(stream);
  ASSERT_GE(steps.size(), 4u);
  EXPECT_EQ(steps.back().mode, RegionModeKind::kTimed);
  EXPECT_EQ(steps[steps.size() - 2].mode, RegionModeKind::kNoClock);
  EXPECT_EQ(VisitsOf(stream), printed);
  const auto events = stream.threads.at(0).Events();
  for (std::size_t i = events.size() - 20; i < events.size(); ++i)
    EXPECT_NE(stipple::TimeOf(events[i]), 0u);
}

TEST(Budget, ASampleLeftByAJumpIsForgotten) {
  for (const char* behaviour : {"jump 150000", "switch 150000"}) {
    Visits printed;
    const WalkedStream stream = Record(behaviour, kBudget, &printed);
    const auto enters = CountedEntersOf(stream);
    const auto inside = std::count_if(enters.begin(), enters.end(), [](const auto& enter) {
      return enter.purpose == CountedPurpose::kInside;
    });
    EXPECT_GT(enters.size(), 100u);
    // At most two to a sample.
    EXPECT_LE(inside, 2 * (static_cast<long>(enters.size()) - inside)) << behaviour;
  }
}

TEST(Budget, AForkedChildBeginsWithTheStepsOfItsParent) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "fork 300000", kBudget);
  EXPECT_EQ(run.status, 0);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 2u);
  EXPECT_EQ(VisitsOf(streams[0]), Printed(run.output));
  EXPECT_EQ(VisitsOf(streams[1]), Printed(run.output, true));
  std::map<std::uint32_t, RegionModeKind> parent, child;
  for (const auto& step : StepsOf(streams[0])) parent[step.region] = step.mode;
  for (const auto& step : StepsOf(streams[1])) child.insert({step.region, step.mode});
  EXPECT_FALSE(parent.empty());
  EXPECT_EQ(parent, child);
}

TEST(Budget, KilledItKnowsItsVisitsUpToTheLastSample) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "killed 1000000", kBudget);
  EXPECT_EQ(run.status, 128 + SIGKILL);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_TRUE(streams[0].problems.empty());
  const Visits visits = VisitsOf(streams[0]);
  EXPECT_LE(visits.at(kInner), 1000000u);
  EXPECT_GT(visits.at(kInner), 1000000u - 1152);
}

TEST(Budget, WhatEventsCostIsMeasuredAtTheBegin) {
  Visits printed;
  const WalkedStream stream = Record("leaf 1", "export STIPPLE_CLOCK=exact;", &printed);
  ASSERT_EQ(stream.calibrations.size(), 1u);
  const stipple::Calibration& c = stream.calibrations[0];
  for (const std::uint32_t figure : {c.timed_visit, c.timed_inner, c.sampled_visit, c.sampled_inner,
                                     c.no_clock_visit, c.counted_visit, c.clock_read})
    EXPECT_GT(figure, 0u);
  // Parts of a whole, measured together; more is not certain on a busy machine.
  EXPECT_LE(c.timed_inner, 2 * c.timed_visit);
  EXPECT_LE(c.sampled_inner, 2 * c.sampled_visit);
}

}  // namespace
