// SPDX-License-Identifier: MIT
// Kills, full and broken disks, rings, crowds of threads, clocks that go back: the program must not
// notice, what was committed must be there, what was lost must be counted and have its time. The
// archive is read by the real reader.
#include "adversity.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "analysis/stats/analysis.h"
#include "analysis/stats/profile.h"
#include "run_writer.h"

namespace {

using stipple::Analysis;
using stipple::Defect;
using stipple::Event;
using stipple::EventCursor;
using stipple::Location;
using stipple::Trace;
using stipple::TraceHealth;
using stipple_test::Directory;
using stipple_test::kOnes;
using stipple_test::kTwos;
using stipple_test::ReadAll;
using stipple_test::RunResult;
using stipple_test::RunWriter;

constexpr int kStatus = 3;
constexpr std::uint64_t kMegabyte = 1 << 20;

bool IsFull() { return std::getenv("STIPPLE_TEST_FULL") != nullptr; }

/// What a thread's events say.
struct Seen {
  std::uint64_t events = 0;
  std::uint64_t mistakes = 0;  // events that cannot follow the one before
};

/// Follows the pattern of the writer's visits, which may begin and end anywhere.
class PatternReader {
 public:
  explicit PatternReader(const Trace& trace) : trace_(trace) {}

  Seen Read(const Location& location) {
    Seen seen;
    place_ = -1;
    EventCursor cursor(trace_, location);
    while (const Event* event = cursor.Next()) {
      if (event->record != nullptr) continue;
      ++seen.events;
      if (!Follows(*event)) ++seen.mistakes;
    }
    return seen;
  }

 private:
  /// Place of the event among the 4 x 61 x 59 of the pattern: two numbers name a visit.
  bool Follows(const Event& event) {
    const std::string& name = trace_.regions()[event.region].name;
    const bool is_two = name.starts_with("two");
    const long number = std::atol(name.c_str() + 3);
    const int step = event.leave ? (is_two ? 2 : 3) : (is_two ? 1 : 0);
    if (place_ < 0) {
      // The first visits tell where the pattern begins: known once a one and a two were seen.
      if (step == 0) one_ = number;
      if (step != 1 || one_ < 0) return true;
      for (long n = one_; n < kOnes * kTwos; n += kOnes)
        if (n % kTwos == number) place_ = 4 * n + 1;
      return place_ >= 0;
    }
    place_ = (place_ + 1) % (4 * kOnes * kTwos);
    const long n = place_ / 4;
    return step == place_ % 4 && number == (is_two ? n % kTwos : n % kOnes);
  }

  const Trace& trace_;
  long place_ = -1;
  long one_ = -1;
};

std::string RingVariable(std::uint64_t bytes) {
  return bytes == 0 ? "" : "export STIPPLE_MAX_BYTES=" + std::to_string(bytes) + ";";
}

std::uint64_t OverwrittenOf(const Trace& trace, const Location& l) {
  for (const stipple::Overwritten& o : trace.ProcessOf(l).stream->overwritten)
    if (o.thread == l.stream->thread) return o.events;
  return 0;
}

/// All that is wrong but for what a kill leaves: a process without an end, slots that were
/// reserved.
std::string ProblemsBeyondKill(const TraceHealth& health) {
  std::string text;
  for (const stipple::Problem& p : health.problems())
    if (p.defect != Defect::kUnclosedProcess && p.defect != Defect::kUncommitted &&
        p.defect != Defect::kEnterWithoutLeave)
      text += TextOf(p) + "\n";
  return text;
}

/// The writer in a process group of its own, killed as a whole after `ms` of work.
void RunAndKill(const std::string& archive, const std::string& behaviour, const std::string& file,
                std::uint64_t ring_bytes, int us) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t writer = fork();
  if (writer == 0) {
    setpgid(0, 0);
    setenv("STIPPLE_ARCHIVE", archive.c_str(), 1);
    if (ring_bytes != 0) setenv("STIPPLE_MAX_BYTES", std::to_string(ring_bytes).c_str(), 1);
    execl(STIPPLE_WRITER, "writer", behaviour.c_str(), "0", file.c_str(), nullptr);
    _exit(1);
  }
  setpgid(writer, writer);
  const auto progress_of = [&file](int i) {
    const std::string bytes = ReadAll(file);
    const auto* p = reinterpret_cast<const stipple_test::Progress*>(bytes.data());
    return bytes.size() < 4096 ? 0 : p[i].visits.load();
  };
  for (int i = 0; i < 4; ++i)
    while (progress_of(i) == 0) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::microseconds(us));
  kill(-writer, SIGKILL);
  // The others of the group have lost their parent, and this process stands in for it.
  while (waitpid(-writer, nullptr, 0) > 0) {
  }
}

/// Nothing that was committed is lost or misread; nothing but whole visits is missing at the begin.
void CheckKilled(const std::string& archive, const std::string& file, std::uint64_t ring_bytes) {
  const std::string bytes = ReadAll(file);
  const auto* progress = reinterpret_cast<const stipple_test::Progress*>(bytes.data());
  const Trace trace = Trace::Open(archive);
  EXPECT_EQ(ProblemsBeyondKill(Analysis(trace).health), "");
  int writers = 0;
  for (const Location& l : trace.locations()) {
    const Seen seen = PatternReader(trace).Read(l);
    EXPECT_EQ(seen.mistakes, 0u);
    for (int i = 0; i < 4; ++i) {
      if (progress[i].tid != static_cast<long>(l.stream->tid)) continue;
      ++writers;
      const auto published = 4 * static_cast<std::uint64_t>(progress[i].visits.load());
      const std::uint64_t overwritten = OverwrittenOf(trace, l);
      EXPECT_GE(seen.events + overwritten, published);
      // A ring killed while it drops a chunk may count that one although it is there.
      const std::uint64_t once_more = overwritten == 0 ? 0 : ring_bytes / 64 / 8;
      EXPECT_LE(seen.events + overwritten, published + 4 + once_more);
    }
  }
  EXPECT_EQ(writers, 4);
}

void KillManyTimes(const std::string& behaviour, std::uint64_t ring_bytes) {
  const int runs = IsFull() ? 100 : 4;
  std::mt19937 random(std::random_device{}());
  for (int run = 0; run < runs && !testing::Test::HasFailure(); ++run) {
    const Directory archive, scratch;
    const std::string file = scratch.path() + "/progress";
    const int us = std::uniform_int_distribution<int>(0, 60'000)(random);
    RunAndKill(archive.path(), behaviour, file, ring_bytes, us);
    SCOPED_TRACE(behaviour + " after " + std::to_string(us) + " us");
    CheckKilled(archive.path(), file, ring_bytes);
  }
}

TEST(Kill, OfThreadsLosesNothingCommitted) { KillManyTimes("killed-threads", 0); }
TEST(Kill, OfProcessesLosesNothingCommitted) { KillManyTimes("killed-processes", 0); }
TEST(Kill, OfThreadsWithARingLosesNothingCommitted) {
  KillManyTimes("killed-threads", 2 * kMegabyte);
}
TEST(Kill, OfProcessesWithARingLosesNothingCommitted) {
  KillManyTimes("killed-processes", kMegabyte);
}

std::uint64_t BytesOf(const std::string& archive) {
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(archive)) bytes += entry.file_size();
  return bytes;
}

std::uint64_t CallsOf(const Analysis& analysis, const std::string& region) {
  std::uint64_t calls = 0;
  for (const stipple::LocationProfile& profile : analysis.profiles)
    for (const stipple::RegionTime& t : profile)
      if (analysis.trace.regions()[t.region].name == region) calls += t.calls;
  return calls;
}

double InclusiveOf(const Analysis& analysis, const std::string& region) {
  double ns = 0;
  for (const stipple::LocationProfile& profile : analysis.profiles)
    for (const stipple::RegionTime& t : profile)
      if (analysis.trace.regions()[t.region].name == region) ns += t.inclusive_ns;
  return ns;
}

TEST(Ring, KeepsTheLastPartAndCountsTheRest) {
  for (const std::uint64_t bytes : {kMegabyte, 3 * kMegabyte, 16 * kMegabyte}) {
    const Directory archive;
    const auto run = RunWriter(archive.path(), "return 1500000", RingVariable(bytes));
    EXPECT_EQ(run.status, kStatus);
    EXPECT_EQ(run.output + run.errors, "done\n");
    EXPECT_LE(BytesOf(archive.path()), bytes + 3 * stipple::kGranuleBytes);
    const Trace trace = Trace::Open(archive.path());
    const Analysis analysis(trace);
    EXPECT_TRUE(analysis.health.Sound());
    ASSERT_EQ(trace.locations().size(), 1u);
    const Seen seen = PatternReader(trace).Read(trace.locations().front());
    EXPECT_EQ(seen.mistakes, 0u);
    EXPECT_GT(seen.events, bytes / 8 * 9 / 10);
    ASSERT_TRUE(trace.kept());
    EXPECT_EQ(seen.events + trace.kept()->overwritten_events, 4u * 1'500'000);
    EXPECT_EQ(trace.EventCount(), seen.events);
    EXPECT_GT(trace.kept()->from_s, 0);
  }
}

TEST(Ring, ThatIsNotFullKeepsAll) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "return 10000", RingVariable(kMegabyte)).status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(Analysis(trace).health.Sound());
  EXPECT_FALSE(trace.kept());
  EXPECT_EQ(trace.EventCount(), 40'000u);
}

TEST(Ring, OpenVisitsCountFromWhereItBegins) {
  const Directory archive;
  RunWriter(archive.path(), "nested 50", RingVariable(kMegabyte));
  const Trace trace = Trace::Open(archive.path());
  const Analysis analysis(trace);
  EXPECT_TRUE(analysis.health.Sound());
  // one49 was entered once, long before; it is open for all of the time, and no call of it is left
  // but the visits inside.
  const double span_ns = static_cast<double>(trace.SpanNs());
  EXPECT_NEAR(InclusiveOf(analysis, "one49"), span_ns, 1e-3 * span_ns);
  EXPECT_LT(CallsOf(analysis, "one49"), trace.EventCount() / 4 / kOnes + 2);
}

TEST(Ring, KnowsTheInnermostOfVeryManyOpenVisits) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "nested 20000", RingVariable(kMegabyte)).status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(Analysis(trace).health.Sound());
  EXPECT_EQ(trace.EventCount() + trace.kept()->overwritten_events, 2u * 20000 + 4u * 2'000'000);
}

TEST(Ring, FollowsJumpsToWhereTheyLead) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "jumps 200000", RingVariable(kMegabyte)).status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(Analysis(trace).health.Sound());
  // After the last jump only one0 is open, not one1 and one2: two visits inside at most.
  const double span_ns = static_cast<double>(trace.SpanNs());
  const Analysis analysis(trace);
  EXPECT_NEAR(InclusiveOf(analysis, "one0"), span_ns, 1e-3 * span_ns);
  EXPECT_LT(InclusiveOf(analysis, "one1"), 0.5 * span_ns);
  EXPECT_LT(InclusiveOf(analysis, "one2"), 0.5 * span_ns);
}

TEST(Ring, ASilentThreadKeepsItsLastChunk) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "silent 1000000", RingVariable(kMegabyte)).status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  const Analysis analysis(trace);
  EXPECT_TRUE(analysis.health.Sound());
  ASSERT_EQ(trace.locations().size(), 2u);
  EXPECT_EQ(PatternReader(trace).Read(trace.locations().front()).events, 2u);
  // Its one visit was entered before what is kept began.
  EXPECT_NEAR(static_cast<double>(trace.locations().front().begin_ns), 0, 1);
}

TEST(Ring, ServesMoreThreadsThanItHasPlaces) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "thread-by-thread 1000", RingVariable(kMegabyte)).status,
            kStatus);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(Analysis(trace).health.Sound());
  EXPECT_EQ(trace.EventCount() + trace.kept()->overwritten_events, 1000u * 4000 + 1000u * 2);
  EXPECT_LE(BytesOf(archive.path()), 2 * kMegabyte);  // definitions of 1000 threads included
}

TEST(Ring, WithoutAFreePlaceCountsWhatItLoses) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "many-threads 100", RingVariable(kMegabyte));
  ASSERT_EQ(run.status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  const TraceHealth health = trace.Health();
  const std::uint64_t lost = health.CountOf(Defect::kLostEvents);
  EXPECT_GE(lost, 36u);  // at least the first visit of each that came too late
  const std::uint64_t overwritten = trace.kept() ? trace.kept()->overwritten_events : 0;
  EXPECT_EQ(trace.EventCount() + overwritten + lost, 100u * 102);
  for (const stipple::Problem& p : health.problems())
    EXPECT_TRUE(p.when || p.defect != Defect::kLostEvents) << TextOf(p);
}

/// A loss has a begin and an end within the run, the begin not before the first event.
void ExpectPlacedLoss(const Trace& trace, const TraceHealth& health) {
  EXPECT_GT(health.CountOf(Defect::kLostEvents), 0u);
  for (const stipple::Problem& p : health.problems()) {
    if (p.defect != Defect::kLostEvents) continue;
    ASSERT_TRUE(p.when) << TextOf(p);
    EXPECT_GT(p.when->from_ns, 0) << TextOf(p);
    EXPECT_GE(p.when->to_ns, p.when->from_ns) << TextOf(p);
    EXPECT_GE(p.when->to_ns, trace.SpanNs()) << TextOf(p);
  }
}

struct FailureRow {
  const char* arguments;
  const char* before;
  const char* said;  // on standard error; null: nothing
};

TEST(Failure, OfADiskIsCountedAndHasItsTime) {
  constexpr FailureRow kRows[] = {
      {"quota 1000000", "", "recording stopped, disk quota exceeded"},
      {"broken-disk 1000000", "", "recording stopped, input/output error"},
      {"return 1000000", "ulimit -f 2048;", "recording stopped, file size limit exceeded"},
  };
  for (const FailureRow& row : kRows) {
    SCOPED_TRACE(row.arguments);
    const Directory archive;
    const RunResult run = RunWriter(archive.path(), row.arguments, row.before);
    ASSERT_NE(run.status, 77) << "no filter of system calls here";
    EXPECT_EQ(run.status, kStatus);
    EXPECT_EQ(run.output, "done\n");
    EXPECT_NE(run.errors.find(row.said), std::string::npos) << run.errors;
    const Trace trace = Trace::Open(archive.path());
    const TraceHealth health = Analysis(trace).health;
    ExpectPlacedLoss(trace, health);
    for (const stipple::Problem& p : health.problems())
      EXPECT_TRUE(p.defect == Defect::kLostEvents) << TextOf(p);
    EXPECT_EQ(PatternReader(trace).Read(trace.locations().front()).mistakes, 0u);
  }
}

TEST(Failure, ADeletedArchiveChangesNothing) {
  const Directory scratch;
  const std::string archive = scratch.path() + "/a.stipple";
  std::filesystem::create_directory(archive);
  const RunResult run = RunWriter(archive, "deleted 1000000");
  EXPECT_EQ(run.status, kStatus);
  EXPECT_EQ(run.output + run.errors, "done\n");
}

TEST(Failure, ADaemonGoesOnBeingRecorded) {
  const Directory archive;
  const RunResult run = RunWriter(archive.path(), "daemon 1000000");
  if (run.status == 77) GTEST_SKIP() << "no such limit can be set here";
  EXPECT_EQ(run.status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  const TraceHealth health = trace.Health();
  const std::uint64_t lost = health.CountOf(Defect::kLostEvents);
  // Without a descriptor left the stream cannot grow: then the rest is lost, and said to be.
  EXPECT_TRUE(trace.EventCount() == 4u * 1'001'000 || lost > 0) << run.errors;
  if (lost > 0) {
    EXPECT_NE(run.errors.find("recording stopped, too many open files"), std::string::npos);
  }
}

TEST(Failure, AJailedProcessLosesTheRestAndSaysSo) {
  const Directory archive;
  const RunResult run = RunWriter(archive.path(), "jailed 1000000");
  if (run.status == 77) GTEST_SKIP() << "only root can change the root directory";
  EXPECT_EQ(run.status, kStatus);
  EXPECT_EQ(run.output, "done\n");
  EXPECT_NE(run.errors.find("recording stopped, no such file or directory"), std::string::npos);
  const Trace trace = Trace::Open(archive.path());
  ExpectPlacedLoss(trace, trace.Health());
}

TEST(Clock, ThatStepsBackIsReportedWithItsTime) {
  for (const std::uint64_t ring : {std::uint64_t{0}, 64 * kMegabyte}) {
    const Directory archive;
    EXPECT_EQ(RunWriter(archive.path(), "clock-back 400000", RingVariable(ring)).status, kStatus);
    const Trace trace = Trace::Open(archive.path());
    const Analysis analysis(trace);
    for (const stipple::Problem& p : analysis.health.problems()) {
      EXPECT_EQ(p.defect, Defect::kClockStep) << TextOf(p);
      EXPECT_TRUE(p.when && p.when->from_ns > 0) << TextOf(p);
    }
    EXPECT_EQ(analysis.health.CountOf(Defect::kClockStep), 1u);
    EXPECT_LT(trace.SpanNs(), 60'000'000'000);  // the step is 15 minutes
    EXPECT_EQ(trace.EventCount(), 8u * 400'000 + 1);
    EXPECT_EQ(PatternReader(trace).Read(trace.locations().front()).events, 8u * 400'000);
  }
}

TEST(Crowd, ThousandsOfThreadsAreAllThere) {
  const int threads = IsFull() ? 4000 : 300;
  const Directory archive;
  const RunResult run = RunWriter(archive.path(), "many-threads " + std::to_string(threads));
  if (run.status == 77) GTEST_SKIP() << "so many threads are not allowed here";
  EXPECT_EQ(run.status, kStatus);
  EXPECT_EQ(run.errors, "");
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(Analysis(trace).health.Sound());
  ASSERT_EQ(trace.locations().size(), static_cast<std::size_t>(threads));
  for (const Location& l : trace.locations()) EXPECT_EQ(PatternReader(trace).Read(l).events, 100u);
}

TEST(Crowd, AHundredMillionEventsAreAllThere) {
  const std::uint64_t visits = IsFull() ? 25'000'000 : 500'000;
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "return " + std::to_string(visits)).status, kStatus);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_TRUE(trace.Health().Sound());
  const Seen seen = PatternReader(trace).Read(trace.locations().front());
  EXPECT_EQ(seen.events, 4 * visits);
  EXPECT_EQ(seen.mistakes, 0u);
}

}  // namespace
