// SPDX-License-Identifier: MIT
// Recording switched off and on, and the run-time filter: what is recorded is balanced whatever
// happens, what is left out is said.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "run_writer.h"
#include "walker.h"

namespace {

using stipple_test::Directory;
using stipple_test::RunResult;
using stipple_test::RunWriter;
using stipple_test::WalkArchive;
using stipple_test::WalkedStream;

/// The streams of one run; the program's status must be 0.
std::vector<WalkedStream> Record(const std::string& arguments, const std::string& before = "") {
  const Directory archive;
  const RunResult run = RunWriter(archive.path(), arguments, before);
  EXPECT_EQ(run.status, 0) << arguments << run.errors;
  std::vector<WalkedStream> streams = WalkArchive(archive.path());
  for (const WalkedStream& stream : streams) EXPECT_TRUE(stream.problems.empty()) << arguments;
  return streams;
}

/// Whether every leave is that of the innermost open enter, and nothing stays open.
bool IsBalanced(const std::vector<stipple::EventWord>& events) {
  std::vector<stipple::RegionId> open;
  for (const stipple::EventWord word : events) {
    if (!stipple::IsLeave(word)) {
      open.push_back(stipple::RegionOf(word));
    } else {
      if (open.empty() || open.back() != stipple::RegionOf(word)) return false;
      open.pop_back();
    }
  }
  return open.empty();
}

int EnterCount(const WalkedStream& stream, const std::string& name) {
  int count = 0;
  for (const auto& [index, thread] : stream.threads)
    for (const stipple::EventWord word : thread.Events()) {
      const auto region = static_cast<std::uint32_t>(stipple::RegionOf(word));
      const auto found = stream.regions.find(region);
      count += !stipple::IsLeave(word) && found != stream.regions.end() && found->second == name;
    }
  return count;
}

int SwitchCount(const WalkedStream& stream) {
  const auto found = stream.definitions.find(stipple::RecordKind::kSwitched);
  return found == stream.definitions.end() ? 0 : found->second;
}

TEST(Switch, LeavesEveryThreadBalanced) {
  const int kSwitches = std::getenv("STIPPLE_TEST_FULL") != nullptr ? 1000000 : 20000;
  const auto streams = Record("storm " + std::to_string(kSwitches));
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(SwitchCount(streams[0]), kSwitches);
  EXPECT_EQ(streams[0].threads.size(), 3u);
  for (const auto& [index, thread] : streams[0].threads) {
    EXPECT_GE(thread.Events().size(), 40u) << index;
    EXPECT_TRUE(IsBalanced(thread.Events())) << index;
  }
}

TEST(Switch, OffRecordsNothingButTheEndsOfOpenVisits) {
  for (const char* rounds : {"1", "10000"}) {
    const auto streams = Record("off " + std::string(rounds));
    ASSERT_EQ(streams.size(), 1u);
    // Two rounds of 4 + 4 + 2 events, and the three visits that were open.
    EXPECT_EQ(streams[0].EventCount(), 2u * 10 + 6) << rounds;
    ASSERT_EQ(streams[0].threads.size(), 1u);
    EXPECT_TRUE(IsBalanced(streams[0].threads.begin()->second.Events())) << rounds;
    EXPECT_EQ(streams[0].threads.begin()->second.records.at(stipple::RecordKind::kMark), 2);
    EXPECT_EQ(SwitchCount(streams[0]), 2) << rounds;
  }
}

TEST(Switch, WhatIsLoadedWhileOffComesOnWithTheRest) {
  const auto streams = Record("late 0");
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(EnterCount(streams[0], "late"), 1);
}

TEST(Switch, RegionsBySharedOrDemangledPattern) {
  const auto streams = Record("regions 0");
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(EnterCount(streams[0], "outer"), 3);
  EXPECT_EQ(EnterCount(streams[0], "inner"), 2);
  EXPECT_EQ(EnterCount(streams[0], "_ZN6solver4stepEi"), 2);
  EXPECT_EQ(SwitchCount(streams[0]), 5);
}

TEST(Switch, PausedRunsAreSwitchedByTheSignal) {
  auto streams = Record("signal 10", "STIPPLE_PAUSED=1");
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(streams[0].EventCount(), 40u);
  EXPECT_EQ(SwitchCount(streams[0]), 3);
  streams = Record("own-handler 10", "STIPPLE_PAUSED=1");
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(streams[0].EventCount(), 0u);
}

TEST(Switch, WithoutPauseTheSignalIsTheProgramsOwn) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "signal 10").status, 128 + 12);
}

TEST(Switch, AChildGoesOnAsItsParentWas) {
  const auto streams = Record("fork 10");
  ASSERT_EQ(streams.size(), 2u);
  EXPECT_EQ(streams[0].EventCount(), 40u);
  EXPECT_EQ(streams[1].EventCount(), 80u);
  EXPECT_EQ(SwitchCount(streams[1]), 2);
}

struct FilterRow {
  const char* rules;
  int outer, inner, step;  // visits that are left
  std::uint32_t filtered;
};

TEST(Filter, LeavesOutWhatItExcludes) {
  constexpr FilterRow kRows[] = {
      {"SCOREP_REGION_NAMES_BEGIN EXCLUDE inner SCOREP_REGION_NAMES_END", 5, 0, 1, 1},
      {"SCOREP_REGION_NAMES_BEGIN\nEXCLUDE *\nINCLUDE solver::*\nSCOREP_REGION_NAMES_END", 0, 0, 1,
       2},
      {"SCOREP_REGION_NAMES_BEGIN EXCLUDE MANGLED _Z* SCOREP_REGION_NAMES_END", 5, 5, 0, 1},
      {"SCOREP_FILE_NAMES_BEGIN EXCLUDE by_*.cpp SCOREP_FILE_NAMES_END", 0, 0, 0, 3},
      {"SCOREP_REGION_NAMES_BEGIN EXCLUDE nothing SCOREP_REGION_NAMES_END", 5, 5, 1, 0},
      {"# only a comment", 5, 5, 1, 0}};
  const Directory directory;
  const std::string path = directory.path() + "/filter";
  for (const FilterRow& row : kRows) {
    std::ofstream(path) << row.rules;
    const auto streams = Record("plain 5", "STIPPLE_FILTER='" + path + "'");
    ASSERT_EQ(streams.size(), 1u);
    EXPECT_EQ(EnterCount(streams[0], "outer"), row.outer) << row.rules;
    EXPECT_EQ(EnterCount(streams[0], "inner"), row.inner) << row.rules;
    EXPECT_EQ(EnterCount(streams[0], "_ZN6solver4stepEi"), row.step) << row.rules;
    EXPECT_EQ(streams[0].regions.size(), 3u - row.filtered) << row.rules;
    std::uint32_t functions = 0, filtered = 0;
    for (const stipple::Filtered& of_object : streams[0].filters) {
      functions += of_object.functions;
      filtered += of_object.filtered;
    }
    EXPECT_EQ(functions, 3u) << row.rules;
    EXPECT_EQ(filtered, row.filtered) << row.rules;
  }
}

TEST(Filter, OneThatCannotBeReadIsSaidAndFiltersNothing) {
  const Directory archive;
  const RunResult run = RunWriter(archive.path(), "plain 5", "STIPPLE_FILTER=/nonexistent/filter");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.errors,
            "stipple: the filter /nonexistent/filter cannot be read; nothing is filtered\n");
  EXPECT_EQ(WalkArchive(archive.path()).at(0).EventCount(), 22u);
}

}  // namespace
