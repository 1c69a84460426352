// SPDX-License-Identifier: MIT
// What an interactive display asks about a run, again and again while it is open. The program that
// has the archive open answers; the library that draws knows only this interface, so it needs no
// reader of its own.
#ifndef STIPPLE_ANALYSIS_STATS_WINDOW_SOURCE_H
#define STIPPLE_ANALYSIS_STATS_WINDOW_SOURCE_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
#include "analysis/stats/visits.h"

namespace stipple {

/// A matched message. Ranks are world ranks.
struct RunMessage {
  std::size_t number = 0;  // of the run: by time of sending, from 0
  int sender = 0;
  int receiver = 0;
  int tag = 0;
  std::uint64_t bytes = 0;
  std::int64_t send_ns = 0;     // the send was entered
  std::int64_t post_ns = 0;     // the receive was posted
  std::int64_t receive_ns = 0;  // the receive was complete
  std::string send_call;        // "MPI_Send"; empty: not known
  std::string receive_call;
};

/// A visit found by its region.
struct FoundVisit {
  int rank = 0;
  VisitSpan visit;
};

/// An MPI call of a rank, and what it waited for.
struct RunCall {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t idle_ns = 0;
  int partner = -1;  // the last to arrive; -1: nobody
  std::uint32_t region = 0;
  std::optional<RunMessage> message;  // that it sent or received, the last one
};

enum class Direction { kForward, kBackward };

class WindowSource {
 public:
  virtual ~WindowSource() = default;

  virtual const std::string& Title() const = 0;    // the traced program
  virtual const std::string& Warning() const = 0;  // of the archive; may be empty
  virtual double EndSeconds() const = 0;           // of the run, which begins at 0
  virtual const std::string& RegionName(std::uint32_t region) const = 0;
  /// All ranks, hosts last.
  virtual const std::vector<int>& Ranks() const = 0;
  /// Events of all ranks in the whole run.
  virtual std::uint64_t EventCount() const = 0;

  /// States of all ranks in [begin_s, end_s), without messages.
  virtual Timeline StatesIn(double begin_s, double end_s, std::size_t columns) const = 0;
  /// Messages that lie at least partly in the span, by time of sending.
  virtual std::uint64_t MessageCount(std::int64_t begin_ns, std::int64_t end_ns) const = 0;
  /// The same one by one; none when there are more than `most`.
  virtual std::vector<RunMessage> MessagesIn(std::int64_t begin_ns, std::int64_t end_ns,
                                             std::size_t most) const = 0;
  virtual VisitsOfSpan VisitsOf(int rank, std::int64_t begin_ns, std::int64_t end_ns,
                                std::size_t most) const = 0;
  /// The MPI call in which the rank was then.
  virtual std::optional<RunCall> CallAt(int rank, std::int64_t time_ns) const = 0;
  /// The nearest enter after (before) `time_ns` of a region whose name contains `text`, on any of
  /// `ranks`; of those at the same moment, `from_rank` is the one to go on from (-1: none), in the
  /// order of `ranks`. Reads only what lies between.
  virtual std::optional<FoundVisit> NextVisit(std::string_view text, const std::vector<int>& ranks,
                                              std::int64_t time_ns, int from_rank,
                                              Direction direction) const = 0;
  /// Messages sent until then: sender = row, receiver = column.
  virtual Table MatrixUntil(std::int64_t time_ns) const = 0;

  /// Slow ones; may be called by another thread than all above.
  virtual Finding FindFinding() const = 0;
  /// A table of `stipple stats`; by rank, if it can be. Empty: there is none of the name.
  virtual Table TableNamed(std::string_view name, bool per_rank) const = 0;
};

/// Answers from an analysis, which must live longer.
std::unique_ptr<WindowSource> MakeWindowSource(const Analysis& analysis);

}  // namespace stipple

#endif
