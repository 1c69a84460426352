// SPDX-License-Identifier: MIT
#include "raytracer/partition/termination.h"

namespace stipple::raytracer {

// The tree: ranks 2 r + 1 and 2 r + 2 lie below rank r.

int FourCounters::Children() const {
  const int first = 2 * rank_ + 1;
  return (first < size_ ? 1 : 0) + (first + 1 < size_ ? 1 : 0);
}

void FourCounters::Ask(Signals& out) {
  asked_ = true;
  told_ = 0;
  sent_ = received_ = 0;
  for (int child = 0; child < Children(); ++child)
    out.push_back({Signal::Kind::kAsk, 2 * rank_ + 1 + child});
}

void FourCounters::Receive(const Signal& signal, const RankState& state, Signals& out) {
  if (signal.kind == Signal::Kind::kAsk) {
    Ask(out);
  } else {
    sent_ += signal.sent;
    received_ += signal.received;
    ++told_;
  }
  Advance(state, out);
}

void FourCounters::Advance(const RankState& state, Signals& out) {
  if (ended_ || !state.passive) return;
  if (rank_ == 0 && !asked_) Ask(out);
  while (asked_ && told_ == Children()) {
    asked_ = false;
    sent_ += state.sent;
    received_ += state.received;
    if (rank_ != 0) {
      out.push_back({Signal::Kind::kTell, (rank_ - 1) / 2, sent_, received_});
      return;
    }
    ++rounds_;
    const bool same = sent_ == sent_before_ && received_ == received_before_;
    equal_ = sent_ != received_ ? 0 : same ? equal_ + 1 : 1;
    sent_before_ = sent_;
    received_before_ = received_;
    ended_ = equal_ == equal_rounds_;
    if (ended_) return;
    Ask(out);
  }
}

Safra::Safra(int rank, int size) : rank_(rank), size_(size), holds_token_(rank == 0) {}

void Safra::Receive(const Signal& signal, const RankState& state, Signals& out) {
  holds_token_ = true;
  sum_ = signal.sent;
  token_black_ = signal.received != 0;
  Advance(state, out);
}

void Safra::Advance(const RankState& state, Signals& out) {
  if (ended_ || !holds_token_ || !state.passive) return;
  const bool black = state.received != received_before_;
  const std::int64_t own = state.sent - state.received;
  received_before_ = state.received;
  if (rank_ == 0) {
    if (!first_) ++rounds_;
    ended_ = !first_ && !token_black_ && !black && sum_ + own == 0;
    if (size_ == 1) ended_ = own == 0;
    if (ended_) return;
    first_ = false;
    holds_token_ = false;
    out.push_back({Signal::Kind::kToken, size_ - 1, 0, 0});
    return;
  }
  holds_token_ = false;
  out.push_back({Signal::Kind::kToken, rank_ - 1, sum_ + own, token_black_ || black ? 1 : 0});
}

}  // namespace stipple::raytracer
