// SPDX-License-Identifier: MIT
// When is everything done? No rank has work, and none is under way in a message. Two methods that
// know nothing of each other, as state machines: what goes in is what a rank sees, what comes out
// are messages to send. They know neither MPI nor rays, so that a test can drive them through any
// order of events.
//
// Both want to know how many work messages a rank has sent and received so far, and whether it is
// passive: without work and without hope of more except by a message. Rank 0 finds the end; who
// tells the others is the caller.
#ifndef STIPPLE_RAYTRACER_PARTITION_TERMINATION_H
#define STIPPLE_RAYTRACER_PARTITION_TERMINATION_H

#include <cstdint>
#include <vector>

namespace stipple::raytracer {

/// What a rank knows of itself.
struct RankState {
  bool passive = false;
  std::int64_t sent = 0, received = 0;  // work messages, ever
};

/// What detectors tell each other. It travels in messages as it is.
struct Signal {
  enum class Kind : std::int32_t { kAsk, kTell, kToken };
  Kind kind;
  std::int32_t to;
  std::int64_t sent = 0, received = 0;  // kToken: `sent` is sent - received, `received` 1 if black
};
using Signals = std::vector<Signal>;

/// Four counters in two equal rounds. Rank 0 asks down a tree; each rank, once it is passive, tells
/// what it and those below have sent and received. The end has come when two rounds, one after the
/// other, tell the same and as much was received as sent. Source: F. Mattern, "Algorithms for
/// distributed termination detection", Distributed Computing 2(3), 1987.
///
/// Late by at most 6 ceil(log2 P) + 2 message times: a round that began too early, and two more.
class FourCounters {
 public:
  /// `equal_rounds`: how many must tell the same. One is too few, which the tests show.
  FourCounters(int rank, int size, int equal_rounds = 2)
      : rank_(rank), size_(size), equal_rounds_(equal_rounds) {}

  /// To be called when the rank has become passive, or has a signal of kind kAsk or kTell.
  void Advance(const RankState& state, Signals& out);
  void Receive(const Signal& signal, const RankState& state, Signals& out);
  /// On rank 0.
  bool ended() const { return ended_; }
  std::int64_t rounds() const { return rounds_; }

 private:
  int Children() const;
  void Ask(Signals& out);

  int rank_, size_, equal_rounds_;
  int equal_ = 0;       // rounds that have told the same, as much received as sent
  bool asked_ = false;  // this round has reached this rank
  int told_ = 0;        // children that have answered
  std::int64_t sent_ = 0, received_ = 0;                  // of those below, in this round
  std::int64_t sent_before_ = -1, received_before_ = -1;  // of all, in the last round
  std::int64_t rounds_ = 0;
  bool ended_ = false;
};

/// Safra's token. It goes round by falling rank and waits at each until the rank is passive; it
/// sums sent - received and turns black at a rank that has received work since it last came by. The
/// end has come when a white token with sum 0 returns to a white, passive rank 0. Source: E.
/// Dijkstra, "Shmuel Safra's version of termination detection", EWD 998, 1987.
///
/// Late by at most 3 P + 2 message times: the rest of a round, a black one, a white one.
class Safra {
 public:
  Safra(int rank, int size);

  void Advance(const RankState& state, Signals& out);
  void Receive(const Signal& signal, const RankState& state, Signals& out);
  bool ended() const { return ended_; }
  std::int64_t rounds() const { return rounds_; }

 private:
  int rank_, size_;
  bool holds_token_, first_ = true;
  std::int64_t sum_ = 0;
  bool token_black_ = true;
  std::int64_t received_before_ = 0;  // when the token was last passed on
  std::int64_t rounds_ = 0;
  bool ended_ = false;
};

}  // namespace stipple::raytracer

#endif
