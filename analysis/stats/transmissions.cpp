// SPDX-License-Identifier: MIT
#include "analysis/stats/transmissions.h"

#include <algorithm>
#include <string>
#include <utility>

#include "analysis/stats/number.h"

namespace stipple {
namespace {

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

/// What became of messages whose receipt was seen, summed.
struct Journey {
  std::uint64_t messages = 0;
  double start_s = 0;    // in the call, before the first byte left
  double network_s = 0;  // until the last one was there
  double taken_s = 0;    // until the receive was complete

  void Add(const TransmissionEvent& t, const SendEvent& send, const ReceiveEvent& receive) {
    ++messages;
    start_s += Seconds(t.begin_ns - send.enter_ns);
    network_s += Seconds(t.end_ns - t.begin_ns);
    taken_s += Seconds(receive.complete_ns - t.end_ns);
  }
};

std::string SentenceOf(std::size_t transmissions, const Journey& journey) {
  if (transmissions == 0) return "No transmission was recorded; only simulated machines tell.";
  std::string text = FormatCount(transmissions, "message") + " in the network";
  if (journey.messages == 0) return text + ".";
  const auto mean = [&journey](double seconds) {
    return FormatSeconds(seconds / static_cast<double>(journey.messages));
  };
  return text + "; from send to receipt a message took " +
         mean(journey.start_s + journey.network_s + journey.taken_s) +
         " on the mean: " + mean(journey.start_s) + " to start, " + mean(journey.network_s) +
         " in the network, " + mean(journey.taken_s) + " until it was taken.";
}

std::vector<Cell> RowFor(const Analysis& analysis, const TransmissionEvent& t) {
  std::vector<Cell> row = RowOf(std::int64_t{t.sender}, std::int64_t{t.receiver});
  const SendEvent* send = t.send == kNoIndex ? nullptr : &analysis.mpi.sends[t.send];
  if (send != nullptr) {
    row.emplace_back(std::int64_t{send->channel.tag});
    row.emplace_back(static_cast<std::int64_t>(send->bytes));
  } else {
    row.resize(4);
  }
  row.emplace_back(static_cast<std::int64_t>(t.bytes));
  row.emplace_back(send == nullptr ? Cell{} : Cell{Seconds(send->enter_ns)});
  row.emplace_back(Seconds(t.begin_ns));
  row.emplace_back(Seconds(t.end_ns));
  row.emplace_back(send == nullptr || send->receive == kNoIndex
                       ? Cell{}
                       : Cell{Seconds(analysis.mpi.receives[send->receive].complete_ns)});
  return row;
}

}  // namespace

bool HasTransmissions(const Analysis& analysis) { return !analysis.mpi.transmissions.empty(); }

TableAnswer TransmissionsAnswer(const Analysis& analysis, const Selection& selection,
                                const TableOptions&) {
  std::vector<const TransmissionEvent*> chosen;
  Journey journey;
  ForEachTransmission(analysis, selection, [&](const TransmissionEvent& t) {
    if (!selection.HasTime(t.begin_ns)) return;
    chosen.push_back(&t);
    if (t.send == kNoIndex) return;
    const SendEvent& send = analysis.mpi.sends[t.send];
    if (send.receive != kNoIndex) journey.Add(t, send, analysis.mpi.receives[send.receive]);
  });
  std::ranges::stable_sort(chosen, {}, &TransmissionEvent::begin_ns);
  Table table{"transmissions",
              TableShape::kRows,
              {{"sender"},
               {"receiver"},
               {"tag"},
               {"bytes"},
               {"network_bytes"},
               {"sent_s"},
               {"begin_s"},
               {"end_s"},
               {"received_s"}},
              {}};
  for (const TransmissionEvent* t : chosen) table.rows.push_back(RowFor(analysis, *t));
  return {std::move(table), SentenceOf(chosen.size(), journey)};
}

void NetworkOccupancy::Add(std::int64_t begin_ns, std::int64_t end_ns) {
  begins_.at.push_back(begin_ns);
  ends_.at.push_back(std::max(begin_ns, end_ns));
}

void NetworkOccupancy::Finish() {
  for (Moments* moments : {&begins_, &ends_}) {
    std::ranges::sort(moments->at);
    moments->sums.assign(1, 0);
    for (const std::int64_t ns : moments->at)
      moments->sums.push_back(moments->sums.back() + static_cast<std::uint64_t>(ns));
  }
}

std::uint64_t NetworkOccupancy::Moments::NsSince(std::int64_t ns) const {
  const auto before = static_cast<std::size_t>(std::ranges::lower_bound(at, ns) - at.begin());
  return before * static_cast<std::uint64_t>(ns) - sums[before];
}

double NetworkOccupancy::MeanOver(std::int64_t from_ns, std::int64_t to_ns) const {
  return static_cast<double>(NsUntil(to_ns) - NsUntil(from_ns)) /
         static_cast<double>(to_ns - from_ns);
}

}  // namespace stipple
