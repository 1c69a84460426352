// SPDX-License-Identifier: MIT
// Times of runs whose events are not all timed: a simulated program knows the truth, and records
// like the runtime does, under a clock that recording itself moves on.
#include "analysis/stats/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/tables.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

enum : std::uint32_t { kMain = 1, kOuter, kInner, kOther, kTimed, kRegions };

constexpr std::uint32_t kUnit = 256;  // of prices, to a tick
constexpr Calibration kPrices{0,         40 * kUnit, 24 * kUnit, 80 * kUnit, 30 * kUnit,
                              4 * kUnit, 2 * kUnit,  20 * kUnit, 0};

/// A program with planted work. Its regions are timed unless told otherwise.
class Machine {
 public:
  explicit Machine(std::string_view mode, unsigned seed = 1) : stream(1), random(seed) {
    std::snprintf(stream.header.settings, sizeof(stream.header.settings), "clock=%s",
                  std::string(mode).c_str());
    stream.Define(kPrices);
    for (std::uint32_t r = kMain; r < kRegions; ++r) stream.Region(r, "r" + std::to_string(r));
    stream.NewChunk(now);
  }

  void Work(double ticks) {
    clock += ticks;
    truth[stack.back().region] += ticks;
    now = static_cast<std::uint64_t>(clock);
  }
  void Visit(std::uint32_t region, const std::function<void()>& body) {
    ++calls[region];
    const Choice choice = ChoiceFor(region);
    Enter(region, choice);
    body();
    Leave(region, choice);
  }
  /// Writes what the runtime does at the end.
  void End() {
    std::string entries;
    std::uint64_t count = 0;
    for (const auto& [region, visits] : unseen) {
      const std::uint32_t where[2] = {region, 0};
      entries.append(reinterpret_cast<const char*>(where), 8);
      entries.append(reinterpret_cast<const char*>(&visits), 8);
      ++count;
    }
    stream.Define(VisitCounts{0, count}, entries);
    stream.End(now);
  }

  StreamWriter stream;
  std::set<std::uint32_t> counted;
  std::set<std::uint32_t> no_clock;
  std::map<std::uint32_t, double> truth;
  std::map<std::uint32_t, std::uint64_t> calls;
  std::mt19937 random;
  int sparse = 0;     // one clock for so many events
  double prices = 1;  // 0: recording costs nothing

 private:
  enum class Choice { kTimed, kCount, kSample, kInside, kNoClock };
  struct Open {
    std::uint32_t region;
    Choice choice;
  };

  Choice ChoiceFor(std::uint32_t region) {
    const bool counts = counted.contains(region);
    if (!counts && !no_clock.contains(region)) return Choice::kTimed;
    if (!stack.empty() && stack.back().choice == Choice::kSample) return Choice::kInside;
    if (left[region]-- > 0) return counts ? Choice::kCount : Choice::kNoClock;
    left[region] = 60 + static_cast<int>(random() % 8);
    return Choice::kSample;
  }
  void Pay(double price) {
    clock += price / kUnit * prices;
    now = static_cast<std::uint64_t>(clock);
  }
  bool HasClock() { return sparse == 0 || events++ % sparse == 0; }

  void Enter(std::uint32_t region, Choice choice) {
    if (choice == Choice::kTimed) {
      Pay((kPrices.timed_visit - kPrices.timed_inner) / 2);
      if (HasClock())
        stream.Enter(region, now);
      else
        stream.Unclocked(region, false);
      Pay(kPrices.timed_inner / 2);
    } else if (choice == Choice::kNoClock) {
      stream.Unclocked(region, false);
      Pay(kPrices.no_clock_visit / 2);
    } else if (choice == Choice::kCount) {
      ++unseen[region];
      Pay(kPrices.counted_visit);
    } else {
      Pay((kPrices.sampled_visit - kPrices.sampled_inner) / 2);
      const bool sample = choice == Choice::kSample;
      stream.Append(CountedEnter{0, now, region,
                                 sample ? CountedPurpose::kSample : CountedPurpose::kInside,
                                 sample ? std::exchange(unseen[region], 0) : 0});
      Pay(kPrices.sampled_inner / 2);
    }
    stack.push_back({region, choice});
  }
  void Leave(std::uint32_t region, Choice choice) {
    if (choice == Choice::kTimed) {
      Pay(kPrices.timed_inner / 2);
      if (HasClock())
        stream.Leave(region, now);
      else
        stream.Unclocked(region, true);
      Pay((kPrices.timed_visit - kPrices.timed_inner) / 2);
    } else if (choice == Choice::kNoClock) {
      stream.Unclocked(region, true);
      Pay(kPrices.no_clock_visit / 2);
    } else if (choice != Choice::kCount) {
      Pay(kPrices.sampled_inner / 2);
      stream.Leave(region, now);
      Pay((kPrices.sampled_visit - kPrices.sampled_inner) / 2);
    }
    stack.pop_back();
  }

  double clock = 1000;
  std::uint64_t now = 1000;
  int events = 0;
  std::vector<Open> stack;
  std::map<std::uint32_t, int> left;
  std::map<std::uint32_t, std::uint64_t> unseen;
};

/// What the reader makes of it, by region number.
struct Read {
  explicit Read(Machine& machine) {
    machine.End();
    archive.Add(machine.stream);
    trace.emplace(Trace::Open(archive.path()));
    analysis.emplace(*trace);
    times.resize(kRegions);
    for (const RegionTime& t : analysis->profiles.at(0))
      times.at(static_cast<std::size_t>(trace->regions()[t.region].name.at(1) - '0')) += t;
  }
  TemporaryArchive archive;
  std::optional<Trace> trace;
  std::optional<Analysis> analysis;
  std::vector<RegionTime> times;
};

/// Every truth lies within its bounds, and they are no wider than `width` of the whole run.
void ExpectHolds(Machine& machine, double width) {
  const Read read(machine);
  for (const Problem& p : read.analysis->health.problems()) ADD_FAILURE() << TextOf(p);
  double total = 0;
  for (const auto& [region, ticks] : machine.truth) total += ticks;
  for (const auto& [region, ticks] : machine.truth) {
    const RegionTime& t = read.times.at(region);
    EXPECT_EQ(t.calls, machine.calls[region]) << region;
    EXPECT_LE(t.exclusive_bounds_ns.low, ticks + 1) << region;
    EXPECT_GE(t.exclusive_bounds_ns.high, ticks - 1) << region;
    EXPECT_LE(t.exclusive_bounds_ns.low, t.exclusive_ns) << region;
    EXPECT_GE(t.exclusive_bounds_ns.high, t.exclusive_ns) << region;
    EXPECT_LE(t.exclusive_bounds_ns.high - t.exclusive_bounds_ns.low, width * total) << region;
    EXPECT_GE(t.inclusive_ns, t.exclusive_ns * 0.999999) << region;
  }
}

/// A program: what main does.
struct Program {
  const char* name;
  std::set<std::uint32_t> counted;
  double width;  // of intervals, as a part of the run
  std::function<void(Machine&)> run;
};

void Times(int count, const std::function<void(int)>& body) {
  for (int i = 0; i < count; ++i) body(i);
}

std::vector<Program> ProgramsOfEqualVisits() {
  return {{"a short leaf between work",
           {kInner},
           0.5,
           [](Machine& m) {
             Times(20000, [&](int) {
               m.Work(50);
               m.Visit(kInner, [&] { m.Work(100); });
             });
           }},
          {"short in short",
           {kOuter, kInner},
           0.5,
           [](Machine& m) {
             Times(20000, [&](int) {
               m.Work(30);
               m.Visit(kOuter, [&] {
                 m.Work(60);
                 m.Visit(kInner, [&] { m.Work(80); });
                 m.Visit(kInner, [&] { m.Work(40); });
               });
             });
           }},
          {"a leaf of two callers at different cost", {kInner}, 0.5, [](Machine& m) {
             Times(500, [&](int) {
               m.Visit(kOuter, [&] {
                 Times(40, [&](int) { m.Visit(kInner, [&] { m.Work(150); }); });
                 m.Work(3000);
               });
               m.Visit(kOther, [&] {
                 Times(20, [&](int) { m.Visit(kInner, [&] { m.Work(50); }); });
                 m.Work(4000);
               });
             });
           }}};
}

std::vector<Program> ProgramsOfUnequalVisits() {
  return {{"two sorts of visits",
           {kInner},
           0.5,
           [](Machine& m) {
             Times(30000, [&](int) {
               m.Work(100);
               m.Visit(kInner, [&] { m.Work(m.random() % 8 == 0 ? 600 : 40); });
             });
           }},
          {"visits that grow",
           {kInner},
           0.5,
           [](Machine& m) {
             Times(20000, [&](int i) {
               m.Work(100);
               m.Visit(kInner, [&] { m.Work(50 + i / 100); });
             });
           }},
          {"timed inside of counted", {kOuter}, 0.5, [](Machine& m) {
             Times(20000, [&](int) {
               m.Work(20);
               m.Visit(kOuter, [&] {
                 m.Work(70);
                 m.Visit(kTimed, [&] { m.Work(300); });
               });
             });
           }}};
}

std::vector<Program> Programs() {
  std::vector<Program> programs = ProgramsOfEqualVisits();
  std::ranges::move(ProgramsOfUnequalVisits(), std::back_inserter(programs));
  return programs;
}

TEST(Estimate, TruthLiesWithinTheBoundsOfEveryProgram) {
  for (const Program& p : Programs())
    for (const bool events : {false, true})
      for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(p.name);
        Machine machine("budget:5", seed);
        (events ? machine.no_clock : machine.counted) = p.counted;
        machine.Visit(kMain, [&] { p.run(machine); });
        ExpectHolds(machine, p.width);
      }
}

TEST(Estimate, WithoutDegradedRegionsCostsAreTakenOut) {
  Machine machine("budget:5");
  machine.Visit(kMain, [&] {
    Times(100, [&](int) { machine.Visit(kOuter, [&] { machine.Work(1000); }); });
    machine.Work(5000);
  });
  const Read read(machine);
  EXPECT_NEAR(read.times[kOuter].exclusive_ns, 100'000, 1);
  EXPECT_NEAR(read.times[kMain].exclusive_ns, 5000, 100);  // each time is a whole number of ticks
  EXPECT_NEAR(read.times[kMain].inclusive_ns, 105'000, 100);
}

TEST(Estimate, RecursionHasExclusiveTimeAndAWideInclusiveOne) {
  Machine machine("budget:5");
  machine.counted = {kInner};
  const std::function<void(int)> recurse = [&](int depth) {
    machine.Visit(kInner, [&] {
      machine.Work(90);
      if (depth == 0) return;
      recurse(depth - 1);
      recurse(depth - 1);
    });
  };
  machine.Visit(kMain, [&] { recurse(13); });
  const Read read(machine);
  const RegionTime& t = read.times[kInner];
  EXPECT_EQ(t.calls, (1U << 14) - 1);
  EXPECT_NEAR(t.exclusive_ns, machine.truth[kInner], machine.truth[kInner] * 0.05);
  EXPECT_LE(t.inclusive_bounds_ns.low, machine.truth[kInner]);
  EXPECT_GE(t.inclusive_bounds_ns.high, machine.truth[kInner]);
  EXPECT_LE(t.inclusive_ns, read.trace->SpanNs());
}

TEST(Estimate, AnInterruptedSampleIsNotMultiplied) {
  Machine machine("budget:5");
  machine.counted = {kInner};
  machine.Visit(kMain, [&] {
    Times(50000, [&](int i) {
      machine.Work(100);
      // Some visit near the middle, whichever is the sample, waits for the processor.
      machine.Visit(kInner, [&] { machine.Work(i >= 25000 && i < 25064 ? 1'000'000 : 100); });
    });
  });
  const Read read(machine);
  EXPECT_LT(read.times[kInner].exclusive_ns, 8e6);
  EXPECT_GT(read.times[kInner].exclusive_bounds_ns.high, 64e6 * 0.9);
  EXPECT_LT(read.times[kMain].exclusive_bounds_ns.low, 6e6);
}

TEST(Sparse, TruthLiesWithinProvableBounds) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    Machine machine("sparse:8", seed);
    machine.sparse = 8;
    machine.prices = 0;
    machine.Visit(kMain, [&] {
      const std::function<void(int)> walk = [&](int depth) {
        Times(static_cast<int>(machine.random() % 5), [&](int) {
          machine.Visit(kOuter + machine.random() % 4, [&] {
            machine.Work(static_cast<double>(machine.random() % 200));
            if (depth < 6) walk(depth + 1);
          });
        });
      };
      Times(200, [&](int) { walk(0); });
    });
    const Read read(machine);
    for (const auto& [region, ticks] : machine.truth) {
      EXPECT_EQ(read.times[region].calls, machine.calls[region]);
      EXPECT_GE(read.times[region].exclusive_bounds_ns.high, ticks);
      EXPECT_LE(read.times[region].exclusive_bounds_ns.low, ticks);
      EXPECT_TRUE(std::isnan(read.times[region].inclusive_bounds_ns.low));
    }
  }
}

// The report's quality section costs no scan of its own.
TEST(Overhead, FromCallPathsIsThatOfAScanOfItsOwn) {
  for (const std::string mode : {"exact", "sparse:8"}) {
    Machine machine(mode);
    machine.sparse = mode == "exact" ? 0 : 8;
    machine.Visit(kMain, [&] {
      const std::function<void(int)> walk = [&](int depth) {
        Times(static_cast<int>(machine.random() % 4), [&](int) {
          machine.Visit(kOuter + machine.random() % 4, [&] {
            machine.Work(static_cast<double>(machine.random() % 200));
            if (depth < 6) walk(depth + 1);
          });
        });
      };
      Times(100, [&](int) { walk(0); });
    });
    machine.End();
    TemporaryArchive archive;
    archive.Add(machine.stream);
    const Trace trace = Trace::Open(archive.path());
    const Analysis analysis(trace);
    analysis.NeedPaths();
    const std::vector<RegionOverhead> scanned =
        EstimateOf(trace, trace.locations().front(), {}).overhead;
    const std::vector<RegionOverhead>& found = analysis.overheads.front();
    ASSERT_EQ(found.size(), scanned.size());
    EXPECT_GT(found.size(), 4U);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].region, scanned[i].region);
      EXPECT_EQ(found[i].events, scanned[i].events);
      EXPECT_EQ(found[i].counted, scanned[i].counted);
      EXPECT_EQ(found[i].measured_ns, scanned[i].measured_ns);
      EXPECT_EQ(found[i].cost_ns, scanned[i].cost_ns);
      EXPECT_EQ(found[i].residual_ns, scanned[i].residual_ns);
    }
  }
}

}  // namespace
}  // namespace stipple
