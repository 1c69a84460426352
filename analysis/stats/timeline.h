// SPDX-License-Identifier: MIT
// What the timeline shows: the share of each state in each column of time, per rank, with marks and
// messages.
#ifndef STIPPLE_ANALYSIS_STATS_TIMELINE_H
#define STIPPLE_ANALYSIS_STATS_TIMELINE_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

/// States of a rank's main thread; they sum to its span. Values index StateShares and colour
/// tables.
enum class State { kUser = 0, kSystem = 1, kMessage = 2, kIdle = 3 };
inline constexpr std::size_t kStateCount = 4;

/// Fraction of a time column spent in each State, 0..1; the sum is below 1 where the rank had not
/// begun or had ended.
using StateShares = std::array<float, kStateCount>;

/// One rank's row. The host is last.
struct TimelineRow {
  std::string name;  // "0", "1", ... "host"
  int rank = 0;
  bool is_host = false;
  std::vector<StateShares> columns;
};

/// A moment the program marked, or that the analysis found.
struct TimelineMark {
  double time_s = 0;
  std::string label;
  int rank = 0;
};

/// One matched message, for drawing: rows index Timeline::rows.
struct TimelineMessage {
  std::size_t sender_row = 0;
  std::size_t receiver_row = 0;
  double send_s = 0;     // the send was entered
  double receive_s = 0;  // the receive was complete
  std::uint64_t bytes = 0;
};

/// A span of the run, cut into equal columns. Times are seconds since the first event of the
/// archive.
struct Timeline {
  double begin_s = 0;
  double end_s = 0;
  std::vector<TimelineRow> rows;
  std::vector<TimelineMark> marks;
  std::vector<TimelineMessage> messages;  // at most as many as were asked for
  std::size_t message_count = 0;          // in the span, drawn or not
  std::vector<double> sent_bytes;         // by column: handed to MPI in it
};

}  // namespace stipple

#endif
