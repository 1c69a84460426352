// SPDX-License-Identifier: MIT
#include "analysis/trace/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "analysis/stats/analysis.h"
#include "analysis/trace/demangle.h"
#include "analysis/trace/input_error.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

std::vector<std::int64_t> TimesOf(const Trace& trace, std::size_t location) {
  std::vector<std::int64_t> times;
  const Location& l = trace.locations()[location];
  EventCursor cursor(trace, l);
  while (const Event* event = cursor.Next()) times.push_back(trace.TimeNs(l, event->ticks));
  return times;
}

std::vector<std::int64_t> TimesOf(const StreamWriter& stream) {
  TemporaryArchive archive;
  archive.Add(stream);
  return TimesOf(Trace::Open(archive.path()), 0);
}

StreamWriter Program() {
  StreamWriter s(1);
  s.Region(1, "main");
  s.Region(2, "_ZN3FooC2Ei");
  return s;
}

TEST(Demangle, GivesTheNamesThatPeopleWrite) {
  EXPECT_EQ(Demangle("_ZN3FooC2Ei"), "Foo::Foo(int)");
  EXPECT_EQ(Demangle("_ZN3FooC1Ei.constprop.0"), "Foo::Foo(int)");
  EXPECT_EQ(Demangle("__solver_MOD_step"), "solver::step");
  EXPECT_EQ(Demangle("work.part.3"), "work");
  EXPECT_EQ(Demangle("_Znonsense"), "_Znonsense");
  EXPECT_EQ(Demangle(""), "");
}

TEST(Demangle, ShortNamesLeaveOutWhatTheReaderNeedsNot) {
  EXPECT_EQ(ShortName("main"), "main");
  EXPECT_EQ(ShortName("main phase"), "main phase");  // a region of user.h
  EXPECT_EQ(ShortName("void a::(anonymous namespace)::F<int>(std::vector<int> const&) const"),
            "a::F<..>");
  EXPECT_EQ(ShortName("std::vector<int, std::allocator<int> >::push_back(int&&)"),
            "std::vector<..>::push_back");
  EXPECT_EQ(ShortName("A::operator()(int) const"), "A::operator()");
  EXPECT_EQ(ShortName("std::ostream& operator<< <char>(std::ostream&, char)"), "operator<<<..>");
  EXPECT_EQ(ShortName("A::operator->() const"), "A::operator->");
  EXPECT_EQ(ShortName("operator new(unsigned long)"), "operator new");
  EXPECT_EQ(ShortName("main::{lambda(int, int)#1}::operator()(int, int) const"),
            "main::{lambda(int, int)#1}::operator()");
  EXPECT_EQ(ShortName("solver::step"), "solver::step");
  EXPECT_EQ(ShortName(""), "");
  EXPECT_EQ(ShortName("("), "(");
}

TEST(Trace, TimesGoOnOverChunksAndOverTheEndOf40Bits) {
  constexpr std::uint64_t kWrap = std::uint64_t{1} << 40;
  StreamWriter s = Program();
  s.header.start_ticks = s.header.start_raw_ns = 5 * kWrap - 100;
  s.NewChunk(5 * kWrap - 100);
  s.Enter(1, 5 * kWrap - 50);
  s.Enter(2, 5 * kWrap + 7);
  s.NewChunk(6 * kWrap);
  s.Leave(2, 6 * kWrap + 10);
  s.Leave(1, 6 * kWrap + 30);
  s.End(6 * kWrap + 40);
  EXPECT_EQ(TimesOf(s), (std::vector<std::int64_t>{0, 57, kWrap + 60, kWrap + 80}));
}

TEST(Trace, SilentThreadsTimeStampBringsTheTimeBack) {
  constexpr std::uint64_t kWrap = std::uint64_t{1} << 40;
  StreamWriter s = Program();
  s.header.start_ticks = s.header.start_raw_ns = 100;
  s.NewChunk(100);
  s.Enter(1, 200);
  s.Append(TimeStamp{0, 3 * kWrap + 150, 3 * kWrap + 150});
  s.Leave(1, 3 * kWrap + 200);
  s.End(3 * kWrap + 300);
  const std::vector<std::int64_t> times = TimesOf(s);
  ASSERT_GE(times.size(), 2U);
  EXPECT_EQ(times.back() - times.front(), 3 * kWrap);
}

constexpr std::uint64_t kEventsOfGranule = (kGranuleBytes - sizeof(ChunkHeader)) / 8;

/// A window of two granules as a kill can leave it: its last events stand first in the file, an
/// earlier chunk and the copy of the window behind.
std::string BytesOfReusedWindow(bool magic, bool first_words) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Enter(1, 2000);
  s.NewChunk(3000);
  for (std::uint64_t i = 0; i < kEventsOfGranule; ++i)
    i % 2 == 0 ? s.Enter(2, 4000 + i) : s.Leave(2, 4000 + i);
  s.End(9000);
  std::string bytes = s.Bytes();
  const std::string full = bytes.substr(bytes.size() - kGranuleBytes);
  std::string window = full + std::string(kGranuleBytes, '\0');
  const std::uint32_t window_bytes = 2 * kGranuleBytes;
  std::memcpy(window.data() + offsetof(ChunkHeader, bytes), &window_bytes, sizeof(window_bytes));
  const EventWord enter = MakeEvent(8000, false, RegionId{2});
  const EventWord leave = MakeEvent(8001, true, RegionId{2});
  std::memcpy(window.data() + kGranuleBytes, &enter, 8);
  std::memcpy(window.data() + kGranuleBytes + 8, &leave, 8);
  std::string cleared = window;
  if (!magic) std::memset(cleared.data(), 0, 8);
  if (!first_words) std::memset(cleared.data() + kGranuleBytes, 0, 8);
  const std::size_t before = bytes.size() - 2 * kGranuleBytes;
  return bytes.substr(0, before) + cleared + bytes.substr(before, kGranuleBytes) + window;
}

TEST(Trace, WindowLeftBetweenCopyAndClearingCountsOnce) {
  struct State {
    bool magic;
    bool first_words;
  };
  for (const State state : {State{true, true}, State{false, true}, State{false, false}}) {
    TemporaryArchive archive;
    archive.AddBytes("1", BytesOfReusedWindow(state.magic, state.first_words));
    const Trace trace = Trace::Open(archive.path());
    EXPECT_EQ(trace.EventCount(), 1 + kEventsOfGranule + 2);
    EXPECT_EQ(trace.Health().CountOf(Defect::kBadChunk), 0U) << state.magic << state.first_words;
    EXPECT_EQ(trace.Health().CountOf(Defect::kMissingChunk), 0U);
  }
}

TEST(Trace, TwoDifferentChunksOfOneNumberAreDamage) {
  std::string bytes = BytesOfReusedWindow(true, true);
  bytes[bytes.size() - 2 * kGranuleBytes + offsetof(ChunkHeader, ticks)] ^= 1;
  TemporaryArchive archive;
  archive.AddBytes("1", bytes);
  EXPECT_EQ(Trace::Open(archive.path()).Health().CountOf(Defect::kBadChunk), 1U);
}

TEST(Trace, StepBackTakesThePredecessorsTime) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Enter(1, 2000);
  s.Enter(2, 1990);
  s.Leave(2, 2010);
  s.End(3000);
  EXPECT_EQ(TimesOf(s), (std::vector<std::int64_t>{0, 0, 10}));
}

TEST(Trace, UnclockedEventsLieBetweenTheirNeighboursInEqualSteps) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Enter(1, 2000);
  for (int i = 0; i < 3; ++i) s.Unclocked(2, i % 2 == 1);
  s.Leave(2, 2400);
  s.Unclocked(1, true);
  s.End(3000);
  EXPECT_EQ(TimesOf(s), (std::vector<std::int64_t>{0, 100, 200, 300, 400, 400}));
}

TEST(Trace, RecordWhoseLastWordsAreZeroIsRead) {
  StreamWriter s = Program();
  s.Name(1, "queue", "rays");
  s.NewChunk(1000);
  s.Enter(1, 2000);
  s.Append(Counter{0, 2100, 1, 0, 0.0});
  s.End(3000);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(trace.EventCount(), 2U);
  EXPECT_TRUE(Analysis(trace).health.Sound());
}

TEST(Trace, ProcessesShareRegionsAndAreOrderedByRank) {
  TemporaryArchive archive;
  for (const std::int32_t rank : {2, 0, 1}) {
    StreamWriter s(static_cast<std::uint32_t>(10 - rank));
    s.World(rank, 3);
    s.Region(rank == 2 ? 7 : 1, "_ZN3FooC1Ei");
    s.NewChunk(1000);
    s.Enter(rank == 2 ? 7 : 1, 2000 + static_cast<std::uint64_t>(rank));
    s.End(5000);
    archive.Add(s);
  }
  const Trace trace = Trace::Open(archive.path());
  ASSERT_EQ(trace.locations().size(), 3U);
  EXPECT_EQ(trace.regions().size(), 2U);
  EXPECT_EQ(trace.RankCount(), 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(trace.locations()[static_cast<std::size_t>(i)].rank, i);
    EXPECT_EQ(TimesOf(trace, static_cast<std::size_t>(i)), std::vector<std::int64_t>{i});
  }
}

TEST(Trace, ForkedChildRepeatsItsParentsRankAndMayLeaveItsParentsFrames) {
  StreamWriter parent = Program();
  parent.NewChunk(1000);
  parent.Enter(1, 2000);
  parent.Leave(1, 4000);
  parent.End(5000);
  StreamWriter child = Program();
  child.header.pid = 2;
  child.header.parent_pid = 1;
  child.header.forked = 1;
  child.header.start_realtime_ns += 5;
  child.NewChunk(1000);
  child.Leave(1, 3000);
  child.End(5000);
  TemporaryArchive archive;
  archive.Add(child);
  archive.Add(parent);
  const Trace trace = Trace::Open(archive.path());
  ASSERT_EQ(trace.locations().size(), 2U);
  EXPECT_EQ(trace.locations()[1].rank, 0);
  EXPECT_EQ(trace.locations()[1].process, 1);
  EXPECT_EQ(trace.RankCount(), 1);
  EXPECT_TRUE(Analysis(trace).health.Sound());
}

TEST(Trace, CountsWhatIsWrong) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Leave(2, 1500);  // was never entered
  s.Enter(1, 2000);
  s.Word(0);         // reserved, not committed
  s.Enter(9, 2100);  // not defined
  s.Leave(9, 2200);
  const std::uint64_t open[3] = {MakeHeader(RecordKind::kMark, 3, false), 2300, 0};
  for (const std::uint64_t word : open) s.Word(word);
  s.Leave(1, 2400);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  const TraceHealth health = Analysis(trace).health;
  EXPECT_EQ(health.CountOf(Defect::kLeaveWithoutEnter), 1U);
  EXPECT_EQ(health.CountOf(Defect::kUncommitted), 1U);
  EXPECT_EQ(health.CountOf(Defect::kUndefinedRegion), 2U);
  EXPECT_EQ(health.CountOf(Defect::kOpenRecord), 1U);
  EXPECT_EQ(health.CountOf(Defect::kUnclosedProcess), 1U);
  EXPECT_EQ(health.LostEvents(), 2U);
}

TEST(Trace, TimeBeyondAllClocksIsDamage) {
  StreamWriter s = Program();
  s.Name(1, "phase");
  s.NewChunk(1000);
  s.Enter(1, 1000);
  s.Append(Mark{0, std::uint64_t{1} << 63, 1, 0});
  s.Leave(1, 1300);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(TimesOf(trace, 0), (std::vector<std::int64_t>{0, 300}));
  EXPECT_FALSE(trace.Health().Sound());
}

TEST(Trace, EmptyAndMissingArchives) {
  TemporaryArchive archive;
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(trace.EventCount(), 0U);
  EXPECT_EQ(Analysis(trace).health.CountOf(Defect::kEmptyArchive), 1U);
  EXPECT_THROW(Trace::Open(archive.path() + "/none"), InputError);
}

TEST(Trace, DamagedFileHeaderDoesNotHideTheEvents) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Enter(1, 2000);
  s.Leave(1, 3000);
  s.End(4000);
  s.header.magic ^= 1;
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(trace.EventCount(), 2U);
  EXPECT_EQ(trace.Health().CountOf(Defect::kBadFileHeader), 1U);
}

// A process that ends cuts off what it had allocated ahead.
TEST(Trace, StreamThatIsCutWhileItIsReadLosesItsEndOnly) {
  StreamWriter s = Program();
  for (std::uint64_t chunk = 0; chunk < 8; ++chunk) {
    s.NewChunk(1000 + chunk * 1000);
    s.Enter(1, 1100 + chunk * 1000);
    s.Leave(1, 1200 + chunk * 1000);
  }
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  for (const auto& file : std::filesystem::directory_iterator(archive.path()))
    std::filesystem::resize_file(file, 5 * kGranuleBytes);
  EXPECT_EQ(trace.EventCount(), 6U);  // header, definitions, three chunks are left
}

TEST(Trace, WhatCannotBeCountedIsNotCalledNothing) {
  StreamWriter s = Program();
  s.NewChunk(1000);
  s.Enter(1, 2000);
  TemporaryArchive archive;
  archive.Add(s);
  EXPECT_FALSE(Trace::Open(archive.path()).Health().LostUncounted());
  archive.AddBytes("2", "");
  EXPECT_TRUE(Trace::Open(archive.path()).Health().LostUncounted());
}

TEST(Trace, ProblemsOfARankNameIt) {
  StreamWriter s = Program();
  s.World(1, 2);
  s.NewChunk(1000);
  s.Enter(1, 2000);  // and no end
  TemporaryArchive archive;
  archive.Add(s);
  const TraceHealth health = Trace::Open(archive.path()).Health();
  const auto problem =
      std::ranges::find(health.problems(), Defect::kUnclosedProcess, &Problem::defect);
  ASSERT_NE(problem, health.problems().end());
  EXPECT_EQ(TextOf(*problem),
            "rank 1 (computer.1.1.stream): 1 process did not end in order (killed?)");
}

TEST(Trace, MissingRankIsReported) {
  StreamWriter s = Program();
  s.World(1, 3);
  s.NewChunk(1000);
  s.Enter(1, 2000);
  s.End(3000);
  TemporaryArchive archive;
  archive.Add(s);
  EXPECT_EQ(Trace::Open(archive.path()).Health().CountOf(Defect::kMissingRank), 2U);
}

TEST(Clock, ComputersAreTiedByTheirReadingsPiecewiseLinearly) {
  // The other computer counts 2 ticks a nanosecond, begins at 5000 ns + 20 ppm drift.
  const auto other_ticks = [](double ns) {
    return static_cast<std::uint64_t>((ns - 5000) * 2 * (1 + 20e-6)) + 1'000'000;
  };
  constexpr double kSecond = 1e9;
  StreamWriter a = Program();
  a.World(0, 2);
  a.NewChunk(10'000);
  a.Enter(1, 10'000);
  a.Leave(1, static_cast<std::uint64_t>(10 * kSecond));
  a.End(static_cast<std::uint64_t>(10 * kSecond));
  StreamWriter b(2, "boot-b", 2);
  b.Region(1, "main");
  b.World(1, 2);
  b.header.start_ticks = other_ticks(10'000);
  b.header.start_raw_ns = b.header.start_ticks / 2;
  for (const double ns : {20'000.0, 9.9 * kSecond})
    b.Define(ClockSync{0, other_ticks(ns), static_cast<std::uint64_t>(ns), 400, 0, 100});
  b.NewChunk(other_ticks(10'000));
  b.Enter(1, other_ticks(15'000));
  b.Leave(1, other_ticks(5 * kSecond));
  TemporaryArchive archive;
  archive.Add(a);
  archive.Add(b);
  const Trace trace = Trace::Open(archive.path());
  const std::vector<std::int64_t> times = TimesOf(trace, 1);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_NEAR(static_cast<double>(times[0]), 5000, 2);
  EXPECT_NEAR(static_cast<double>(times[1]), 5 * kSecond - 10'000, 2);
  EXPECT_EQ(trace.clock().computers, 2U);
  EXPECT_TRUE(trace.clock().synchronised);
  EXPECT_NEAR(trace.clock().residual_ns, 100, 1);
}

}  // namespace
}  // namespace stipple
