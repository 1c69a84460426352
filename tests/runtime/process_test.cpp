// SPDX-License-Identifier: MIT
// Begin, fork and every end of a process; disks that are full or not to be written.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "run_writer.h"
#include "walker.h"

namespace {

using stipple_test::Directory;
using stipple_test::ReadAll;
using stipple_test::RunWriter;
using stipple_test::WalkArchive;

bool StartsAndEnds(const std::string& text, const std::string& start, const std::string& end) {
  return text.size() >= start.size() + end.size() && text.compare(0, start.size(), start) == 0 &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

int LineCount(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

struct EndRow {
  const char* arguments;
  int status;         // of the program
  std::uint32_t how;  // ProcessEnd
  std::int32_t end_status;
  std::size_t events;
};

TEST(Process, SaysHowItEnded) {
  constexpr EndRow kRows[] = {{"return 10", 3, 1, 3, 40},
                              {"quick 10", 9, 2, 9, 40},
                              {"_exit 10", 7, 2, 7, 40},
                              {"abort 10", 134, 3, 6, 40},
                              {"exec 10", 0, 4, 0, 80}};
  for (const EndRow& row : kRows) {
    const Directory archive;
    EXPECT_EQ(RunWriter(archive.path(), row.arguments).status, row.status) << row.arguments;
    const auto streams = WalkArchive(archive.path());
    ASSERT_EQ(streams.size(), 1u) << row.arguments;
    EXPECT_TRUE(streams[0].problems.empty()) << row.arguments;
    EXPECT_EQ(streams[0].EventCount(), row.events) << row.arguments;
    ASSERT_EQ(streams[0].ends.size(), 1u) << row.arguments;
    EXPECT_EQ(streams[0].ends[0].how, row.how) << row.arguments;
    EXPECT_EQ(streams[0].ends[0].status, row.end_status) << row.arguments;
    EXPECT_EQ(streams[0].ends[0].lost, 0u) << row.arguments;
  }
}

TEST(Process, AForkedChildHasAStreamOfItsOwn) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "fork 1000").status, 0);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 3u);
  EXPECT_EQ(streams[0].EventCount(), 8000u);
  EXPECT_EQ(streams[1].EventCount(), 8000u);   // fork
  EXPECT_EQ(streams[2].EventCount(), 12000u);  // the system call
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(streams[i].problems.empty());
    EXPECT_EQ(streams[i].header.forked, i == 0 ? 0u : 1u);
    EXPECT_EQ(streams[i].regions, streams[0].regions);
    EXPECT_EQ(streams[i].ends.size(), 1u);
  }
  EXPECT_EQ(streams[1].header.parent_pid, streams[0].header.pid);
}

/// What threads of the writer had finished when they were killed.
struct Progress {
  long tid;
  long rounds;
  char padding[48];
};

TEST(Process, KillLosesNoCommittedEvent) {
  const int runs = std::getenv("STIPPLE_TEST_FULL") != nullptr ? 20 : 3;
  for (int run = 0; run < runs; ++run) {
    const Directory archive, scratch;
    const std::string file = scratch.path() + "/progress";
    const int ms = 20 + 17 * run;
    EXPECT_EQ(RunWriter(archive.path(), "killed " + std::to_string(ms) + " " + file).status, 137);
    const std::string bytes = ReadAll(file);
    const auto streams = WalkArchive(archive.path());
    ASSERT_EQ(streams.size(), 1u);
    EXPECT_TRUE(streams[0].problems.empty());
    EXPECT_TRUE(streams[0].ends.empty());
    for (const auto& [index, thread] : streams[0].threads) {
      const auto* progress = reinterpret_cast<const Progress*>(bytes.data());
      while (progress->tid != static_cast<long>(thread.tid)) ++progress;
      const auto events = thread.Events();
      EXPECT_GE(events.size(), 4 * static_cast<std::size_t>(progress->rounds));
      EXPECT_LE(events.size(), 4 * static_cast<std::size_t>(progress->rounds) + 4);
      constexpr std::uint64_t kRound[] = {1, 2, 2 | stipple::kLeaveBit, 1 | stipple::kLeaveBit};
      for (std::size_t i = 0; i < events.size(); ++i)
        ASSERT_EQ(events[i] & 0xffffff, kRound[i % 4]) << run << ' ' << index << ' ' << i;
    }
  }
}

TEST(Process, WithoutAnArchiveNothingIsWritten) {
  const Directory empty;
  const auto run = RunWriter("", "return 1000", "cd " + empty.path() + ";");
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.errors, "");
  EXPECT_TRUE(std::filesystem::is_empty(empty.path()));
}

TEST(Process, SurvivesALostDescriptor) {
  const Directory archive;
  EXPECT_EQ(RunWriter(archive.path(), "close-all 300000").status, 0);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_EQ(streams[0].EventCount(), 4u + 4 * 300000);
  EXPECT_TRUE(streams[0].problems.empty());
}

TEST(Failure, AMissingArchiveIsSaidInOneLine) {
  const auto run = RunWriter("/nonexistent/a.stipple", "return 1000");
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(
      StartsAndEnds(run.errors, "stipple: runtime_core_writer (pid ",
                    "): nothing recorded, no such file or directory: /nonexistent/a.stipple\n"))
      << run.errors;
  EXPECT_EQ(LineCount(run.errors), 1);
}

TEST(Failure, AFileSizeLimitEndsTheRecordingNotTheProgram) {
  const Directory archive;
  const auto run = RunWriter(archive.path(), "return 1000000", "ulimit -f 2048;");
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(StartsAndEnds(run.errors, "stipple: runtime_core_writer (pid ", "\n"));
  EXPECT_NE(run.errors.find("recording stopped, file size limit exceeded; events lost after "),
            std::string::npos)
      << run.errors;
  EXPECT_EQ(LineCount(run.errors), 1);
  const auto streams = WalkArchive(archive.path());
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_TRUE(streams[0].problems.empty());
  EXPECT_GT(streams[0].EventCount(), 50000u);
  ASSERT_EQ(streams[0].losses.size(), 1u);
  EXPECT_EQ(streams[0].losses[0].error, EFBIG);
  ASSERT_EQ(streams[0].ends.size(), 1u);
  EXPECT_GT(streams[0].ends[0].lost, 0u);
}

/// A file system of 2 MiB, where the tests may mount one.
class SmallDisk : public testing::Test {
 protected:
  void SetUp() override {
    mounted_ = Mount() || (BecomeRootOfOwnMounts() && Mount());
    if (!mounted_) GTEST_SKIP() << "no small file system can be mounted here";
  }
  bool Mount() { return mount("tmpfs", directory_.path().c_str(), "tmpfs", 0, "size=2m") == 0; }
  /// As `unshare -Urm`: without root, where the system allows it.
  static bool BecomeRootOfOwnMounts() {
    const std::string user = std::to_string(getuid()), group = std::to_string(getgid());
    if (unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << "0 " + user + " 1";
    std::ofstream("/proc/self/gid_map") << "0 " + group + " 1";
    return true;
  }
  void TearDown() override {
    if (mounted_) umount(directory_.path().c_str());
  }
  Directory directory_;
  bool mounted_ = false;
};

TEST_F(SmallDisk, FullEndsTheRecordingNotTheProgram) {
  const auto run = RunWriter(directory_.path(), "threads 25000");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(LineCount(run.errors), 1);
  EXPECT_NE(run.errors.find("recording stopped, no space left on device"), std::string::npos)
      << run.errors;
  const auto streams = WalkArchive(directory_.path());
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_TRUE(streams[0].problems.empty());
  EXPECT_EQ(streams[0].losses.size(), 1u);
  EXPECT_EQ(streams[0].ends.size(), 1u);
}

/// Others fill the disk while the stream's pages are mapped: they were allocated, so no write to
/// them can fail.
TEST_F(SmallDisk, FilledByOthersIsNoSignal) {
  const std::string filler = "(sleep 0.01; cat /dev/zero >" + directory_.path() + "/filler) & ";
  const auto run = RunWriter(directory_.path(), "return 3000000", filler);
  EXPECT_EQ(run.status, 3);
  std::filesystem::remove(directory_.path() + "/filler");
  const auto streams = WalkArchive(directory_.path());
  ASSERT_EQ(streams.size(), 1u);
  EXPECT_TRUE(streams[0].problems.empty());
  EXPECT_GT(streams[0].EventCount(), 0u);
}

TEST_F(SmallDisk, ReadOnlyIsSaidInOneLine) {
  ASSERT_EQ(mount("", directory_.path().c_str(), "", MS_REMOUNT | MS_RDONLY, nullptr), 0);
  const auto run = RunWriter(directory_.path(), "return 1000");
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(LineCount(run.errors), 1);
  EXPECT_NE(run.errors.find("nothing recorded, read-only file system"), std::string::npos);
}

}  // namespace
