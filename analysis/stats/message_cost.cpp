// SPDX-License-Identifier: MIT
#include "analysis/stats/message_cost.h"

#include <algorithm>
#include <map>
#include <set>

namespace stipple {
namespace {

// Up to so many bytes a message costs about as much as an empty one.
constexpr std::uint64_t kPackedBytes = 4096;

bool BeginsOrEndsMpi(const std::string& region) {
  static const std::set<std::string> kNames = {"MPI_Init", "MPI_Init_thread", "MPI_Finalize"};
  return kNames.contains(region);
}

void CountMessages(const Analysis& analysis, const Selection& selection, MessageCost& cost) {
  const Channel* channel = nullptr;
  std::uint64_t bytes = 0;
  const auto end_channel = [&] {
    if (channel != nullptr) cost.packed += std::max<std::uint64_t>(1, bytes / kPackedBytes);
    bytes = 0;
  };
  for (const SendEvent& s : analysis.mpi.sends) {  // by channel
    if (analysis.trace.IsHost(s.channel.sender) || !selection.HasRank(s.channel.sender) ||
        !selection.HasTime(s.enter_ns))
      continue;
    if (channel == nullptr || *channel != s.channel) {
      end_channel();
      channel = &s.channel;
    }
    ++cost.messages;
    cost.bytes += s.bytes;
    bytes += s.bytes;
  }
  end_channel();
}

}  // namespace

MessageCost CostOfMessages(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  std::map<int, double> by_rank;
  for (const int rank : trace.RanksInOrder())
    if (!trace.IsHost(rank) && selection.HasRank(rank)) by_rank[rank] = 0;
  std::map<std::uint32_t, double> by_region;
  for (std::size_t c = 0; c < analysis.mpi.calls.size(); ++c) {
    const MpiCall& call = analysis.mpi.calls[c];
    const Location& l = trace.locations()[call.location];
    const auto rank = by_rank.find(l.rank);
    if (!l.IsMain() || rank == by_rank.end()) continue;
    const std::int64_t arrival = selection.Clamp(call.begin_ns + analysis.waits[c].idle_ns);
    const double seconds = static_cast<double>(selection.Clamp(call.end_ns) - arrival) * 1e-9;
    if (seconds <= 0 || BeginsOrEndsMpi(trace.regions()[call.region].name)) continue;
    rank->second += seconds;
    by_region[call.region] += seconds;
  }
  MessageCost cost;
  if (by_region.empty()) return cost;
  std::vector<double> seconds;
  for (const auto& [rank, s] : by_rank) seconds.push_back(s);
  const auto median = seconds.begin() + static_cast<std::ptrdiff_t>((seconds.size() - 1) / 2);
  std::ranges::nth_element(seconds, median);
  cost.seconds = *median * static_cast<double>(seconds.size());
  const auto most =
      std::ranges::max_element(by_region, {}, &std::map<std::uint32_t, double>::value_type::second);
  cost.function = trace.regions()[most->first].name;
  CountMessages(analysis, selection, cost);
  return cost;
}

}  // namespace stipple
