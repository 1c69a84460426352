// SPDX-License-Identifier: MIT
// An archive is read while it is written: each reading is all that was recorded up to some moment,
// without gaps and without defects that are none.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/stats/analysis.h"
#include "analysis/trace/compact.h"
#include "analysis/trace/scan.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::TemporaryArchive;

constexpr std::uint64_t kRegions = 7;          // as live_writer.cpp
constexpr std::uint64_t kVisitsOfCounter = 8;  // likewise

/// A program that records into the archive until it is killed.
class LiveWriter {
 public:
  explicit LiveWriter(const std::string& archive) : pid_(fork()) {
    if (pid_ != 0) return;
    setenv("STIPPLE_ARCHIVE", archive.c_str(), 1);
    setenv("STIPPLE_CLOCK", "exact", 1);
    execl(STIPPLE_LIVE_WRITER, STIPPLE_LIVE_WRITER, nullptr);
    _exit(127);
  }
  ~LiveWriter() { Kill(); }
  LiveWriter(const LiveWriter&) = delete;
  LiveWriter& operator=(const LiveWriter&) = delete;
  void Kill() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

 private:
  pid_t pid_;
};

/// Visits of a thread if it recorded what it had to, in order.
std::optional<std::uint64_t> VisitsOf(const Trace& trace, const Location& l) {
  EventCursor cursor(trace, l);
  std::uint64_t visits = 0;
  bool inside = false;
  while (const Event* e = cursor.Next()) {
    if (e->record != nullptr) {
      if (KindOf(*e->record) != RecordKind::kCounter) return std::nullopt;
      const auto said = static_cast<std::uint64_t>(RecordAt<Counter>(e->record).value);
      if (inside || said % kVisitsOfCounter != 0 || said + 1 != visits) return std::nullopt;
      continue;
    }
    const std::string_view name = trace.regions()[e->region].name;
    if (name == "new") continue;
    if (name != "r" + std::to_string(visits % kRegions) || e->leave != inside) return std::nullopt;
    inside = !inside;
    visits += e->leave ? 1 : 0;
  }
  return visits;
}

/// Visits by thread; any defect fails the test.
std::vector<std::uint64_t> ReadOnce(const std::string& archive) {
  const Trace trace = Trace::Open(archive);
  const Analysis analysis(trace);
  std::vector<std::uint64_t> visits(2);
  for (const Problem& p : analysis.health.problems())
    EXPECT_EQ(p.defect, Defect::kStillRunning) << TextOf(p);
  for (const Location& l : trace.locations()) {
    const std::optional<std::uint64_t> count = VisitsOf(trace, l);
    EXPECT_TRUE(count.has_value()) << "thread " << l.thread;
    visits[static_cast<std::size_t>(l.thread)] = count.value_or(0);
  }
  EXPECT_TRUE(analysis.health.Running());
  return visits;
}

/// Reads one program again and again until its archive is large; the number of readings.
int ReadWhileItGrows(int most) {
  TemporaryArchive archive;
  const LiveWriter writer(archive.path());
  while (std::filesystem::is_empty(archive.path())) usleep(1000);
  std::vector<std::uint64_t> last(2);
  int readings = 0;
  while (readings < most && last[0] < 50'000) {
    const std::vector<std::uint64_t> visits = ReadOnce(archive.path());
    ++readings;
    for (std::size_t t = 0; t < 2; ++t) {
      EXPECT_GE(visits[t], last[t]);
      last[t] = visits[t];
    }
  }
  return readings;
}

// Archives are read young, while their chunks change most, so there are several programs.
TEST(Live, EachReadingIsAllThatWasRecordedUpToThen) {
  for (int readings = 0; readings < 200 && !HasFailure();)
    readings += ReadWhileItGrows(200 - readings);
}

TEST(Live, AStreamThatIsWrittenIsNotCompactedUntilItsProcessIsKilled) {
  TemporaryArchive archive;
  LiveWriter writer(archive.path());
  while (std::filesystem::is_empty(archive.path())) usleep(1000);
  usleep(50'000);
  const std::atomic<bool> stop{false};
  EXPECT_EQ(CompactArchive(archive.path(), archive.path(), stop, nullptr).streams, 0U);
  ReadOnce(archive.path());
  writer.Kill();
  const std::uint64_t events = Trace::Open(archive.path()).EventCount();
  const CompactResult result = CompactArchive(archive.path(), archive.path(), stop, nullptr);
  EXPECT_EQ(result.streams, 1U);
  const Trace trace = Trace::Open(archive.path());
  EXPECT_EQ(trace.EventCount(), events);
  EXPECT_FALSE(trace.Health().Running());
  EXPECT_EQ(trace.Health().CountOf(Defect::kUnclosedProcess), 1U);
  for (const Location& l : trace.locations()) EXPECT_TRUE(VisitsOf(trace, l).has_value());
}

}  // namespace
}  // namespace stipple
