// SPDX-License-Identifier: MIT
// What a window shows and what its user does to it: the visible span and the way there, the ranks,
// what was clicked, the moment played, the panels. Knows no pixels, no display and no archive, so
// each rule is tested as plain code.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_VIEW_STATE_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_VIEW_STATE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/window_source.h"

namespace stipple {

/// Seconds since the first event.
struct TimeSpan {
  double begin_s = 0;
  double end_s = 0;
  double length() const { return end_s - begin_s; }
  bool Has(double time_s) const { return begin_s <= time_s && time_s <= end_s; }
  friend bool operator==(const TimeSpan&, const TimeSpan&) = default;
};

/// Shorter spans show nothing new: an event lasts longer.
inline constexpr double kShortestSpan_s = 100e-9;

/// Panels under the timeline, in the order of their digits.
enum class Panel {
  kUtilisation,
  kLoad,
  kDials,
  kLeds,
  kKiviat,
  kStatus,
  kStrip,
  kMatrix,
  kContour
};
inline constexpr std::size_t kPanelCount = 9;

/// What the panels of a statistic show; `t` goes to the next.
enum class Statistic { kUtilisation, kSinceStart, kMessages, kBytes, kSwitches };
inline constexpr std::size_t kStatisticCount = 5;

/// What was clicked or found.
struct Picked {
  int rank = -1;
  double time_s = 0;
  std::optional<VisitSpan> visit;
  std::optional<RunCall> call;
  std::optional<RunMessage> message;
  std::vector<std::string> path;  // names of the functions around it, outermost first
};

class ViewState {
 public:
  ViewState(double end_s, std::vector<int> ranks);

  // The visible span. Zooms of the same gesture (a turn of the wheel, a drag) are one step back.
  const TimeSpan& run() const { return run_; }
  const TimeSpan& visible() const { return visible_; }
  void Show(TimeSpan span);                      // a step of its own
  void ZoomAbout(double time_s, double factor);  // < 1: nearer
  void PanBy(double seconds);
  void ShowAll() { Show(run_); }
  void Centre(TimeSpan on);  // `on` in the middle, long enough to see what is around it
  bool Back();
  bool Forward();
  std::size_t StepsBack() const { return back_.size(); }
  /// The next zoom or pan is a step of its own.
  void EndGesture() { gesture_ = Gesture::kNone; }

  // Ranks, as the source lists them.
  const std::vector<int>& ranks() const { return shown_; }
  bool AllRanks() const { return shown_.size() == ranks_.size(); }
  void ShowRanks(std::vector<int> ranks);        // empty or unknown ones: no change
  void NarrowTo(const std::vector<int>& ranks);  // all again if only these are shown
  void Hide(const std::vector<int>& ranks);      // never the last
  void ShowAllRanks() { shown_ = ranks_; }

  // Playing. Speed: seconds of the run in a second.
  double cursor_s() const { return cursor_s_; }
  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  bool has_cursor() const { return has_cursor_; }
  void TogglePlay();
  void ChangeSpeed(double factor);
  void PutCursor(double time_s);
  void RemoveCursor();
  /// `seconds` have passed. Follows the cursor out of the visible span; stops at the end.
  void Advance(double seconds);

  // Panels.
  bool Shows(Panel panel) const { return panels_[static_cast<std::size_t>(panel)]; }
  void Toggle(Panel panel);
  /// The display after the last one shown takes its place.
  void CycleDisplay();
  Statistic statistic() const { return statistic_; }
  void CycleStatistic();

  std::optional<Picked> picked;
  std::string search;   // what `n` looks for
  bool typing = false;  // into `search`
  bool help = false;
  std::string message;  // of the last command: "no visit of ..."
  bool quit = false;

 private:
  enum class Gesture { kNone, kWheel, kPan };
  void Remember(Gesture gesture);
  TimeSpan Within(TimeSpan span) const;

  TimeSpan run_;
  TimeSpan visible_;
  std::vector<TimeSpan> back_, forward_;
  Gesture gesture_ = Gesture::kNone;
  std::vector<int> ranks_, shown_;
  double cursor_s_ = 0;
  double speed_ = 1;
  bool has_cursor_ = false;
  bool playing_ = false;
  std::array<bool, kPanelCount> panels_{};
  Panel last_panel_ = Panel::kDials;
  Statistic statistic_ = Statistic::kUtilisation;
};

}  // namespace stipple

#endif
