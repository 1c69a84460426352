// SPDX-License-Identifier: MIT
// Keys and mouse become changes of the state. Knows where things are drawn, but no display: tests
// drive it with points and keys.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_CONTROLLER_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_CONTROLLER_H

#include <optional>
#include <string_view>

#include "analysis/stats/window_source.h"
#include "analysis/views/window/keys.h"
#include "analysis/views/window/view_state.h"
#include "analysis/views/window/window_scene.h"

namespace stipple {

enum class Button { kLeft, kOther };

class Controller {
 public:
  Controller(const WindowSource& source, ViewState& state, WindowScene& scene)
      : source_(source), state_(state), scene_(scene) {}

  void Press(Button button, Point at, bool shift);
  void Move(Point to);
  void Release(Point at);
  /// Positive: nearer.
  void Wheel(Point at, int steps);
  /// `key`: X11's name; `letter`: what it types, 0 if nothing.
  void Key(std::string_view key, char letter, bool alt);

  /// What is being spanned.
  const std::optional<TimeSpan>& band() const { return band_; }
  /// Whether things move, so that quick frames are wanted; until Rest.
  bool moving() const { return moving_; }
  bool dragging() const { return drag_ != Drag::kNone; }
  void Rest() { moving_ = false; }
  bool mono = false;

 private:
  enum class Drag { kNone, kBand, kPan, kOverview };
  void Type(std::string_view key, char letter);
  bool Move(Command command);
  void Do(Command command, std::string_view key);
  void Cancel();
  void ZoomToPicked();
  void Search(Direction direction, bool from_view);
  void Click(Point at);
  void ClickLabel(const TimelineHit& hit);
  void Pick(const TimelineHit& hit);
  void PanPixels(double pixels);
  double TimeAt(Point at) const;

  const WindowSource& source_;
  ViewState& state_;
  WindowScene& scene_;
  Drag drag_ = Drag::kNone;
  Point pressed_{}, last_{};
  bool shift_ = false;
  bool moved_ = false;
  bool moving_ = false;
  std::optional<TimeSpan> band_;
};

}  // namespace stipple

#endif
