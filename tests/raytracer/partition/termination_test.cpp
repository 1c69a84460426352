// SPDX-License-Identifier: MIT
// Ranks, work and messages in virtual time: whatever the order of events, an end is never found
// early, and not late.
#include "raytracer/partition/termination.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <map>
#include <memory>
#include <random>

namespace stipple::raytracer {
namespace {

/// How a run of the little world goes.
struct Chances {
  double message = 0.5;      // that a piece of work makes another one elsewhere; twice tried
  int first_work = 3;        // pieces that rank 0 begins with
  int most_work = 400;       // after so many pieces nothing new is made
  double longest_delay = 0;  // of a message; 0: each takes exactly 1
  double longest_work = 2;
};

template <class Detector>
class LittleWorld {
 public:
  using MakeDetector = std::function<Detector(int rank, int size)>;

  LittleWorld(int size, std::uint64_t seed, Chances chances, const MakeDetector& make)
      : size_(size), chances_(chances), random_(seed), ranks_(static_cast<std::size_t>(size)) {
    for (int rank = 0; rank < size; ++rank)
      ranks_[index(rank)].detector.push_back(make(rank, size));
    for (int i = 0; i < chances.first_work; ++i) Work(static_cast<int>(Below(size)));
    for (int rank = 0; rank < size; ++rank) Look(rank);
  }

  /// Runs until rank 0 says that it is over, or nothing happens any more.
  void Run() {
    while (!events_.empty() && !ended()) {
      const auto next = events_.begin();
      now_ = next->first;
      const std::function<void()> happen = std::move(next->second);
      events_.erase(next);
      happen();
    }
  }

  bool ended() const { return ranks_[0].detector[0].ended(); }
  bool early() const { return ended() && busy_ > 0; }
  /// Since the last piece of work was done.
  double late() const { return now_ - last_work_; }

 private:
  struct Rank {
    std::vector<Detector> detector;  // one; it has no default
    int pieces = 0;                  // of work that it has begun
    std::int64_t sent = 0, received = 0;
  };

  static std::size_t index(int rank) { return static_cast<std::size_t>(rank); }
  std::uint64_t Below(int limit) { return random_() % static_cast<std::uint64_t>(limit); }
  double Share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double Delay() {
    return chances_.longest_delay > 0 ? 0.01 + Share() * chances_.longest_delay : 1;
  }
  void At(double time, std::function<void()> happen) { events_.emplace(time, std::move(happen)); }
  RankState StateOf(int rank) const {
    const Rank& it = ranks_[index(rank)];
    return {it.pieces == 0, it.sent, it.received};
  }

  void Work(int rank) {
    ++busy_;
    ++made_;
    ++ranks_[index(rank)].pieces;
    At(now_ + Share() * chances_.longest_work, [this, rank] { Done(rank); });
  }
  void Done(int rank) {
    for (int i = 0; i < 2; ++i)
      if (made_ < chances_.most_work && Share() < chances_.message)
        Send(rank, static_cast<int>(Below(size_)));
    --busy_;
    --ranks_[index(rank)].pieces;
    last_work_ = now_;
    Look(rank);
  }
  void Send(int from, int to) {
    if (to == from) return Work(from);
    ++busy_;
    ++ranks_[index(from)].sent;
    At(now_ + Delay(), [this, to] {
      --busy_;
      ++ranks_[index(to)].received;
      Work(to);
    });
  }
  void Look(int rank) {
    Signals out;
    ranks_[index(rank)].detector[0].Advance(StateOf(rank), out);
    Deliver(out);
  }
  void Deliver(const Signals& signals) {
    for (const Signal& signal : signals)
      At(now_ + Delay(), [this, signal] {
        Signals out;
        ranks_[index(signal.to)].detector[0].Receive(signal, StateOf(signal.to), out);
        Deliver(out);
      });
  }

  int size_;
  Chances chances_;
  std::mt19937_64 random_;
  std::vector<Rank> ranks_;
  std::multimap<double, std::function<void()>> events_;
  double now_ = 0, last_work_ = 0;
  int busy_ = 0, made_ = 0;  // pieces of work begun or under way; ever begun
};

FourCounters TwoRounds(int rank, int size) { return {rank, size}; }
FourCounters OneRound(int rank, int size) { return {rank, size, 1}; }
Safra Token(int rank, int size) { return {rank, size}; }

struct Tally {
  int early = 0, never = 0;
  double latest = 0;
};

template <class Detector>
Tally Try(int runs, Detector (*make)(int, int), Chances chances, int size_wanted = 0) {
  Tally tally;
  std::mt19937_64 sizes(7);
  for (int run = 0; run < runs; ++run) {
    const int size = size_wanted > 0 ? size_wanted : 2 + static_cast<int>(sizes() % 15);
    chances.message = 0.3 + 0.1 * static_cast<double>(sizes() % 5);
    LittleWorld<Detector> world(size, static_cast<std::uint64_t>(run), chances, make);
    world.Run();
    if (world.early()) ++tally.early;
    if (!world.ended()) ++tally.never;
    if (!world.early()) tally.latest = std::max(tally.latest, world.late());
  }
  return tally;
}

constexpr Chances kUneven{.longest_delay = 30};
constexpr int kRuns = 10000;

TEST(Termination, FourCountersAreNeverEarlyAndAlwaysEnd) {
  const Tally tally = Try(kRuns, TwoRounds, kUneven);
  EXPECT_EQ(tally.early, 0);
  EXPECT_EQ(tally.never, 0);
}

TEST(Termination, SafrasTokenIsNeverEarlyAndAlwaysEnds) {
  const Tally tally = Try(kRuns, Token, kUneven);
  EXPECT_EQ(tally.early, 0);
  EXPECT_EQ(tally.never, 0);
}

// The control: what the tests above look for can be found.
TEST(Termination, OneRoundIsEarlyAtTimes) { EXPECT_GT(Try(kRuns, OneRound, kUneven).early, 0); }

TEST(Termination, TheEndIsFoundSoonAfterTheLastWork) {
  for (const int size : {2, 3, 5, 8, 16, 33, 128}) {
    const int depth = std::bit_width(static_cast<unsigned>(size - 1));
    EXPECT_LE(Try(200, TwoRounds, {}, size).latest, 6 * depth + 2) << size;
    EXPECT_LE(Try(200, Token, {}, size).latest, 3 * size + 2) << size;
  }
}

TEST(Termination, NothingToDoEndsToo) {
  Chances none;
  none.first_work = 0;
  for (const int size : {1, 2, 9}) {
    EXPECT_EQ(Try(1, TwoRounds, none, size).never, 0);
    EXPECT_EQ(Try(1, Token, none, size).never, 0);
  }
}

}  // namespace
}  // namespace stipple::raytracer
