// SPDX-License-Identifier: MIT
// The runtime's account of open visits against the reader's.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "analysis/trace/call_stack.h"
#include "analysis/trace/scan.h"
#include "runtime/core/open_frames.h"

namespace stipple {
namespace {

constexpr std::uint32_t kRegions = 9;

template <class Record>
void AddRecord(std::vector<EventWord>& words, std::uint64_t ticks, std::uint64_t stack) {
  words.push_back(MakeHeader(Record::kKind, sizeof(Record) / 8, true));
  words.push_back(ticks);
  words.push_back(stack);
}

void Follow(CallStack& stack, const std::vector<EventWord>& words) {
  for (std::size_t i = 0; i < words.size();) {
    if (IsRecord(words[i])) {
      stack.Record(&words[i]);
      i += WordsOf(words[i]);
    } else {
      stack.Function(static_cast<std::uint32_t>(RegionOf(words[i])), IsLeave(words[i]));
      ++i;
    }
  }
}

/// A thread that does anything: enters and leaves in any order, leaves of what is not open
/// included, jumps to points that are alive or were never there.
class RandomThread {
 public:
  explicit RandomThread(unsigned seed) : random_(seed) {}

  std::vector<EventWord> Chunk() {
    std::vector<EventWord> words;
    for (int i = 0; i < 200; ++i) {
      const std::vector<EventWord> event = Event();
      Follow(stack_, event);
      std::erase_if(points_, [this](const auto& point) { return point.second > stack_.depth(); });
      words.insert(words.end(), event.begin(), event.end());
    }
    return words;
  }
  std::uint64_t ticks() const { return ticks_; }

 private:
  std::vector<EventWord> Event() {
    std::vector<EventWord> words;
    ++ticks_;
    const auto what = static_cast<unsigned>(random_() % 100);
    if (what < 4) {
      const std::uint64_t sp = random_() % 8;
      AddRecord<JumpPoint>(words, ticks_, sp);
      points_[sp] = stack_.depth();
    } else if (what < 6) {
      const bool none = points_.empty() || what == 4;
      AddRecord<Unwound>(words, ticks_, none ? 99 : points_.begin()->first);
    } else {
      const RegionId region{1 + static_cast<std::uint32_t>(random_() % (kRegions - 1))};
      words.push_back(MakeEvent(ticks_, what < 45, region));
    }
    return words;
  }

  std::mt19937 random_;
  std::uint64_t ticks_ = 1000;
  CallStack stack_;
  std::map<std::uint64_t, std::size_t> points_;
};

/// A reader that begins with what the runtime says is open goes on as one that has read everything.
TEST(OpenFrames, AReaderThatBeginsWithThemIsWhereOneThatReadAllIs) {
  for (unsigned round = 0; round < 200; ++round) {
    RandomThread thread(round);
    FrameStack frames{};
    CallStack whole;
    for (int chunk = 0; chunk < 5; ++chunk) {
      const std::vector<EventWord> words = thread.Chunk();
      Follow(whole, words);
      const FoldedChunk folded = FoldChunk(frames, words.data(), words.data() + words.size(), 1000);
      EXPECT_TRUE(folded.complete);
      EXPECT_EQ(folded.events, 200u);
      ASSERT_EQ(frames.frames.count, whole.depth());
    }
    alignas(8) char record[64 * 1024];
    const std::uint64_t bytes = WriteFrames(frames, record, sizeof record, thread.ticks());
    const auto* word = reinterpret_cast<const EventWord*>(record);
    ASSERT_EQ(SoundRecordWords(word, word + sizeof record / 8), bytes / 8);
    ASSERT_TRUE(AllOpenKnown(word));
    CallStack rest;
    rest.Begin(word, OpenRegions(word, kRegions));
    for (int chunk = 0; chunk < 3; ++chunk) {
      const std::vector<EventWord> words = thread.Chunk();
      Follow(rest, words);
      Follow(whole, words);
      ASSERT_EQ(rest.depth(), whole.depth());
      if (rest.depth() != 0) {
        ASSERT_EQ(rest.top(), whole.top());
      }
    }
  }
}

TEST(OpenFrames, KeepTheInnermostWhereThereIsNoRoomForAll) {
  std::vector<EventWord> words;
  for (std::uint32_t i = 0; i < 10'000; ++i)
    words.push_back(MakeEvent(i + 1, false, RegionId{1 + i}));
  FrameStack frames{};
  FoldChunk(frames, words.data(), words.data() + words.size(), 1);
  alignas(8) char record[4096];
  WriteFrames(frames, record, sizeof record, 20'000);
  const auto* word = reinterpret_cast<const EventWord*>(record);
  EXPECT_FALSE(AllOpenKnown(word));
  EXPECT_EQ(RecordAt<OpenFrames>(word).depth, 10'000u);
  const std::vector<std::uint32_t> open = OpenRegions(word, kMaxRegion);
  ASSERT_EQ(open.size(), (sizeof record - sizeof(OpenFrames)) / sizeof(OpenFrame));
  EXPECT_EQ(open.back(), 10'000u);
  EXPECT_EQ(open.front(), 10'001u - open.size());
}

TEST(OpenFrames, ASlotThatIsNotWrittenMakesTheChunkIncomplete) {
  const EventWord words[] = {MakeEvent(1, false, RegionId{1}), 0, MakeEvent(3, false, RegionId{2})};
  FrameStack frames{};
  EXPECT_FALSE(FoldChunk(frames, words, words + 3, 1).complete);
  EXPECT_EQ(frames.frames.count, 2u);
}

}  // namespace
}  // namespace stipple
