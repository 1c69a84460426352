// SPDX-License-Identifier: MIT
// The rules for silent threads, under a clock that the test controls.
#include "runtime/core/silence.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace stipple {
namespace {

constexpr std::uint64_t kBegin = 1'000'000'000;

class Silence : public ::testing::Test {
 protected:
  Silence() {
    thread_.chunk = reinterpret_cast<char*>(words_);
    thread_.chunk_bytes = sizeof words_;
    thread_.chunk_end = reinterpret_cast<std::uint64_t>(words_) + sizeof words_;
    thread_.control.cur = reinterpret_cast<std::uint64_t>(words_) + sizeof(ChunkHeader);
    thread_.control.end = thread_.chunk_end;
    process_.threads = &thread_;
  }
  /// An event as instrumented code and the slow path write it; false: it would need a chunk.
  bool Event(std::uint64_t ticks) {
    const std::uint64_t slot = Reserve(thread_.control, sizeof(EventWord));
    auto* place = reinterpret_cast<EventWord*>(slot);
    if (slot >= thread_.control.end) {
      ++slow_;
      place = TakeForced(thread_, sizeof(EventWord), ticks);
      if (place == nullptr && thread_.step != 0) place = Step(thread_, sizeof(EventWord), ticks);
      if (place == nullptr) return false;
    }
    *place = MakeEvent(ticks, false, RegionId{1});
    return true;
  }
  /// Full times of the TimeStamps, and how many words are events; nothing else may be there.
  std::vector<std::uint64_t> Stamps() {
    std::vector<std::uint64_t> stamps;
    events_ = 0;
    const EventWord* end = words_ + sizeof words_ / sizeof(EventWord);
    while (end[-1] == 0) --end;
    for (const EventWord* w = words_ + sizeof(ChunkHeader) / 8; w < end; ++w) {
      if (!IsRecord(*w)) {
        EXPECT_NE(*w, 0u);
        ++events_;
        continue;
      }
      EXPECT_EQ(KindOf(*w), RecordKind::kTimeStamp);
      EXPECT_TRUE(IsClosed(*w));
      stamps.push_back(w[1]);
      w += WordsOf(*w) - 1;
    }
    return stamps;
  }

  EventWord words_[512] = {};
  Thread thread_{};
  Process process_{};
  int slow_ = 0;
  int events_ = 0;
};

TEST_F(Silence, AThreadThatStepsStampsEachLongSilence) {
  BeginStepping(thread_, kBegin);
  std::uint64_t now = kBegin;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Event(now += i == 60 ? std::uint64_t{1} << 41 : 1 << 25));
  EXPECT_EQ(slow_, 100);
  const auto stamps = Stamps();
  ASSERT_EQ(stamps.size(), 1u);
  EXPECT_EQ(stamps[0], kBegin + 60 * (1 << 25) + (std::uint64_t{1} << 41));
  EXPECT_EQ(events_, 100);
}

TEST_F(Silence, AQuickThreadStepsNoLonger) {
  BeginStepping(thread_, kBegin);
  for (unsigned i = 0; i < 100; ++i) ASSERT_TRUE(Event(kBegin + i));
  EXPECT_EQ(slow_, static_cast<int>(kStepEvents));
  EXPECT_TRUE(Stamps().empty());
  EXPECT_EQ(events_, 100);
}

TEST_F(Silence, AFullChunkEndsIt) {
  BeginStepping(thread_, kBegin);
  std::uint64_t now = kBegin;
  int fitted = 0;
  while (Event(now += 1 << 25)) ++fitted;
  EXPECT_EQ(fitted, 512 - 8);
  EXPECT_EQ(thread_.step, 0u);
  EXPECT_EQ(thread_.control.cur, thread_.chunk_end);
}

TEST_F(Silence, AStampThatDoesNotFitWithItsEventLeavesTheRestOfTheChunkEmpty) {
  BeginStepping(thread_, kBegin);
  std::uint64_t now = kBegin;
  for (int i = 0; i < 512 - 8 - 2; ++i) ASSERT_TRUE(Event(now += 1 << 25));
  EXPECT_FALSE(Event(now += std::uint64_t{1} << 41));
  EXPECT_EQ(thread_.waste, thread_.chunk_end - 16);
  EXPECT_EQ(thread_.control.cur, thread_.chunk_end);
}

TEST_F(Silence, TheWatchMakesASilentThreadsNextEventStampItself) {
  ASSERT_TRUE(Event(kBegin));
  WatchRound(process_);
  ASSERT_TRUE(Event(kBegin + 1));
  WatchRound(process_);  // there was an event since
  ASSERT_TRUE(Event(kBegin + 2));
  EXPECT_EQ(slow_, 0);
  WatchRound(process_);
  WatchRound(process_);  // silent
  const std::uint64_t late = kBegin + (std::uint64_t{1} << 41);
  ASSERT_TRUE(Event(late));
  ASSERT_TRUE(Event(late + 1));
  EXPECT_EQ(slow_, 1);
  EXPECT_EQ(Stamps(), std::vector<std::uint64_t>{late});
  EXPECT_EQ(events_, 5);
}

TEST_F(Silence, AForcedEventWithoutRoomForItsStampTakesAChunk) {
  std::uint64_t now = kBegin;
  for (int i = 0; i < 512 - 8 - 2; ++i) ASSERT_TRUE(Event(now += 1));
  WatchRound(process_);
  WatchRound(process_);
  EXPECT_FALSE(Event(now));
  EXPECT_EQ(thread_.control.end, thread_.chunk_end);
}

}  // namespace
}  // namespace stipple
