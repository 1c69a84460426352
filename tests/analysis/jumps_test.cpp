// SPDX-License-Identifier: MIT
// Jumps between frames and stacks: which frames are open, and whose the time is.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "analysis/stats/analysis.h"
#include "analysis/trace/call_stack.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

constexpr std::uint32_t kMain = 1, kWork = 2, kHelp = 3;

class Jumps : public ::testing::Test {
 protected:
  Jumps() {
    stream_.Region(kMain, "main");
    stream_.Region(kWork, "work");
    stream_.Region(kHelp, "help");
    stream_.header.features = static_cast<std::uint64_t>(Feature::kStackSwitches);
    stream_.NewChunk(1000);
  }
  void Enter(std::uint32_t region) { stream_.Enter(region, now_ += 100); }
  void Leave(std::uint32_t region) { stream_.Leave(region, now_ += 100); }
  void Point(std::uint64_t stack) { stream_.Append(JumpPoint{0, now_ += 100, stack}); }
  void Unwind(std::uint64_t stack) { stream_.Append(Unwound{0, now_ += 100, stack}); }
  void Switch(std::uint64_t from, std::uint64_t to) {
    stream_.Append(StackSwitch{0, now_ += 100, from, to});
  }
  void EndThread() { stream_.Append(ThreadEnd{0, now_ += 100}); }

  /// Reads what was written; `sum` is the exclusive time of all regions.
  void Read() {
    stream_.End(now_);
    TemporaryArchive archive;
    archive.Add(stream_);
    const Trace trace = Trace::Open(archive.path());
    const Analysis analysis(trace);
    health = analysis.health;
    for (const RegionTime& t : analysis.profiles.at(0)) {
      times[trace.regions()[t.region].name] = t;
      sum += t.exclusive_ns;
    }
    Follow(trace);
  }

  std::map<std::string, RegionTime> times;
  TraceHealth health;
  double sum = 0;
  std::string text;  // what is open after each event, "|main work|main"

 private:
  void Follow(const Trace& trace) {
    EventCursor cursor(trace, trace.locations().at(0));
    CallStack stack;
    while (const Event* e = cursor.Next()) {
      const std::size_t left = e->record != nullptr ? stack.Record(e->record).size()
                                                    : stack.Function(e->region, e->leave).size();
      text += '|' + std::to_string(stack.context()) + ':' + std::to_string(stack.depth());
      if (left != 0) text += '-' + std::to_string(left);
    }
  }

  StreamWriter stream_{1};
  std::uint64_t now_ = 900;
};

TEST_F(Jumps, ALongjmpPopsToItsPointAmongFramesOfOneName) {
  Enter(kMain);  // 1000
  Enter(kWork);
  Point(0x500);
  Enter(kWork);
  Enter(kWork);   // 1400
  Unwind(0x500);  // 1500: two are left
  Leave(kWork);   // 1600
  Leave(kMain);   // 1700
  Read();
  EXPECT_EQ(text, "|0:1|0:2|0:2|0:3|0:4|0:2-2|0:1|0:0");
  EXPECT_TRUE(health.Sound());
  EXPECT_EQ(times["work"].calls, 3U);
  EXPECT_DOUBLE_EQ(times["work"].inclusive_ns, 500);
  EXPECT_DOUBLE_EQ(times["work"].exclusive_ns, 500);
  EXPECT_DOUBLE_EQ(times["main"].inclusive_ns, 700);
}

TEST_F(Jumps, AStackPointerMeansTheLastPointSetThere) {
  Enter(kMain);
  Point(0x500);
  Enter(kWork);
  Enter(kHelp);
  Point(0x500);
  Enter(kHelp);
  Unwind(0x500);
  Unwind(0x500);
  Leave(kHelp);
  Leave(kWork);
  Leave(kMain);
  Read();
  EXPECT_EQ(text, "|0:1|0:1|0:2|0:3|0:3|0:4|0:3-1|0:3|0:2|0:1|0:0");
  EXPECT_TRUE(health.Sound());
}

TEST_F(Jumps, APointFromBeforeTheFirstEventAndTheEndOfTheThreadLeaveAll) {
  Enter(kWork);
  Unwind(0x900);
  Enter(kMain);
  Enter(kWork);
  Unwind(0);
  Enter(kHelp);  // a destructor
  EndThread();
  Read();
  EXPECT_EQ(text, "|0:1|0:0-1|0:1|0:2|0:0-2|0:1|0:0-1");
  EXPECT_TRUE(health.Sound());
  EXPECT_DOUBLE_EQ(times["help"].inclusive_ns, 100);
  EXPECT_DOUBLE_EQ(sum, 400);  // not what lies between the two halves
}

TEST_F(Jumps, AWaitingContextsTimesStandStill) {
  Enter(kMain);          // 1000
  Switch(0x500, 0x900);  // 1100: a new context
  Enter(kWork);          // 1200
  Enter(kHelp);          // 1300
  Switch(0x880, 0x500);  // 1400
  Enter(kHelp);          // 1500: main's own
  Leave(kHelp);          // 1600
  Switch(0x510, 0x880);  // 1700
  Leave(kHelp);          // 1800
  Leave(kWork);          // 1900
  Switch(0x908, 0x510);  // 2000: its end
  Leave(kMain);          // 2100
  Read();
  EXPECT_EQ(text, "|0:1|1:0|1:1|1:2|0:1|0:2|0:1|1:2|1:1|1:0|0:1|0:0");
  EXPECT_TRUE(health.Sound());
  EXPECT_EQ(times["help"].calls, 2U);
  EXPECT_DOUBLE_EQ(times["main"].inclusive_ns, 500);
  EXPECT_DOUBLE_EQ(times["main"].exclusive_ns, 400);
  EXPECT_DOUBLE_EQ(times["work"].inclusive_ns, 400);
  EXPECT_DOUBLE_EQ(times["work"].exclusive_ns, 200);
  EXPECT_DOUBLE_EQ(times["help"].inclusive_ns, 300);
  EXPECT_DOUBLE_EQ(times["help"].exclusive_ns, 300);
}

TEST_F(Jumps, ALongjmpToAnotherStackSwitchesAndLeavesNothing) {
  Enter(kMain);
  Point(0x500);
  Switch(0x500, 0x900);
  Enter(kWork);
  Point(0x880);
  Unwind(0x500);  // back to main, work waits
  Enter(kHelp);
  Point(0x480);
  Unwind(0x880);  // work goes on, help waits
  Leave(kWork);
  Unwind(0x480);
  Leave(kHelp);
  Leave(kMain);
  Read();
  EXPECT_EQ(text, "|0:1|0:1|1:0|1:1|1:1|0:1|0:2|0:2|1:1|1:0|0:2|0:1|0:0");
  EXPECT_TRUE(health.Sound());
}

TEST_F(Jumps, AnUnseenJumpIsRepairedByTheNextLeaveFurtherOutAndCounted) {
  Enter(kMain);  // 1000
  Enter(kWork);
  Enter(kHelp);
  Enter(kHelp);  // 1300
  Leave(kWork);  // 1400
  Leave(kHelp);  // no longer open
  Leave(kMain);
  Read();
  EXPECT_EQ(text, "|0:1|0:2|0:3|0:4|0:1-2|0:1|0:0");
  EXPECT_EQ(health.CountOf(Defect::kEnterWithoutLeave), 2U);
  EXPECT_EQ(health.CountOf(Defect::kLeaveWithoutEnter), 1U);
  EXPECT_DOUBLE_EQ(times["help"].inclusive_ns, 200);
  EXPECT_DOUBLE_EQ(sum, 600);
}

TEST_F(Jumps, AContextUnwoundWhileAnotherRunsHasWhatItHadThen) {
  Enter(kMain);
  Point(0x500);
  Enter(kWork);
  Switch(0x480, 0x900);
  Enter(kHelp);
  Unwind(0x500);  // to main's point, past where main waited: work is left
  Leave(kMain);
  Read();
  EXPECT_EQ(text, "|0:1|0:1|0:2|1:0|1:1|0:1-1|0:0");
  EXPECT_TRUE(health.Sound());
  EXPECT_DOUBLE_EQ(times["work"].exclusive_ns, 100);
}

TEST_F(Jumps, AMillionFramesAreLeftAtOnce) {
  Enter(kMain);
  Point(0x500);
  for (int i = 0; i < 1000000; ++i) Enter(kWork);
  Unwind(0x500);
  Leave(kMain);
  Read();
  EXPECT_TRUE(text.ends_with("|0:1000001|0:1-1000000|0:0"));
  EXPECT_TRUE(health.Sound());
  EXPECT_EQ(times["work"].calls, 1000000U);
  EXPECT_DOUBLE_EQ(times["work"].inclusive_ns, 1e8);
}

}  // namespace
}  // namespace stipple
