// SPDX-License-Identifier: MIT
#include "analysis/stats/channels.h"

#include <map>
#include <optional>
#include <utility>

namespace stipple {
namespace {

struct Traffic {
  std::int64_t messages = 0;
  std::int64_t bytes = 0;
  std::int64_t unmatched = 0;
  std::optional<std::int64_t> late_sender_ns;
  std::int64_t late_receiver_ns = 0;
};

}  // namespace

Table ChannelsTable(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  std::map<std::pair<int, std::uint32_t>, Traffic> traffic;  // by rank, channel
  const auto of = [&](const ThreadMessageEnd& end) -> Traffic* {
    const int rank = trace.locations()[end.location].rank;
    if (!selection.HasRank(rank) || !selection.HasTime(end.time_ns)) return nullptr;
    return &traffic[{rank, end.channel}];
  };
  for (const ThreadMessage& m : analysis.mpi.thread_messages.matched) {
    Traffic* t = of(m.receive);
    if (t == nullptr) continue;
    ++t->messages;
    t->bytes += static_cast<std::int64_t>(m.receive.bytes);
    if (const auto late_ns = m.LateSenderNs())
      t->late_sender_ns = t->late_sender_ns.value_or(0) + *late_ns;
    t->late_receiver_ns += m.LateReceiverNs();
  }
  for (const ThreadMessageEnd& end : analysis.mpi.thread_messages.unmatched)
    if (Traffic* t = of(end)) ++t->unmatched;
  Table table{"channels",
              TableShape::kRows,
              {{"rank"},
               {"channel"},
               {"messages"},
               {"bytes"},
               {"unmatched"},
               {"late_sender_s"},
               {"late_receiver_s"}},
              {}};
  for (const auto& [key, t] : traffic) {
    table.rows.push_back(RowOf(std::int64_t{key.first}, trace.channels()[key.second], t.messages,
                               t.bytes, t.unmatched, Cell{},
                               static_cast<double>(t.late_receiver_ns) * 1e-9));
    if (t.late_sender_ns) table.rows.back()[5] = static_cast<double>(*t.late_sender_ns) * 1e-9;
  }
  return table;
}

TableAnswer ChannelsAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions&) {
  Table table = ChannelsTable(analysis, selection);
  std::int64_t messages = 0;
  for (const auto& row : table.rows) messages += std::get<std::int64_t>(row[2]);
  std::string headline =
      "Threads received " + std::to_string(messages) + " messages from each other.";
  return {std::move(table), std::move(headline)};
}

}  // namespace stipple
