// SPDX-License-Identifier: MIT
#include "analysis/views/window/view_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stipple {
namespace {

constexpr std::size_t kMostSteps = 200;
constexpr double kWholeRunPlays_s = 20;  // the speed at first: the visible span in this time
constexpr double kFromMiddle = 0.6;      // a found visit takes this share of the view, at most
constexpr double kAround = 40;           // and at least one part in as many

}  // namespace

ViewState::ViewState(double end_s, std::vector<int> ranks)
    : run_{0, std::max(end_s, kShortestSpan_s)},
      visible_(run_),
      ranks_(std::move(ranks)),
      shown_(ranks_),
      speed_(run_.length() / kWholeRunPlays_s) {
  for (const Panel p : {Panel::kUtilisation, Panel::kLoad, Panel::kDials, Panel::kKiviat,
                        Panel::kStatus, Panel::kMatrix})
    panels_[static_cast<std::size_t>(p)] = true;
}

TimeSpan ViewState::Within(TimeSpan span) const {
  const double length =
      std::clamp(span.length(), std::min(kShortestSpan_s, run_.length()), run_.length());
  const double middle = (span.begin_s + span.end_s) / 2;
  // A span of the length asked for keeps its very begin.
  const double begin = span.length() == length ? span.begin_s : middle - length / 2;
  span.begin_s = std::clamp(begin, run_.begin_s, std::max(run_.begin_s, run_.end_s - length));
  span.end_s = std::min(span.begin_s + length, run_.end_s);
  return span;
}

void ViewState::Remember(Gesture gesture) {
  const bool same = gesture != Gesture::kNone && gesture == gesture_;
  gesture_ = gesture;
  if (same) return;
  back_.push_back(visible_);
  if (back_.size() > kMostSteps) back_.erase(back_.begin());
  forward_.clear();
}

void ViewState::Show(TimeSpan span) {
  if (span.end_s < span.begin_s) std::swap(span.begin_s, span.end_s);
  span = Within(span);
  if (span == visible_) return;
  Remember(Gesture::kNone);
  visible_ = span;
}

void ViewState::ZoomAbout(double time_s, double factor) {
  const double length = std::clamp(visible_.length() * factor,
                                   std::min(kShortestSpan_s, run_.length()), run_.length());
  const double real = length / visible_.length();
  const double at = std::clamp(time_s, visible_.begin_s, visible_.end_s);
  const TimeSpan span =
      Within({at - (at - visible_.begin_s) * real, at + (visible_.end_s - at) * real});
  if (span == visible_) return;
  Remember(Gesture::kWheel);
  visible_ = span;
}

void ViewState::PanBy(double seconds) {
  const double length = visible_.length();
  const double begin = std::clamp(visible_.begin_s + seconds, run_.begin_s,
                                  std::max(run_.begin_s, run_.end_s - length));
  const TimeSpan span{begin, std::min(begin + length, run_.end_s)};
  if (span == visible_) return;
  Remember(Gesture::kPan);
  visible_ = span;
}

void ViewState::Centre(TimeSpan on) {
  const double length = std::clamp(visible_.length(), on.length() / kFromMiddle,
                                   std::max(on.length(), kShortestSpan_s) * kAround);
  const double middle = (on.begin_s + on.end_s) / 2;
  Show({middle - length / 2, middle + length / 2});
}

bool ViewState::Back() {
  EndGesture();
  if (back_.empty()) return false;
  forward_.push_back(visible_);
  visible_ = back_.back();
  back_.pop_back();
  return true;
}

bool ViewState::Forward() {
  EndGesture();
  if (forward_.empty()) return false;
  back_.push_back(visible_);
  visible_ = forward_.back();
  forward_.pop_back();
  return true;
}

void ViewState::ShowRanks(std::vector<int> ranks) {
  std::vector<int> known;
  for (const int rank : ranks_)
    if (std::ranges::find(ranks, rank) != ranks.end()) known.push_back(rank);
  if (!known.empty()) shown_ = std::move(known);
}

void ViewState::NarrowTo(const std::vector<int>& ranks) {
  const std::vector<int> before = shown_;
  ShowRanks(ranks);
  if (shown_ == before) ShowAllRanks();
}

void ViewState::Hide(const std::vector<int>& ranks) {
  std::vector<int> left = shown_;
  std::erase_if(left, [&](int rank) { return std::ranges::find(ranks, rank) != ranks.end(); });
  if (!left.empty()) shown_ = std::move(left);
}

void ViewState::TogglePlay() {
  if (playing_) {
    playing_ = false;
    return;
  }
  if (!has_cursor_ || cursor_s_ >= run_.end_s || !visible_.Has(cursor_s_))
    PutCursor(visible_.begin_s);
  playing_ = true;
}

void ViewState::ChangeSpeed(double factor) {
  speed_ = std::clamp(speed_ * factor, kShortestSpan_s, run_.length() * 4);
}

void ViewState::PutCursor(double time_s) {
  has_cursor_ = true;
  cursor_s_ = std::clamp(time_s, run_.begin_s, run_.end_s);
}

void ViewState::RemoveCursor() {
  has_cursor_ = false;
  playing_ = false;
}

void ViewState::Advance(double seconds) {
  if (!playing_) return;
  cursor_s_ += seconds * speed_;
  if (cursor_s_ >= run_.end_s) {
    cursor_s_ = run_.end_s;
    playing_ = false;
  }
  // No step of the history: back leads to where playing began.
  if (cursor_s_ > visible_.end_s) visible_ = Within({cursor_s_, cursor_s_ + visible_.length()});
}

void ViewState::Toggle(Panel panel) {
  bool& shown = panels_[static_cast<std::size_t>(panel)];
  shown = !shown;
  if (shown) last_panel_ = panel;
}

void ViewState::CycleDisplay() {
  const auto first = static_cast<std::size_t>(Panel::kDials);
  std::size_t next = static_cast<std::size_t>(last_panel_);
  for (std::size_t i = first; i < kPanelCount; ++i) {
    next = next + 1 >= kPanelCount ? first : next + 1;
    if (!panels_[next]) {
      panels_[static_cast<std::size_t>(last_panel_)] = false;
      panels_[next] = true;
      break;
    }
  }
  last_panel_ = static_cast<Panel>(next);
}

void ViewState::CycleStatistic() {
  statistic_ = static_cast<Statistic>((static_cast<std::size_t>(statistic_) + 1) % kStatisticCount);
}

}  // namespace stipple
