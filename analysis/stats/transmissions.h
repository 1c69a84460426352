// SPDX-License-Identifier: MIT
// Messages in the network of a simulated machine: when, and how many at a time. A real machine does
// not tell.
#ifndef STIPPLE_ANALYSIS_STATS_TRANSMISSIONS_H
#define STIPPLE_ANALYSIS_STATS_TRANSMISSIONS_H

#include <cstdint>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

/// Whether any rank's machine told of its network.
bool HasTransmissions(const Analysis& analysis);

/// Rows sender, receiver, tag, bytes, network_bytes, sent_s, begin_s, end_s, received_s: when the
/// call that sent it was entered, first byte and last byte in the network, when its receive was
/// complete. In the order of their begins. Of a collective's messages tag, bytes, sent_s and
/// received_s are null.
TableAnswer TransmissionsAnswer(const Analysis& analysis, const Selection& selection,
                                const TableOptions& options);

/// How many messages were in the network, over time.
class NetworkOccupancy {
 public:
  void Add(std::int64_t begin_ns, std::int64_t end_ns);
  /// After the last Add.
  void Finish();
  /// How many there were, on the mean of this span.
  double MeanOver(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  /// Sums wrap around, and so do their differences, which are what counts.
  struct Moments {
    std::vector<std::int64_t> at;     // sorted
    std::vector<std::uint64_t> sums;  // of those before
    std::uint64_t NsSince(std::int64_t ns) const;
  };
  /// Of all messages together: how long they had been in the network by then.
  std::uint64_t NsUntil(std::int64_t ns) const { return begins_.NsSince(ns) - ends_.NsSince(ns); }

  Moments begins_, ends_;
};

/// Calls body(transmission) for each that is sent by a selected rank and whose message is selected;
/// whatever its time.
template <class Body>
void ForEachTransmission(const Analysis& analysis, const Selection& selection, const Body& body) {
  for (const TransmissionEvent& t : analysis.mpi.transmissions) {
    if (!selection.HasRank(t.sender)) continue;
    if (t.send == kNoIndex) {
      if (selection.AllMessages()) body(t);
      continue;
    }
    const SendEvent& send = analysis.mpi.sends[t.send];
    if (selection.HasMessage(send.bytes, send.channel.tag)) body(t);
  }
}

}  // namespace stipple

#endif
