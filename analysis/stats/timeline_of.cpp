// SPDX-License-Identifier: MIT
#include "analysis/stats/timeline_of.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace stipple {
namespace {

constexpr std::size_t kMostMarks = 2000;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Bounds of the columns in nanoseconds.
std::vector<double> BoundsOf(const Timeline& timeline, std::size_t columns) {
  std::vector<double> bounds;
  const double begin_ns = timeline.begin_s * 1e9;
  const double width_ns = (timeline.end_s - timeline.begin_s) * 1e9 / static_cast<double>(columns);
  for (std::size_t c = 0; c <= columns; ++c)
    bounds.push_back(begin_ns + width_ns * static_cast<double>(c));
  return bounds;
}

TimelineRow RowOfRank(const Analysis& analysis, int rank, const std::vector<double>& bounds) {
  const Trace& trace = analysis.trace;
  TimelineRow row{trace.RankName(rank), rank, trace.IsHost(rank), {}};
  StateClock clock(analysis, *trace.MainOf(rank));
  StateTimes before = clock.Before(bounds.front());
  for (std::size_t c = 0; c + 1 < bounds.size(); ++c) {
    const StateTimes now = clock.Before(bounds[c + 1]);
    const double width = bounds[c + 1] - bounds[c];
    const auto share = [width](double from, double to) {
      return static_cast<float>(width > 0 ? std::clamp((to - from) / width, 0.0, 1.0) : 0.0);
    };
    StateShares& shares = row.columns.emplace_back();
    shares[static_cast<std::size_t>(State::kUser)] = share(before.user, now.user);
    shares[static_cast<std::size_t>(State::kSystem)] = share(before.system, now.system);
    shares[static_cast<std::size_t>(State::kMessage)] = share(before.message, now.message);
    shares[static_cast<std::size_t>(State::kIdle)] = share(before.idle, now.idle);
    before = now;
  }
  return row;
}

void AddSentBytes(const Analysis& analysis, const std::vector<double>& bounds, Timeline& timeline) {
  std::uint64_t before = BytesOfFirst(analysis, SentBefore(analysis.sums, bounds.front()));
  for (std::size_t c = 1; c < bounds.size(); ++c) {
    // What is sent at the very end belongs to the last column.
    const bool last = c + 1 == bounds.size();
    const double until = last ? std::nextafter(bounds[c], HUGE_VAL) : bounds[c];
    const std::uint64_t now = BytesOfFirst(analysis, SentBefore(analysis.sums, until));
    timeline.sent_bytes.push_back(static_cast<double>(now - before));
    before = now;
  }
}

void AddMessages(const Analysis& analysis, Timeline& timeline) {
  const double begin_ns = timeline.begin_s * 1e9;
  const double end_ns = timeline.end_s * 1e9;
  timeline.message_count = MessagesIn(analysis.sums, begin_ns, end_ns);
  if (timeline.message_count > kDrawnMessages) return;
  std::map<int, std::size_t> row_of_rank;
  for (std::size_t i = 0; i < timeline.rows.size(); ++i) row_of_rank[timeline.rows[i].rank] = i;
  for (const std::size_t i : ListMessagesIn(analysis.sums, begin_ns, end_ns)) {
    const SendEvent& s = analysis.mpi.sends[i];
    const ReceiveEvent& r = analysis.mpi.receives[s.receive];
    timeline.messages.push_back({row_of_rank.at(s.channel.sender),
                                 row_of_rank.at(s.channel.receiver), Seconds(s.enter_ns),
                                 Seconds(r.complete_ns), s.bytes});
  }
}

void AddMarks(const Analysis& analysis, Timeline& timeline) {
  const Trace& trace = analysis.trace;
  for (const MarkEvent& m : analysis.mpi.marks) {
    const double time_s = Seconds(m.time_ns);
    if (time_s < timeline.begin_s || time_s > timeline.end_s) continue;
    if (timeline.marks.size() == kMostMarks) break;
    timeline.marks.push_back(
        {time_s, trace.names()[m.name].text, trace.locations()[m.location].rank});
  }
  std::ranges::stable_sort(timeline.marks, {}, &TimelineMark::time_s);
}

}  // namespace

Timeline TimelineOf(const Analysis& analysis, double begin_s, double end_s, std::size_t columns) {
  Timeline timeline;
  timeline.begin_s = begin_s;
  timeline.end_s = end_s > begin_s ? end_s : begin_s + 1e-9;
  const std::vector<double> bounds = BoundsOf(timeline, columns);
  for (const int rank : analysis.trace.RanksInOrder())
    timeline.rows.push_back(RowOfRank(analysis, rank, bounds));
  AddSentBytes(analysis, bounds, timeline);
  AddMessages(analysis, timeline);
  AddMarks(analysis, timeline);
  return timeline;
}

std::pair<double, double> WorstPeriod(const Timeline& whole, std::size_t parts) {
  const auto messages = [&whole](std::size_t from, std::size_t count) {
    const auto begin = whole.sent_bytes.begin() + static_cast<std::ptrdiff_t>(from);
    return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                       [](double bytes) { return bytes > 0; });
  };
  const std::size_t columns = whole.rows.empty() ? 0 : whole.rows.front().columns.size();
  const std::size_t width = std::max<std::size_t>(1, columns / parts);
  const double column_s =
      columns == 0 ? 0 : (whole.end_s - whole.begin_s) / static_cast<double>(columns);
  std::size_t worst = columns > width ? (columns - width) / 2 : 0;
  double most = 0;
  for (std::size_t begin = 0; begin + width <= columns;
       begin += std::max<std::size_t>(1, width / 4)) {
    double idle = 0;
    for (const TimelineRow& row : whole.rows)
      for (std::size_t c = begin; c < begin + width; ++c)
        idle += static_cast<double>(row.columns[c][static_cast<std::size_t>(State::kIdle)]);
    if (idle <= most * 1.001 || !messages(begin, width)) continue;
    most = idle;
    worst = begin;
  }
  const double begin_s = whole.begin_s + static_cast<double>(worst) * column_s;
  return {begin_s, std::min(whole.end_s, begin_s + static_cast<double>(width) * column_s)};
}

}  // namespace stipple
