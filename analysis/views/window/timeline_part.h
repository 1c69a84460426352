// SPDX-License-Identifier: MIT
// The timeline of a window: one row per rank with its states, the functions visited where single
// events can be told apart, messages as lines with their ends marked; and what lies under a point.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_TIMELINE_PART_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_TIMELINE_PART_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/window_source.h"
#include "analysis/views/axis.h"
#include "analysis/views/row_grid.h"
#include "analysis/views/scene.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/window/view_state.h"
#include "analysis/views/window/wide_visits.h"
#include "analysis/views/window/window_layout.h"

namespace stipple {

/// How much may be drawn: less while things move.
struct Effort {
  std::size_t columns = 1000;
  std::size_t quads = 4000;
  bool majority = false;  // one state per column
};
Effort EffortFor(std::size_t ranks, double width_pixels, bool moving);

/// What the timeline of one span shows.
struct TimelineData {
  Timeline states;                             // rows of the ranks shown
  std::vector<VisitsOfSpan> visits;            // by row; empty: states only
  std::map<std::uint32_t, std::string> names;  // of the visits' regions, short
  std::vector<RunMessage> messages;            // empty: too many, or none
  std::uint64_t message_count = 0;
};
/// `rows_for_visits`: whether rows are tall enough for names. `wide`: of a view that is moved.
TimelineData AskTimeline(const WindowSource& source, const ViewState& state, const Effort& effort,
                         bool rows_for_visits, WideVisits* wide = nullptr);

/// "void ns::Name<int>(long)" as "ns::Name<int>": a name without its arguments.
std::string ShortName(const std::string& name);

/// Other ranks' rows leave the timeline.
void KeepRanks(Timeline& timeline, const std::vector<int>& ranks);

/// What is under a point of the timeline.
struct TimelineHit {
  std::vector<std::size_t> rows;  // of the timeline; several where ranks share a row
  bool label = false;
  double time_s = 0;
  std::optional<std::size_t> message;  // index in TimelineData::messages
  std::optional<std::size_t> visit;    // index in the row's visits
};

/// The timeline laid out.
class TimelinePart {
 public:
  TimelinePart() = default;
  TimelinePart(const TimelineData& data, const Area& area, int culprit, const Effort& effort);

  const RowGrid& grid() const { return grid_; }
  const TimeAxis& axis() const { return axis_; }
  std::optional<TimelineHit> At(Point point) const;
  /// X of a time that may lie outside; not clamped.
  double XOf(double time_s) const;
  /// Where the visit of a row is drawn; none: too deep, or not in view.
  std::optional<Area> AreaOf(std::size_t row, const VisitSpan& visit) const;
  /// From the sender's row to the receiver's, as far as it lies in view.
  std::optional<LineShape> LineOf(const RunMessage& message) const;
  std::optional<std::size_t> RowOfRank(int rank) const;  // of the grid

  Layer states{"states", {}};
  Layer visits{"visits", {}};
  Layer visit_names{"names", {}};  // apart, so that neighbours are painted by one program
  Layer labels{"labels", {}};
  Layer axis_layer{"axis", {}};
  Layer messages{"messages", {}};
  Layer letters{"letters", {}};

  static bool RowsForVisits(std::size_t ranks, const Area& area);

 private:
  struct LetterHit {
    Area area;
    std::vector<std::size_t> messages;
  };
  void PlaceRows(const TimelineData& data, const Area& area, int culprit);
  void DrawStates(const TimelineData& data, const Effort& effort);
  void DrawVisits(const TimelineData& data);
  void AddVisit(const Area& area, const std::string& name, const VisitSpan& visit);
  void DrawMessages(const TimelineData& data);
  void DrawLetters(const TimelineData& data);
  std::optional<std::size_t> MessageAt(Point point) const;
  double StateHeight(std::size_t row) const;

  RowGrid grid_;
  RowGrid bars_;  // rows as tall as their states
  TimeAxis axis_;
  Area area_;
  std::vector<int> row_rank_;               // by row of the timeline
  std::vector<std::uint32_t> first_depth_;  // by row: outer ones span all that is in view
  std::vector<std::vector<VisitSpan>> row_visits_;
  std::vector<RunMessage> drawn_;
  std::vector<LetterHit> letter_hits_;
  double begin_s_ = 0, end_s_ = 0;
};

/// Runs of columns as rectangles, which need no triangulation.
Layer StateRects(const StateRuns& runs, const RowGrid& grid, const TimeAxis& axis);
/// Each column is what most of its time was.
void MakeMajority(Timeline& timeline);

}  // namespace stipple

#endif
