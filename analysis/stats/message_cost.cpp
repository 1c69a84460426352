// SPDX-License-Identifier: MIT
#include "analysis/stats/message_cost.h"

#include <algorithm>
#include <map>
#include <vector>

namespace stipple {
namespace {

// Up to so many bytes a message costs about as much as an empty one.
constexpr std::uint64_t kPackedBytes = 4096;

/// By region: is it a call whose time is that of messages? Not that of the beginning and end of
/// MPI, and of files.
std::vector<bool> AboutMessages(const Trace& trace) {
  std::vector<bool> about;
  for (const Region& r : trace.regions())
    about.push_back(r.kind == RegionKind::kMpi && r.name != "MPI_Init" &&
                    r.name != "MPI_Init_thread" && r.name != "MPI_Finalize" &&
                    !r.name.starts_with("MPI_File_"));
  return about;
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
  const std::vector<bool> about_messages = AboutMessages(trace);
  std::vector<double> by_region(trace.regions().size());
  for (std::size_t c = 0; c < analysis.mpi.calls.size(); ++c) {
    const MpiCall& call = analysis.mpi.calls[c];
    const Location& l = trace.locations()[call.location];
    const auto rank = by_rank.find(l.rank);
    if (!l.IsMain() || rank == by_rank.end()) continue;
    const std::int64_t arrival = selection.Clamp(call.begin_ns + analysis.waits[c].idle_ns);
    const double seconds = static_cast<double>(selection.Clamp(call.end_ns) - arrival) * 1e-9;
    if (seconds <= 0 || !about_messages[call.region]) continue;
    rank->second += seconds;
    by_region[call.region] += seconds;
  }
  MessageCost cost;
  if (by_rank.empty() || by_region.empty()) return cost;
  std::vector<double> seconds;
  for (const auto& [rank, s] : by_rank) seconds.push_back(s);
  const auto median = seconds.begin() + static_cast<std::ptrdiff_t>((seconds.size() - 1) / 2);
  std::ranges::nth_element(seconds, median);
  cost.seconds = *median * static_cast<double>(seconds.size());
  const auto most = std::ranges::max_element(by_region);
  cost.function = trace.regions()[static_cast<std::size_t>(most - by_region.begin())].name;
  CountMessages(analysis, selection, cost);
  return cost;
}

}  // namespace stipple
