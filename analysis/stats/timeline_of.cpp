// SPDX-License-Identifier: MIT
#include "analysis/stats/timeline_of.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace stipple {
namespace {

constexpr std::size_t kMostMarks = 2000;

/// Adds the share that [begin, end) takes of each column.
class Columns {
 public:
  Columns(double begin_s, double end_s, std::size_t count)
      : begin_s_(begin_s),
        width_s_((end_s - begin_s) / static_cast<double>(count)),
        count_(count) {}

  void Add(std::vector<StateShares>& columns, double begin_s, double end_s, State state,
           double sign = 1) const {
    const double last = static_cast<double>(count_);
    const double from = std::clamp((begin_s - begin_s_) / width_s_, 0.0, last);
    const double to = std::clamp((end_s - begin_s_) / width_s_, 0.0, last);
    for (auto c = static_cast<std::size_t>(from); c < count_ && static_cast<double>(c) < to; ++c) {
      const double left = std::max(from, static_cast<double>(c));
      const double right = std::min(to, static_cast<double>(c + 1));
      columns[c][static_cast<std::size_t>(state)] += static_cast<float>(sign * (right - left));
    }
  }

 private:
  double begin_s_;
  double width_s_;
  std::size_t count_;
};

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// Rows of all ranks, filled with user time; `row_of_rank` tells where they are.
void AddRows(const Trace& trace, const Columns& columns, std::size_t count, Timeline& timeline,
             std::map<int, std::size_t>& row_of_rank) {
  for (const int rank : trace.RanksInOrder()) {
    const Location& l = *trace.MainOf(rank);
    row_of_rank[rank] = timeline.rows.size();
    timeline.rows.push_back({trace.RankName(rank), rank, trace.IsHost(rank), {}});
    timeline.rows.back().columns.resize(count);
    columns.Add(timeline.rows.back().columns, Seconds(l.begin_ns), Seconds(l.end_ns), State::kUser);
  }
}

void AddKernelTime(const Analysis& analysis, const Columns& columns,
                   const std::map<int, std::size_t>& row_of_rank, Timeline& timeline) {
  for (const Location& l : analysis.trace.locations()) {
    if (!l.IsMain()) continue;
    std::vector<StateShares>& row = timeline.rows[row_of_rank.at(l.rank)].columns;
    for (const CallSpan& span : analysis.kernel[l.index]) {
      columns.Add(row, Seconds(span.begin_ns), Seconds(span.end_ns), State::kUser, -1);
      columns.Add(row, Seconds(span.begin_ns), Seconds(span.end_ns), State::kSystem);
    }
  }
}

void AddMessages(const Analysis& analysis, const std::map<int, std::size_t>& row_of_rank,
                 Timeline& timeline) {
  for (const SendEvent& s : analysis.mpi.sends) {
    if (s.receive == kNoIndex) continue;
    const ReceiveEvent& r = analysis.mpi.receives[s.receive];
    const double send_s = Seconds(s.enter_ns);
    const double receive_s = Seconds(r.complete_ns);
    if (receive_s < timeline.begin_s || send_s > timeline.end_s) continue;
    const auto sender = row_of_rank.find(s.channel.sender);
    const auto receiver = row_of_rank.find(s.channel.receiver);
    if (sender == row_of_rank.end() || receiver == row_of_rank.end()) continue;
    ++timeline.message_count;
    if (send_s >= timeline.begin_s) {
      const double place = (send_s - timeline.begin_s) / (timeline.end_s - timeline.begin_s);
      const auto column =
          static_cast<std::size_t>(place * static_cast<double>(timeline.sent_bytes.size()));
      timeline.sent_bytes[std::min(column, timeline.sent_bytes.size() - 1)] +=
          static_cast<double>(s.bytes);
    }
    if (timeline.messages.size() <= kDrawnMessages)
      timeline.messages.push_back({sender->second, receiver->second, send_s, receive_s, s.bytes});
  }
  if (timeline.message_count > kDrawnMessages) timeline.messages.clear();
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
  const Trace& trace = analysis.trace;
  Timeline timeline;
  timeline.begin_s = begin_s;
  timeline.end_s = end_s > begin_s ? end_s : begin_s + 1e-9;
  const Columns axis(timeline.begin_s, timeline.end_s, columns);
  std::map<int, std::size_t> row_of_rank;
  AddRows(trace, axis, columns, timeline, row_of_rank);
  for (std::size_t c = 0; c < analysis.mpi.calls.size(); ++c) {
    const MpiCall& call = analysis.mpi.calls[c];
    const Location& l = trace.locations()[call.location];
    if (!l.IsMain()) continue;
    std::vector<StateShares>& row = timeline.rows[row_of_rank[l.rank]].columns;
    const double call_begin_s = Seconds(call.begin_ns);
    const double arrival_s = Seconds(call.begin_ns + analysis.waits[c].idle_ns);
    const double call_end_s = Seconds(call.end_ns);
    axis.Add(row, call_begin_s, call_end_s, State::kUser, -1);
    axis.Add(row, call_begin_s, arrival_s, State::kIdle);
    axis.Add(row, arrival_s, call_end_s, State::kMessage);
  }
  AddKernelTime(analysis, axis, row_of_rank, timeline);
  for (TimelineRow& row : timeline.rows)
    for (StateShares& shares : row.columns)
      for (float& share : shares) share = std::clamp(share, 0.0F, 1.0F);
  timeline.sent_bytes.resize(columns);
  AddMessages(analysis, row_of_rank, timeline);
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
