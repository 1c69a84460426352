// SPDX-License-Identifier: MIT
// What the kernel told: its times, the state system, the tables, and damage.
#include "analysis/trace/kernel.h"

#include <gtest/gtest.h>

#include "analysis/report/event_text.h"
#include "analysis/report/recorded.h"
#include "analysis/stats/analysis.h"
#include "analysis/stats/states.h"
#include "analysis/stats/switches.h"
#include "analysis/stats/syscalls.h"
#include "tests/analysis/archive_writer.h"

namespace stipple::testing {
namespace {

constexpr std::uint32_t kMain = 1, kRecv = 2;

ContextSwitch AbsenceRecord(std::uint64_t out_ns, std::uint64_t in_ns, SwitchReason reason) {
  return {0, out_ns, in_ns, in_ns - out_ns, 0, 1, reason, 1, 0, 0};
}

SystemCall CallRecord(std::uint64_t enter, std::uint64_t leave, std::int64_t result) {
  return {0, leave, enter, result, 0, 0};  // read
}

void Say(StreamWriter& stream, const std::string& what, bool available, int error = 0) {
  stream.Define(
      Availability{0, available ? 1u : 0u, error, static_cast<std::uint32_t>(what.size()), 0},
      what);
}

/// main from 1000 to 11000; MPI from 5000 to 7000.
StreamWriter PlainRun() {
  StreamWriter stream(1);
  stream.Region(kMain, "main");
  stream.Region(kRecv, "MPI_Recv", RegionKind::kMpi);
  stream.Enter(kMain, 1000);
  stream.Append(CallRecord(2000, 3000, 12));
  stream.Enter(kRecv, 5000);
  stream.Append(CallRecord(5500, 6000, -4));
  stream.Leave(kRecv, 7000);
  stream.Leave(kMain, 11000);
  stream.Kernel(AbsenceRecord(2500, 4000, SwitchReason::kBlocked));
  stream.Kernel(AbsenceRecord(6500, 8000, SwitchReason::kPreempted));
  stream.End(11000);
  return stream;
}

TEST(Kernel, SystemIsCallsAndAbsencesOutsideMpiAndStatesSumToTheSpan) {
  TemporaryArchive archive;
  StreamWriter stream = PlainRun();
  Say(stream, "switches", true);
  archive.Add(stream);
  const Trace trace = Trace::Open(archive.path());
  const Analysis analysis(trace);
  const std::vector<RankStates> states = StatesOf(analysis, {});
  ASSERT_EQ(states.size(), 1u);
  ASSERT_TRUE(states[0].system_ns.has_value());
  EXPECT_EQ(*states[0].system_ns, 2000 + 1000);
  EXPECT_EQ(states[0].user_ns, 10000 - 3000 - 2000);
  EXPECT_EQ(states[0].SpanNs(), 10000);
  EXPECT_TRUE(analysis.health.Sound());
  Selection part;
  part.begin_ns = 1500;
  part.end_ns = 6500;
  const RankStates some = StatesOf(analysis, part).front();
  EXPECT_EQ(*some.system_ns, 1500 + 500);
  EXPECT_EQ(some.SpanNs(), 5000);
}

TEST(Kernel, SystemIsNullUnlessItWasRecorded) {
  TemporaryArchive archive;
  StreamWriter stream = PlainRun();
  Say(stream, "switches", false, 1);
  archive.Add(stream);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_FALSE(StatesOf(Analysis(trace), {}).front().system_ns.has_value());
  EXPECT_EQ(RecordedText(trace), "not switches (Operation not permitted)");
  EXPECT_EQ(NotRecordedTexts(trace).size(), 1u);
}

TEST(Kernel, TablesCountSwitchesAndCalls) {
  TemporaryArchive archive;
  StreamWriter stream = PlainRun();
  Say(stream, "switches", true);
  Say(stream, "system calls", true);
  stream.Name(1, "page faults");
  stream.Kernel(Counter{0, 1500, 1, 0, 40});
  stream.Kernel(Counter{0, 9000, 1, 0, 47});
  archive.Add(stream);
  const Trace trace = Trace::Open(archive.path());
  std::string headline;
  const Table switches = SwitchesTable(trace, {}, headline);
  ASSERT_EQ(switches.rows.size(), 1u);
  const auto& row = switches.rows.front();
  ASSERT_EQ(row.size(), switches.columns.size());
  EXPECT_EQ(std::get<std::int64_t>(row[3]), 2);
  EXPECT_EQ(std::get<std::int64_t>(row[4]), 1);
  EXPECT_NEAR(std::get<double>(row[5]), 1.5e-6, 1e-12);
  EXPECT_EQ(std::get<std::int64_t>(row[8]), 2);  // each on another processor
  EXPECT_EQ(std::get<std::int64_t>(row[10]), 7);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(row[11]));
  const Table calls = SystemCallsTable(trace, {}, true, headline);
  ASSERT_EQ(calls.rows.size(), 1u);
  const auto& call = calls.rows.front();
  EXPECT_EQ(std::get<std::string>(call[1]), "read");
  EXPECT_EQ(std::get<std::int64_t>(call[2]), 2);
  EXPECT_EQ(std::get<std::int64_t>(call[4]), 12);
  EXPECT_EQ(std::get<std::int64_t>(call[5]), 1);
  EXPECT_EQ(std::get<std::int64_t>(call[6]), 1);
}

TEST(Kernel, TimesAreThoseOfTheArchiveWhateverTheRateOfTheCounter) {
  for (const double ticks_per_ns : {0.5, 1.0, 2.1, 4.7}) {
    TemporaryArchive archive;
    StreamWriter stream(1, "boot-a", ticks_per_ns);
    const auto ticks = [ticks_per_ns](double ns) {
      return static_cast<std::uint64_t>(ns * ticks_per_ns);
    };
    stream.Region(kMain, "main");
    stream.Enter(kMain, ticks(100'000));
    stream.Leave(kMain, ticks(900'000));
    stream.End(ticks(1'000'000));
    stream.Kernel(AbsenceRecord(300'000, 500'000, SwitchReason::kBlocked));
    archive.Add(stream);
    const Trace trace = Trace::Open(archive.path());
    const KernelAccount account = ReadKernel(trace, trace.locations().front());
    ASSERT_EQ(account.absences.size(), 1u);
    EXPECT_NEAR(static_cast<double>(account.absences[0].out_ns), 200'000, 5) << ticks_per_ns;
    EXPECT_NEAR(static_cast<double>(account.absences[0].away_ns), 200'000, 5) << ticks_per_ns;
  }
}

TEST(Kernel, AThreadWithoutEventsHasALocationAndPrintKeepsTheOrderOfTime) {
  TemporaryArchive archive;
  StreamWriter stream(1);
  stream.Kernel(AbsenceRecord(4000, 5000, SwitchReason::kBlocked));
  stream.Kernel(AbsenceRecord(2000, 3000, SwitchReason::kPreempted));
  stream.End(9000);
  archive.Add(stream);
  const Trace trace = Trace::Open(archive.path());
  ASSERT_EQ(trace.locations().size(), 1u);
  const Location& l = trace.locations().front();
  EventCursor cursor(trace, l);
  const Event* event = cursor.Next();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->ticks, 2000u);
  EXPECT_EQ(EventText(trace, l, *event), "preempted for 1.00 µs, processor 0 to 1");
  EXPECT_EQ(CanonicalText(trace, l, *event), "");
  event = cursor.Next();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->ticks, 4000u);
  EXPECT_EQ(cursor.Next(), nullptr);
}

TEST(Kernel, DamageIsSkipped) {
  for (std::uint64_t seed = 1; seed < 400; ++seed) {
    TemporaryArchive archive;
    StreamWriter stream = PlainRun();
    Say(stream, "switches", true);
    std::string bytes = stream.Bytes();
    std::uint64_t state = seed * 0x9e3779b97f4a7c15;
    for (int i = 0; i < 20; ++i) {  // in the first words of any chunk
      state = state * 6364136223846793005 + 1442695040888963407;
      const std::size_t chunk = (state >> 33) % (bytes.size() / kGranuleBytes);
      bytes[chunk * kGranuleBytes + (state >> 40) % 300] = static_cast<char>(state >> 56);
    }
    archive.AddBytes("1", bytes);
    const Trace trace = Trace::Open(archive.path());
    const Analysis analysis(trace);
    std::string headline;
    SwitchesTable(trace, {}, headline);
    SystemCallsTable(trace, {}, false, headline);
    for (const Location& l : trace.locations())
      for (EventCursor cursor(trace, l); const Event* event = cursor.Next();)
        EventText(trace, l, *event);
  }
}

}  // namespace
}  // namespace stipple::testing
