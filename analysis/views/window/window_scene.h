// SPDX-License-Identifier: MIT
// A window's picture for the present state and size, in parts that are made again only when what
// they show has changed, and what lies under a point of it.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_SCENE_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_WINDOW_SCENE_H

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/stats/finding.h"
#include "analysis/stats/window_source.h"
#include "analysis/views/window/displays_part.h"
#include "analysis/views/window/timeline_part.h"
#include "analysis/views/window/view_state.h"
#include "analysis/views/window/window_layout.h"

namespace stipple {

/// Shapes in pixels; the version changes with them.
struct ScenePart {
  Layer layer;
  std::uint64_t version = 0;
  std::string key;  // of all that the layer depends on
};

struct WindowHit {
  enum class What { kNothing, kOverview, kTimeline, kCurve, kMenu } what = What::kNothing;
  double time_s = 0;       // overview, timeline, curve
  TimelineHit timeline{};  // timeline
  Panel panel{};           // menu
};

class WindowScene {
 public:
  explicit WindowScene(const WindowSource& source);

  void SetFinding(Finding finding);
  void SetTables(DisplayTables tables);
  void Resize(double width, double height);

  /// Makes again what has changed. `moving`: quick and coarser. `band`: times that are being
  /// spanned by the mouse.
  std::span<const ScenePart> Update(const ViewState& state, bool moving,
                                    std::optional<TimeSpan> band = {});

  WindowHit At(Point point) const;
  const TimelinePart& timeline() const { return timeline_; }
  const TimelineData& data() const { return data_; }
  const WindowLayout& layout() const { return layout_; }
  /// Of the overview's axis.
  double OverviewTime(double x) const;

 private:
  enum Part {
    kHeader,
    kOverview,
    kOverviewFrame,
    kRows,
    kCurves,
    kDisplays,
    kSide,
    kOverlay,
    kPartCount
  };
  template <class Make>
  void Refresh(Part part, std::string key, Make make);
  void UpdateTimeline(const ViewState& state, bool moving);
  Layer HeaderLayer(const ViewState& state) const;
  Layer OverviewLayer() const;
  Layer OverviewFrame(const ViewState& state) const;
  Layer RowsLayer(const ViewState& state) const;
  Layer CurvesLayer() const;
  Layer DisplaysLayer(const ViewState& state) const;
  Layer SideLayer(const ViewState& state);
  Layer OverlayLayer(const ViewState& state, std::optional<TimeSpan> band) const;
  void AddPicked(Layer& layer, const Picked& picked) const;
  double MomentOfDisplays(const ViewState& state) const;
  int culprit() const { return finding_ ? finding_->culprit : -1; }

  const WindowSource& source_;
  Timeline whole_;
  std::optional<Finding> finding_;
  DisplayTables tables_;
  double moment_ = 0;  // that the displays show
  double width_ = 1400, height_ = 950;
  WindowLayout layout_;
  TimelineData data_;
  WideVisits wide_visits_;
  TimelinePart timeline_;
  std::string data_key_;
  std::vector<std::pair<Area, Panel>> menu_;
  std::array<ScenePart, kPartCount> parts_;
  std::uint64_t versions_ = 0;
};

/// The help over the window: keys and mouse.
Layer HelpLayer(double width, double height);

}  // namespace stipple

#endif
