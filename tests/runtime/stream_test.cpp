// SPDX-License-Identifier: MIT
// What a program's events become: written by the runtime, read back word by word.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "run_writer.h"
#include "walker.h"

namespace {

using stipple::EventWord;
using stipple::RecordKind;
using stipple_test::Directory;
using stipple_test::RunWriter;
using stipple_test::WalkArchive;
using stipple_test::WalkedStream;
using stipple_test::WalkedThread;

/// outer, inner, inner's end, outer's end, as region and leave bit.
bool IsRounds(const std::vector<EventWord>& events) {
  constexpr std::uint64_t kRound[] = {1, 2, 2 | stipple::kLeaveBit, 1 | stipple::kLeaveBit};
  for (std::size_t i = 0; i < events.size(); ++i)
    if ((events[i] & 0xffffff) != kRound[i % 4]) return false;
  return events.size() % 4 == 0;
}

/// The 40 bits of time begin anew every few minutes, perhaps now: later is what is less than half a
/// turn ahead.
bool IsInTimeOrder(const std::vector<EventWord>& events) {
  constexpr std::uint64_t kTurn = std::uint64_t{1} << 40;
  return std::is_sorted(events.begin(), events.end(), [](EventWord a, EventWord b) {
    const std::uint64_t ahead = (stipple::TimeOf(b) - stipple::TimeOf(a)) % kTurn;
    return ahead != 0 && ahead < kTurn / 2;
  });
}

WalkedStream OnlyStream(const Directory& archive) {
  const auto streams = WalkArchive(archive.path());
  EXPECT_EQ(streams.size(), 1u);
  return streams.empty() ? WalkedStream{} : streams.front();
}

TEST(Stream, EveryEventIsReadBackInOrder) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "return 100000").status, 3);
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  ASSERT_EQ(stream.threads.size(), 1u);
  const auto events = stream.threads.at(0).Events();
  EXPECT_EQ(events.size(), 400000u);
  EXPECT_TRUE(IsRounds(events));
  EXPECT_TRUE(IsInTimeOrder(events));
  EXPECT_EQ(stream.regions.at(1), "outer");
  EXPECT_EQ(stream.regions.at(2), "inner");
  EXPECT_STREQ(stream.header.program, "runtime_core_writer");
  EXPECT_STREQ(stream.header.settings, "clock=exact");
}

TEST(Stream, SparseReadsTheClockOncePerN) {
  const Directory archive;
  RunWriter(archive.path(), "return 10000", "export STIPPLE_CLOCK=sparse:8;");
  const auto events = OnlyStream(archive).threads.at(0).Events();
  EXPECT_TRUE(IsRounds(events));
  const auto timed = std::count_if(events.begin(), events.end(),
                                   [](EventWord word) { return stipple::TimeOf(word) != 0; });
  EXPECT_NEAR(static_cast<double>(timed), 5000, 50);
}

TEST(Stream, AnUnknownClockIsNamedAndExactUsed) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "return 10", "export STIPPLE_CLOCK=fast;");
  EXPECT_EQ(run.errors,
            "stipple: clock 'fast' is unknown (exact, sparse:N, budget:P); using exact\n");
  EXPECT_STREQ(OnlyStream(archive).header.settings, "clock=exact");
}

TEST(Stream, ThreadsHaveStreamsOfTheirOwn) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "threads 25000").status, 0);
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  EXPECT_EQ(stream.threads.size(), 64u);
  EXPECT_EQ(stream.definitions.at(stipple::RecordKind::kDefineLocation), 64);
  for (const auto& [index, thread] : stream.threads) {
    const auto events = thread.Events();
    EXPECT_EQ(events.size(), 100000u);
    EXPECT_TRUE(IsRounds(events) && IsInTimeOrder(events)) << index;
    EXPECT_EQ(thread.records.at(stipple::RecordKind::kThreadEnd), 1);
  }
}

TEST(Stream, DestructorsOfAThreadAreEventsToo) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "thread-ends 10").status, 0);
  const WalkedStream stream = OnlyStream(archive);
  ASSERT_EQ(stream.threads.size(), 1u);
  EXPECT_EQ(stream.threads.begin()->second.Events().size(), 42u);
}

TEST(Stream, ModeBitsCountOrLeaveOutTheClock) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "modes 5000").status, 0);
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  ASSERT_EQ(stream.threads.size(), 2u);
  constexpr std::uint64_t kOuter = 1, kInner = 2;
  std::map<std::uint64_t, std::uint64_t> visits = {{kInner, stream.counts.at(2)}};
  std::uint64_t timed = 0;
  for (const auto& [index, thread] : stream.threads) {
    for (const EventWord word : thread.Events()) {
      timed += stipple::TimeOf(word) != 0 ? 1 : 0;
      if (!stipple::IsLeave(word)) ++visits[static_cast<std::uint64_t>(stipple::RegionOf(word))];
    }
    // Two visits with the clock; of 5000 each four or five samples, and what is inside of them.
    EXPECT_GE(thread.CountedEnters().size(), 8u);
    EXPECT_LE(thread.CountedEnters().size(), 15u);
    timed -= 2 * thread.CountedEnters().size();
  }
  EXPECT_EQ(timed, 2u);
  EXPECT_EQ(visits[kOuter], 1u + 10000);
  EXPECT_EQ(visits[kInner], 10000u);
  EXPECT_EQ(stream.counts.size(), 2u);
  EXPECT_EQ(stream.counts.at(1), 0u);
}

TEST(Stream, SwitchingIdsInMidVisitNeverUnbalances) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "toggle 300000").status, 0);
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  std::vector<stipple::RegionId> open;
  for (const EventWord word : stream.threads.at(0).Events()) {
    if (!stipple::IsLeave(word)) {
      open.push_back(stipple::RegionOf(word));
      continue;
    }
    ASSERT_FALSE(open.empty());
    ASSERT_EQ(open.back(), stipple::RegionOf(word));
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

TEST(Stream, SignalStormHarmsNoRecord) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "storm 500000");
  ASSERT_EQ(run.status, 0);
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  std::vector<EventWord> rounds;
  std::size_t handler = 0;
  for (const EventWord word : stream.threads.at(0).Events())
    if (stipple::RegionOf(word) == stipple::RegionId{3})
      ++handler;
    else
      rounds.push_back(word);
  EXPECT_EQ(handler, 2 * std::stoul(run.output));
  EXPECT_EQ(rounds.size(), 4u * 500000);
  EXPECT_TRUE(IsRounds(rounds));
  EXPECT_EQ(stream.threads.at(0).records.at(stipple::RecordKind::kMark), 100);
}

TEST(Stream, ManualEventsDefineTheirNamesAtFirstUse) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "manual 20000").status, 0);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 2u);
  const WalkedStream& stream = streams[0];
  EXPECT_TRUE(stream.problems.empty());
  EXPECT_EQ(stream.names.size(), 2u);
  EXPECT_EQ(stream.definitions.at(stipple::RecordKind::kDefineHost), 1);
  const WalkedThread& thread = stream.threads.at(0);
  EXPECT_EQ(thread.Events().size(), 40000u);
  EXPECT_EQ(thread.records.at(stipple::RecordKind::kMark), 20000);
  EXPECT_EQ(thread.records.at(stipple::RecordKind::kCounter), 20000);
  // The child of the fork marks under an id given before: its stream must define it.
  EXPECT_EQ(streams[1].names, stream.names);
  EXPECT_EQ(streams[1].threads.at(0).records.at(stipple::RecordKind::kMark), 1);
}

TEST(Stream, ManualEventsHaveTimesWhateverTheClock) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "manual 1000", "export STIPPLE_CLOCK=sparse:64;").status, 0);
  const auto events = WalkArchive(archive.path()).at(0).threads.at(0).Events();
  EXPECT_EQ(events.size(), 2000u);
  for (const EventWord word : events) EXPECT_NE(stipple::TimeOf(word), 0u);
}

TEST(Region, KeepsItsIdThroughUnloading) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "reload 1000").status, 0);
  EXPECT_EQ(OnlyStream(archive).definitions.at(stipple::RecordKind::kDefineRegion), 3);
}

/// In full, more functions than there are ids: the program runs on, what has an id is recorded as
/// before, and the archive says once that functions were left out.
TEST(Stream, OutlivesItsRegionIds) {
  const bool full = std::getenv("STIPPLE_TEST_FULL") != nullptr;
  const std::size_t objects = full ? 2050 : 10;
  const std::size_t functions = 3 + 4096 * objects;
  const Directory archive;
  const auto run = RunWriter(archive.path(), "exhaust " + std::to_string(4096 * objects));
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.errors, "");
  const WalkedStream stream = OnlyStream(archive);
  EXPECT_TRUE(stream.problems.empty());
  EXPECT_EQ(functions > stipple::kMaxRegion, full);
  EXPECT_EQ(stream.regions.size(), std::min<std::size_t>(functions, stipple::kMaxRegion));
  const auto note = stream.definitions.find(RecordKind::kAvailability);
  EXPECT_EQ(note == stream.definitions.end() ? 0 : note->second, full ? 1 : 0);
  // The first function of each object is visited, if it has an id.
  const std::size_t recorded = full ? (stipple::kMaxRegion - 4) / 4096 + 1 : objects;
  const auto events = stream.threads.at(0).Events();
  ASSERT_GE(events.size(), 4u);
  EXPECT_TRUE(IsRounds({events.end() - 4, events.end()}));
  EXPECT_EQ(events.size(), 2 * recorded + 4);
}

}  // namespace
