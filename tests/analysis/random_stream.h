// SPDX-License-Identifier: MIT
// Streams of one thread made at random, with everything that a reader may meet: recursion, events
// without a clock, times that step back or wrap, words never written, records (open, damaged, too
// long), jumps and contexts, leaves that are missing, regions that are not defined. The same seed
// makes the same stream.
#ifndef STIPPLE_TESTS_ANALYSIS_RANDOM_STREAM_H
#define STIPPLE_TESTS_ANALYSIS_RANDOM_STREAM_H

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <random>
#include <vector>

#include "analysis/trace/stream.h"
#include "stipple/format.h"

namespace stipple::testing {

class RandomStream {
 public:
  static constexpr std::uint32_t kRegions = 40;  // 0 and those from here on are not defined

  /// `odds`: one in so many words begins something odd; 0: nothing does.
  RandomStream(std::uint64_t seed, int odds, std::size_t words) : random_(seed), odds_(odds) {
    thread.end_limit = kMostTicks;
    ticks_ = 1 + Below(4) * (kTimeMask / 3);  // some begin shortly before the low bits wrap
    while (total_ < words) Step();
    Close();
    for (std::vector<EventWord>& chunk : chunks_) {
      Chunk& c = thread.chunks.emplace_back();
      c.ticks = begins_[thread.chunks.size() - 1];
      c.sequence = thread.chunks.size() - 1;
      c.begin = chunk.data();
      c.end = chunk.data() + chunk.size();
    }
  }
  RandomStream(const RandomStream&) = delete;
  RandomStream& operator=(const RandomStream&) = delete;

  ThreadStream thread;
  std::uint64_t last_ticks() const { return ticks_; }

 private:
  std::uint64_t Below(std::uint64_t n) { return random_() % n; }
  bool Odd() { return odds_ != 0 && Below(static_cast<std::uint64_t>(odds_)) == 0; }

  void Word(EventWord word) {
    if (chunks_.empty()) Open();
    chunks_.back().push_back(word);
    ++total_;
  }
  void Open() {
    chunks_.emplace_back();
    begins_.push_back(ticks_);
    left_in_chunk_ = 200 + Below(5000);
  }
  /// Ends the chunk, with words that were never written behind what it has.
  void Close() {
    if (chunks_.empty()) return;
    chunks_.back().insert(chunks_.back().end(), Below(40), 0);
  }

  void Event(bool leave, std::uint32_t region, bool clocked) {
    ticks_ += Below(200) == 0 ? Below(1 << 20) : Below(60);
    Word(MakeEvent(clocked ? std::max<std::uint64_t>(ticks_ & kTimeMask, 1) : 0, leave,
                   RegionId{region}));
  }
  void EnterOrLeave(bool clocked) {
    const bool leave = !stack_.empty() && (stack_.size() >= 50 || Below(2) == 0);
    if (!leave)
      stack_.push_back(static_cast<std::uint32_t>(1 + std::min(Below(kRegions - 1), Below(20))));
    Event(leave, stack_.back(), clocked);
    if (leave) stack_.pop_back();
  }

  template <class R>
  void Record(R record, bool closed = true) {
    ticks_ += Below(30);
    record.header = MakeHeader(R::kKind, sizeof(R) / 8, closed);
    record.ticks = ticks_;
    std::vector<EventWord> words(sizeof(R) / 8);
    std::memcpy(words.data(), &record, sizeof(R));
    for (const EventWord word : words) Word(word);
  }

  /// A counted enter, whose leave comes in its place more often than not.
  void Counted(std::uint32_t region) {
    if (region != 0 && region < kRegions && Below(3) != 0) stack_.push_back(region);
    Record(CountedEnter{0, 0, region, static_cast<CountedPurpose>(Below(3)), Below(5)});
  }

  void Step() {
    if (!chunks_.empty() && chunks_.back().size() >= left_in_chunk_) {
      Close();
      Open();
    }
    if (Odd()) return Oddity();
    EnterOrLeave(true);
  }

  void Oddity() {
    switch (Below(15)) {
      case 0:
        for (std::uint64_t n = 1 + Below(70); n > 0; --n) EnterOrLeave(false);
        return;
      case 1:  // a signal between reservation and clock read
        ticks_ -= std::min(ticks_, Below(100));
        return EnterOrLeave(true);
      case 2:
        return Word(0);
      case 3:
        if (!stack_.empty()) stack_.resize(stack_.size() - 1 - Below(stack_.size()));
        return;  // missing leaves
      case 4:
        return Event(Below(2) == 0, static_cast<std::uint32_t>(1 + Below(kRegions - 1)), true);
      case 5:
        return Event(Below(2) == 0, static_cast<std::uint32_t>(Below(2) * (kRegions + Below(9))),
                     true);
      case 6:
        return Record(Mark{});
      case 7:
        points_.push_back(Below(9));
        return Record(JumpPoint{0, 0, points_.back()});
      case 8:
        return Record(Unwound{0, 0, Below(12)});
      case 9:
        return Record(StackSwitch{0, 0, Below(9), Below(12)});
      case 10:
        return Counted(static_cast<std::uint32_t>(Below(kRegions + 3)));
      case 11:
        return Record(Mark{}, false);
      case 12:
        ticks_ += Below(1 << 30) << Below(12);  // silence, in which the low bits may wrap
        return Record(TimeStamp{});
      case 13:
        if (Below(20) == 0) Word(MakeHeader(RecordKind::kMark, Below(5), true));  // damage
        return;
      default:
        stack_.clear();
        return Record(ThreadEnd{});
    }
  }

  std::mt19937_64 random_;
  int odds_;
  std::uint64_t ticks_ = 0;
  std::size_t total_ = 0;
  std::size_t left_in_chunk_ = 0;
  std::vector<std::uint32_t> stack_;
  std::vector<std::uint64_t> points_;
  std::deque<std::vector<EventWord>> chunks_;
  std::vector<std::uint64_t> begins_;
};

}  // namespace stipple::testing

#endif
