// SPDX-License-Identifier: MIT
#include "analysis/views/window/timeline_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/mark_groups.h"
#include "analysis/views/mark_names.h"
#include "analysis/views/text.h"
#include "analysis/views/window/shapes.h"

namespace stipple {
namespace {

constexpr std::size_t kMostLines = 400;
constexpr double kLeastPitchForMarks = 24;
constexpr double kMostPitch = 96;
constexpr double kLeastPitchForVisits = 34;
constexpr double kLevelHeight = 14;
constexpr std::size_t kMostVisitsPerRow = 400;
constexpr double kMostEventsLookedAt = 200'000;  // about 1 ms
constexpr double kVisitText = 10;
constexpr double kMostStateHeight = 46;

std::int64_t Ns(double seconds) { return std::llround(seconds * 1e9); }
double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Pale, so that names stand out; neighbours in the list of regions differ.
constexpr Colour kVisitTints[] = {{0xd3, 0xe2, 0xf2}, {0xdc, 0xe6, 0xdd}, {0xe6, 0xdf, 0xee},
                                  {0xe3, 0xe7, 0xeb}, {0xd0, 0xe6, 0xe4}, {0xee, 0xe2, 0xdc}};

Colour TintOf(const std::string& name, std::uint32_t region) {
  if (name.starts_with("MPI_")) return kLoadFill;
  return kVisitTints[region % std::size(kVisitTints)];
}

double DistanceTo(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double length = dx * dx + dy * dy;
  const double t =
      length > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

}  // namespace

std::string ShortName(const std::string& name) {
  // Of "(anonymous namespace)::F(int)" the first parenthesis opens no arguments.
  std::size_t from = name.find_last_of(')');
  if (from == std::string::npos) return name;
  int depth = 0;
  for (std::size_t i = from + 1; i-- > 0;) {
    depth += name[i] == ')' ? 1 : name[i] == '(' ? -1 : 0;
    if (depth == 0) {
      return i > 0 ? name.substr(0, i) : name;
    }
  }
  return name;
}

Effort EffortFor(std::size_t ranks, double width_pixels, bool moving) {
  const auto pixels = static_cast<std::size_t>(std::max(32.0, width_pixels));
  const std::size_t most_cells = moving ? 60'000 : 200'000;
  Effort effort;
  effort.columns =
      std::clamp<std::size_t>(most_cells / std::max<std::size_t>(ranks, 1), 60, pixels);
  if (moving) effort.columns = std::min(effort.columns, std::max<std::size_t>(60, pixels / 2));
  effort.quads = moving ? 3000 : QuadBudgetFor(std::min<std::size_t>(ranks, 128));
  effort.majority = moving;
  return effort;
}

void KeepRanks(Timeline& timeline, const std::vector<int>& ranks) {
  if (timeline.rows.size() == ranks.size()) return;
  std::erase_if(timeline.rows, [&](const TimelineRow& row) {
    return std::ranges::find(ranks, row.rank) == ranks.end();
  });
}

void MakeMajority(Timeline& timeline) {
  for (TimelineRow& row : timeline.rows)
    for (StateShares& shares : row.columns) {
      const auto most = std::ranges::max_element(shares);
      const float sum = shares[0] + shares[1] + shares[2] + shares[3];
      const auto state = static_cast<std::size_t>(most - shares.begin());
      shares = {};
      shares[state] = sum >= 0.5F ? 1.0F : 0.0F;
    }
}

TimelineData AskTimeline(const WindowSource& source, const ViewState& state, const Effort& effort,
                         bool rows_for_visits) {
  TimelineData data;
  const TimeSpan& span = state.visible();
  data.states = source.StatesIn(span.begin_s, span.end_s, effort.columns);
  KeepRanks(data.states, state.ranks());
  const std::int64_t begin_ns = Ns(span.begin_s), end_ns = Ns(span.end_s);
  data.message_count = source.MessageCount(begin_ns, end_ns);
  if (data.message_count <= kMostLines)
    data.messages = source.MessagesIn(begin_ns, end_ns, kMostLines);
  std::erase_if(data.messages, [&](const RunMessage& m) {
    const auto shown = [&](int rank) {
      return std::ranges::find(state.ranks(), rank) != state.ranks().end();
    };
    return !shown(m.sender) && !shown(m.receiver);
  });
  const double expected =
      static_cast<double>(source.EventCount()) * span.length() / state.run().length();
  if (!rows_for_visits || expected > kMostEventsLookedAt) return data;
  for (const TimelineRow& row : data.states.rows) {
    data.visits.push_back(source.VisitsOf(row.rank, begin_ns, end_ns, kMostVisitsPerRow));
    for (const VisitSpan& visit : data.visits.back().visits)
      data.names.try_emplace(visit.region, ShortName(source.RegionName(visit.region)));
  }
  if (std::ranges::none_of(data.visits,
                           [](const VisitsOfSpan& v) { return v.complete && !v.visits.empty(); }))
    data.visits.clear();
  return data;
}

bool TimelinePart::RowsForVisits(std::size_t ranks, const Area& area) {
  return ranks > 0 &&
         (area.height - kAxisHeight) / static_cast<double>(ranks) >= kLeastPitchForVisits;
}

TimelinePart::TimelinePart(const TimelineData& data, const Area& area, int culprit,
                           const Effort& effort)
    : area_(area), begin_s_(data.states.begin_s), end_s_(data.states.end_s) {
  if (data.states.rows.empty()) return;
  for (const TimelineRow& row : data.states.rows) row_rank_.push_back(row.rank);
  PlaceRows(data, area, culprit);
  DrawStates(data, effort);
  DrawMessages(data);
  DrawLetters(data);
}

void TimelinePart::PlaceRows(const TimelineData& data, const Area& area, int culprit) {
  RowGridLimits limits{.top = area.top + 2,
                       .max_pitch = kMostPitch,
                       .max_height = area.height - kAxisHeight - 14,
                       .fill = 0.7};
  const double least = 3;
  const auto rows_for = [&] {
    limits.max_rows = std::max<std::size_t>(1, static_cast<std::size_t>(limits.max_height / least));
    return MakeRowGrid(data.states.rows, culprit, limits);
  };
  grid_ = rows_for();
  axis_ = {begin_s_, end_s_, area.left + AxisLeft(grid_), area.right()};
  const std::vector<MarkName> names = NameMarks(data.states, axis_);
  double above = names.empty() ? 0 : std::min(MarkStrip(names), area.height / 5);
  if (grid_.pitch >= kLeastPitchForMarks && !data.messages.empty()) above += 13;
  limits.top += above;
  limits.max_height -= above;
  grid_ = rows_for();
  axis_.left = area.left + AxisLeft(grid_);
  labels = RowLabels(grid_, axis_.left - 10);
  AddTimeAxis(axis_layer, axis_, grid_.rows.front().y + grid_.height + 4);
  const double top = grid_.rows.front().y, bottom = top + grid_.height + 3;
  std::map<double, double> begin_by_x;
  constexpr std::size_t kMostMarks = 60;
  for (const TimelineMark& mark : data.states.marks) {
    if (begin_by_x.size() >= kMostMarks) break;
    begin_by_x.try_emplace(std::floor(axis_.XOf(mark.time_s)) + 0.5, top - 3);
  }
  for (const MarkName& name : names) {
    const double y = MarkNameY(name, top);
    if (y < area.top - 4) continue;
    double& begin = begin_by_x.try_emplace(name.x, top).first->second;
    begin = std::min(begin, y - 5);
    AddText(axis_layer, {name.x + (name.to_left ? -kMarkNameAside : kMarkNameAside), y}, name.text,
            {.size = kMarkNameSize,
             .colour = kInk,
             .anchor = name.to_left ? Anchor::kEnd : Anchor::kStart});
  }
  for (const auto& [x, begin] : begin_by_x)
    AddLine(axis_layer, {x, begin}, {x, bottom}, kInk, 1, true);
}

double TimelinePart::StateHeight(std::size_t row) const { return bars_.rows[row].height; }

void TimelinePart::DrawStates(const TimelineData& data, const Effort& effort) {
  bars_ = grid_;
  const bool with_visits = !data.visits.empty() && grid_.ranks_per_row == 1;
  for (GridRow& row : bars_.rows) {
    const double most = with_visits ? std::clamp(std::floor(row.height * 0.28), 8.0, 16.0)
                                    : std::min(row.height, kMostStateHeight);
    if (!with_visits) row.y += std::floor((row.height - most) / 2);
    row.height = most;
  }
  if (effort.majority) {
    Timeline majority = data.states;
    MakeMajority(majority);
    states = StateRects(MakeStateRuns(majority, bars_, axis_.width(), effort.quads), bars_, axis_);
  } else {
    states =
        StateRects(MakeStateRuns(data.states, bars_, axis_.width(), effort.quads), bars_, axis_);
  }
  row_visits_.resize(row_rank_.size());
  first_depth_.resize(row_rank_.size());
  if (with_visits) DrawVisits(data);
}

void TimelinePart::DrawVisits(const TimelineData& data) {
  const std::int64_t begin_ns = Ns(begin_s_), end_ns = Ns(end_s_);
  for (std::size_t r = 0; r < data.visits.size(); ++r) {
    row_visits_[r] = data.visits[r].visits;
    std::map<std::uint32_t, std::pair<std::size_t, bool>> by_depth;  // how many; one spans all
    for (const VisitSpan& visit : row_visits_[r]) {
      auto& [count, spans] = by_depth[visit.depth];
      ++count;
      spans = spans || (visit.begin_ns <= begin_ns && visit.end_ns >= end_ns);
    }
    std::uint32_t& first = first_depth_[r];
    first = by_depth.empty() ? 0 : by_depth.begin()->first;
    while (by_depth.contains(first) && by_depth[first].second && by_depth.contains(first + 1))
      ++first;
    for (const VisitSpan& visit : row_visits_[r])
      if (const auto area = AreaOf(r, visit)) AddVisit(*area, data.names.at(visit.region), visit);
  }
}

void TimelinePart::AddVisit(const Area& area, const std::string& name, const VisitSpan& visit) {
  const bool gap = area.width > 3;  // between neighbours
  AddRect(visits, {area.left, area.top, gap ? area.width - 0.7 : area.width, area.height},
          TintOf(name, visit.region));
  const std::string text = area.width < 24 ? "" : ShortenEnd(name, area.width - 6, kVisitText);
  if (!text.empty())
    AddText(visits, {area.left + 3, area.top + area.height / 2}, text,
            {.size = kVisitText, .colour = kInk});
}

std::optional<Area> TimelinePart::AreaOf(std::size_t row, const VisitSpan& visit) const {
  if (row >= first_depth_.size() || row_visits_[row].empty() || visit.depth < first_depth_[row])
    return std::nullopt;
  const std::size_t at = grid_.RowOf(row);
  const double left = std::clamp(XOf(Seconds(visit.begin_ns)), axis_.left, axis_.right);
  const double right = std::clamp(XOf(Seconds(visit.end_ns)), axis_.left, axis_.right);
  const double top = bars_.rows[at].y + bars_.rows[at].height + 1 +
                     kLevelHeight * static_cast<double>(visit.depth - first_depth_[row]);
  if (top + kLevelHeight > grid_.rows[at].y + grid_.pitch - 3) return std::nullopt;
  if (XOf(Seconds(visit.end_ns)) < axis_.left || XOf(Seconds(visit.begin_ns)) > axis_.right)
    return std::nullopt;
  return Area{left, top, std::max(1.0, right - left), kLevelHeight - 1};
}

double TimelinePart::XOf(double time_s) const {
  return axis_.left + (time_s - begin_s_) / (end_s_ - begin_s_) * axis_.width();
}

std::optional<std::size_t> TimelinePart::RowOfRank(int rank) const {
  const auto found = std::ranges::find(row_rank_, rank);
  if (found == row_rank_.end()) return std::nullopt;
  return grid_.RowOf(static_cast<std::size_t>(found - row_rank_.begin()));
}

std::optional<LineShape> TimelinePart::LineOf(const RunMessage& message) const {
  const auto from = RowOfRank(message.sender), to = RowOfRank(message.receiver);
  if (!from || !to || *from == *to) return std::nullopt;
  const GridRow& sender = bars_.rows[*from];
  const GridRow& receiver = bars_.rows[*to];
  const bool down = receiver.y > sender.y;
  Point begin{XOf(Seconds(message.send_ns)), down ? sender.y + sender.height : sender.y};
  Point end{XOf(Seconds(message.receive_ns)), down ? receiver.y : receiver.y + receiver.height};
  if (std::max(begin.x, end.x) < axis_.left || std::min(begin.x, end.x) > axis_.right)
    return std::nullopt;
  const auto cut = [&](Point& p, const Point& other, double x) {
    if (other.x == p.x) return;
    p.y += (other.y - p.y) * (x - p.x) / (other.x - p.x);
    p.x = x;
  };
  for (Point* p : {&begin, &end}) {
    const Point other = p == &begin ? end : begin;
    if (p->x < axis_.left) cut(*p, other, axis_.left);
    if (p->x > axis_.right) cut(*p, other, axis_.right);
  }
  return LineShape{{begin, end}, kSecondary, 1, false, 0.6};
}

void TimelinePart::DrawMessages(const TimelineData& data) {
  drawn_ = data.messages;
  for (const RunMessage& message : drawn_)
    if (auto line = LineOf(message)) messages.shapes.emplace_back(std::move(*line));
}

void TimelinePart::DrawLetters(const TimelineData& data) {
  if (grid_.pitch < kLeastPitchForMarks || grid_.ranks_per_row != 1) return;
  std::vector<std::vector<EventMark>> by_row(grid_.rows.size());
  const auto add = [&](int rank, std::int64_t ns, char letter, std::size_t message) {
    const auto row = RowOfRank(rank);
    const double x = XOf(Seconds(ns));
    if (row && x >= axis_.left && x <= axis_.right) by_row[*row].push_back({x, letter, message});
  };
  for (std::size_t i = 0; i < data.messages.size(); ++i) {
    add(data.messages[i].sender, data.messages[i].send_ns, 's', i);
    add(data.messages[i].receiver, data.messages[i].receive_ns, 'r', i);
  }
  for (std::size_t row = 0; row < by_row.size(); ++row) {
    std::vector<EventMark>& marks = by_row[row];
    std::ranges::stable_sort(marks, {}, &EventMark::x);
    const double y = bars_.rows[row].y - 7;
    for (const MarkGroup& group : GroupMarks(marks)) {
      LetterHit hit{{group.x - 6, y - 7, 12, 14}, {}};
      for (std::size_t k = 0; k < group.count; ++k)
        hit.messages.push_back(marks[group.first + k].message);
      AddText(letters, {group.x, y}, group.text,
              {.size = kMarkSize, .colour = kInk, .bold = true, .anchor = Anchor::kMiddle});
      letter_hits_.push_back(std::move(hit));
    }
  }
}

std::optional<std::size_t> TimelinePart::MessageAt(Point point) const {
  constexpr double kNear = 4;
  for (const LetterHit& hit : letter_hits_)
    if (hit.area.Has(point))
      return *std::ranges::min_element(hit.messages, {}, [&](std::size_t m) {
        return std::min(std::fabs(XOf(Seconds(drawn_[m].send_ns)) - point.x),
                        std::fabs(XOf(Seconds(drawn_[m].receive_ns)) - point.x));
      });
  std::optional<std::size_t> nearest;
  double least = kNear;
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    const auto line = LineOf(drawn_[i]);
    if (!line) continue;
    const double distance = DistanceTo(point, line->points.front(), line->points.back());
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

std::optional<TimelineHit> TimelinePart::At(Point point) const {
  if (grid_.rows.empty() || !area_.Has(point)) return std::nullopt;
  const double top = grid_.rows.front().y;
  if (point.y < top - 14 || point.y > top + grid_.height + 4) return std::nullopt;
  TimelineHit hit;
  std::size_t row = 0;
  while (row + 1 < grid_.rows.size() &&
         point.y >= grid_.rows[row + 1].y - 12 * (grid_.pitch >= kLeastPitchForMarks))
    ++row;
  for (std::size_t k = 0; k < grid_.rows[row].count; ++k)
    hit.rows.push_back(grid_.rows[row].first + k);
  hit.label = point.x < axis_.left - 4;
  hit.time_s = begin_s_ + (std::clamp(point.x, axis_.left, axis_.right) - axis_.left) /
                              axis_.width() * (end_s_ - begin_s_);
  if (hit.label) return hit;
  const std::size_t timeline_row = hit.rows.front();
  const std::vector<VisitSpan>& of_row = row_visits_[timeline_row];
  for (std::size_t i = 0; i < of_row.size(); ++i)
    if (const auto area = AreaOf(timeline_row, of_row[i]); area && area->Has(point)) hit.visit = i;
  const Area bar{axis_.left, bars_.rows[row].y, axis_.width(), bars_.rows[row].height};
  if (!hit.visit && !bar.Has(point)) hit.message = MessageAt(point);
  return hit;
}

Layer StateRects(const StateRuns& runs, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"states", {}};
  const auto x_of = [&](std::size_t column) {
    return axis.left +
           axis.width() * static_cast<double>(column) / static_cast<double>(runs.columns);
  };
  constexpr auto kIdle = static_cast<std::size_t>(State::kIdle);
  for (std::size_t r = 0; r < grid.rows.size(); ++r) {
    const GridRow& row = grid.rows[r];
    const auto y_of = [&](int step) {
      return row.y + row.height - std::round(row.height * 2 * step / runs.steps) / 2;
    };
    const auto add = [&](double left, double right, int low, int high, std::size_t state) {
      const double top = y_of(high);
      AddRect(layer, {left, top, right - left, y_of(low) - top}, kStateColours[state]);
    };
    // The background runs through.
    const std::vector<StateRun>& of_row = runs.rows[r];
    for (std::size_t i = 0; i < of_row.size();) {
      std::size_t end = i + 1;
      while (end < of_row.size() && of_row[end].top[kIdle] == of_row[i].top[kIdle]) ++end;
      if (of_row[i].top[kIdle] > 0)
        add(x_of(of_row[i].begin), x_of(of_row[end - 1].end), 0, of_row[i].top[kIdle], kIdle);
      i = end;
    }
    for (std::size_t s = 0; s < kIdle; ++s)
      for (const StateRun& run : of_row) {
        const int low = s == 0 ? 0 : run.top[s - 1];
        if (run.top[s] > low) add(x_of(run.begin), x_of(run.end), low, run.top[s], s);
      }
  }
  return layer;
}

}  // namespace stipple
