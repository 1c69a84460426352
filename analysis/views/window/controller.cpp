// SPDX-License-Identifier: MIT
#include "analysis/views/window/controller.h"

#include <algorithm>
#include <cmath>

#include "analysis/views/window/facts.h"

namespace stipple {
namespace {

constexpr double kClickPixels = 4;    // a shorter drag is a click
constexpr double kWheelFactor = 0.8;  // of the span, a step
constexpr double kKeyFactor = 0.5;
constexpr double kKeyPan = 0.25;
constexpr std::size_t kMostStack = 4096;

std::int64_t Ns(double seconds) { return std::llround(seconds * 1e9); }

}  // namespace

double Controller::TimeAt(Point at) const {
  const TimeAxis& axis = scene_.timeline().axis();
  if (!(axis.width() > 0)) return state_.visible().begin_s;
  const double share = std::clamp((at.x - axis.left) / axis.width(), 0.0, 1.0);
  return state_.visible().begin_s + share * state_.visible().length();
}

void Controller::Press(Button button, Point at, bool shift) {
  pressed_ = last_ = at;
  shift_ = shift;
  moved_ = false;
  drag_ = Drag::kNone;
  const WindowHit hit = scene_.At(at);
  const bool in_time = hit.what == WindowHit::What::kCurve ||
                       (hit.what == WindowHit::What::kTimeline && !hit.timeline.label);
  if (button == Button::kLeft && hit.what == WindowHit::What::kOverview)
    drag_ = Drag::kOverview;
  else if (in_time)
    drag_ = button == Button::kLeft && !shift ? Drag::kBand : Drag::kPan;
}

void Controller::Move(Point to) {
  if (drag_ == Drag::kNone) return;
  if (!moved_ && std::hypot(to.x - pressed_.x, to.y - pressed_.y) < kClickPixels) return;
  moved_ = true;
  if (drag_ == Drag::kBand) {
    band_ = TimeSpan{TimeAt(pressed_), TimeAt(to)};
  } else if (drag_ == Drag::kPan) {
    PanPixels(last_.x - to.x);
  } else {
    const TimeSpan& visible = state_.visible();
    state_.PanBy(scene_.OverviewTime(to.x) - (visible.begin_s + visible.end_s) / 2);
    moving_ = true;
  }
  last_ = to;
}

void Controller::PanPixels(double pixels) {
  const double width = scene_.timeline().axis().width();
  if (!(width > 0)) return;
  state_.PanBy(pixels / width * state_.visible().length());
  moving_ = true;
}

void Controller::Release(Point at) {
  Move(at);
  const Drag drag = drag_;
  drag_ = Drag::kNone;
  if (!moved_) {
    Click(at);
  } else if (drag == Drag::kBand && band_) {
    state_.Show(*band_);
  }
  band_.reset();
  state_.EndGesture();
}

void Controller::Wheel(Point at, int steps) {
  const WindowHit hit = scene_.At(at);
  const double time_s = hit.what == WindowHit::What::kOverview ? hit.time_s : TimeAt(at);
  state_.ZoomAbout(time_s, std::pow(kWheelFactor, steps));
  moving_ = true;
}

void Controller::Click(Point at) {
  const WindowHit hit = scene_.At(at);
  state_.message.clear();
  switch (hit.what) {
    case WindowHit::What::kOverview: {
      const double half = state_.visible().length() / 2;
      state_.Show({hit.time_s - half, hit.time_s + half});
      break;
    }
    case WindowHit::What::kMenu:
      state_.Toggle(hit.panel);
      break;
    case WindowHit::What::kCurve:
      state_.PutCursor(hit.time_s);
      break;
    case WindowHit::What::kTimeline:
      if (hit.timeline.label)
        ClickLabel(hit.timeline);
      else
        Pick(hit.timeline);
      break;
    case WindowHit::What::kNothing:
      break;
  }
}

void Controller::ClickLabel(const TimelineHit& hit) {
  std::vector<int> ranks;
  for (const std::size_t row : hit.rows) ranks.push_back(scene_.data().states.rows[row].rank);
  if (shift_)
    state_.Hide(ranks);
  else
    state_.NarrowTo(ranks);
}

void Controller::Pick(const TimelineHit& hit) {
  const TimelineData& data = scene_.data();
  Picked picked;
  picked.rank = data.states.rows[hit.rows.front()].rank;
  picked.time_s = hit.time_s;
  const std::int64_t ns = Ns(hit.time_s);
  if (hit.message) {
    picked.message = data.messages[*hit.message];
    state_.picked = std::move(picked);
    return;
  }
  std::optional<VisitSpan> wanted;
  if (hit.visit) wanted = data.visits[hit.rows.front()].visits[*hit.visit];
  std::vector<VisitSpan> around = source_.VisitsOf(picked.rank, ns, ns, kMostStack).visits;
  std::erase_if(around, [&](const VisitSpan& v) {
    return v.begin_ns > ns || v.end_ns < ns || (wanted && v.depth >= wanted->depth);
  });
  std::ranges::stable_sort(around, {}, &VisitSpan::depth);
  if (!wanted && !around.empty()) {
    wanted = around.back();
    around.pop_back();
  }
  picked.visit = wanted;
  for (const VisitSpan& v : around) picked.path.push_back(ShortName(source_.RegionName(v.region)));
  picked.call = source_.CallAt(picked.rank, ns);
  if (picked.call && hit.visit && picked.call->region != wanted->region) picked.call.reset();
  if (picked.call && picked.call->message) picked.message = picked.call->message;
  state_.picked = std::move(picked);
}

void Controller::Search(Direction direction, bool from_view) {
  if (state_.search.empty()) {
    state_.message = "type / and a part of a region's name first";
    return;
  }
  std::int64_t from_ns = Ns(state_.visible().begin_s) - 1;
  int from_rank = -1;
  if (!from_view && state_.picked) {
    from_rank = state_.picked->rank;
    from_ns = state_.picked->visit ? state_.picked->visit->begin_ns : Ns(state_.picked->time_s);
  }
  const auto found =
      source_.NextVisit(state_.search, state_.ranks(), from_ns, from_rank, direction);
  if (!found) {
    state_.message = std::string("no ") + (direction == Direction::kForward ? "later" : "earlier") +
                     " visit of '" + state_.search + "'";
    return;
  }
  state_.message.clear();
  Picked picked;
  picked.rank = found->rank;
  picked.visit = found->visit;
  picked.time_s = static_cast<double>(found->visit.begin_ns) * 1e-9;
  picked.call = source_.CallAt(found->rank, found->visit.begin_ns);
  if (picked.call && picked.call->region != found->visit.region) picked.call.reset();
  if (picked.call) picked.message = picked.call->message;
  state_.Centre({picked.time_s, static_cast<double>(found->visit.end_ns) * 1e-9});
  state_.picked = std::move(picked);
}

void Controller::Type(std::string_view key, char letter) {
  if (key == "Return" || key == "KP_Enter") {
    state_.typing = false;
    Search(Direction::kForward, true);
  } else if (key == "Escape") {
    state_.typing = false;
    state_.search.clear();
  } else if (key == "BackSpace") {
    if (!state_.search.empty()) state_.search.pop_back();
  } else if (letter >= ' ' && letter < 127) {
    state_.search += letter;
  }
}

void Controller::Key(std::string_view key, char letter, bool alt) {
  if (state_.typing) {
    Type(key, letter);
    return;
  }
  const Command command = CommandOf(key, alt);
  if (command == Command::kNone) return;
  state_.message.clear();
  Do(command, key);
}

void Controller::Cancel() {
  if (state_.help)
    state_.help = false;
  else if (state_.picked)
    state_.picked.reset();
  else
    state_.RemoveCursor();
}

void Controller::ZoomToPicked() {
  if (!state_.picked) {
    state_.message = "click something first";
    return;
  }
  const TimeSpan span = SpanOf(*state_.picked);
  const double around = std::max(span.length() * 0.1, kShortestSpan_s);
  state_.Show({span.begin_s - around, span.end_s + around});
}

/// Where the visible span is moved or stretched; false for other commands.
bool Controller::Move(Command command) {
  const TimeSpan visible = state_.visible();
  const double middle = state_.has_cursor() && visible.Has(state_.cursor_s())
                            ? state_.cursor_s()
                            : (visible.begin_s + visible.end_s) / 2;
  switch (command) {
    case Command::kBack:
      if (!state_.Back()) state_.message = "nothing to go back to";
      return true;
    case Command::kForward:
      if (!state_.Forward()) state_.message = "nothing to go forward to";
      return true;
    case Command::kWhole:
      state_.ShowAll();
      return true;
    case Command::kPanLeft:
      state_.PanBy(-kKeyPan * visible.length());
      return true;
    case Command::kPanRight:
      state_.PanBy(kKeyPan * visible.length());
      return true;
    case Command::kNearer:
      state_.ZoomAbout(middle, kKeyFactor);
      return true;
    case Command::kFarther:
      state_.ZoomAbout(middle, 1 / kKeyFactor);
      return true;
    case Command::kZoomToPicked:
      ZoomToPicked();
      return true;
    default:
      return false;
  }
}

void Controller::Do(Command command, std::string_view key) {
  if (Move(command)) return;
  switch (command) {
    default:
      break;
    case Command::kQuit:
      state_.quit = true;
      break;
    case Command::kHelp:
      state_.help = !state_.help;
      break;
    case Command::kCancel:
      Cancel();
      break;
    case Command::kSearch:
      state_.typing = true;
      state_.search.clear();
      break;
    case Command::kNextVisit:
      Search(Direction::kForward, false);
      break;
    case Command::kPreviousVisit:
      Search(Direction::kBackward, false);
      break;
    case Command::kPlay:
      state_.TogglePlay();
      break;
    case Command::kFaster:
      state_.ChangeSpeed(2);
      break;
    case Command::kSlower:
      state_.ChangeSpeed(0.5);
      break;
    case Command::kTogglePanel:
      state_.Toggle(static_cast<Panel>(key.front() - '1'));
      break;
    case Command::kCycleDisplay:
      state_.CycleDisplay();
      break;
    case Command::kCycleStatistic:
      state_.CycleStatistic();
      break;
    case Command::kAllRanks:
      state_.ShowAllRanks();
      break;
    case Command::kPatterns:
      mono = !mono;
      break;
  }
}

}  // namespace stipple
