// SPDX-License-Identifier: MIT
#include "analysis/tools/stopped_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "analysis/stats/number.h"

namespace stipple {
namespace {

struct Open {
  std::uint32_t region = 0;
  std::uint64_t ticks = 0;
};

/// Visits that were not left, outermost first.
std::vector<Open> OpenAtTheEnd(const Trace& trace, const Location& location) {
  std::vector<Open> open;
  EventCursor cursor(trace, location);
  while (const Event* event = cursor.Next()) {
    if (event->record != nullptr) continue;
    if (!event->leave) {
      open.push_back({event->region, event->ticks});
    } else if (!open.empty()) {
      open.pop_back();
    }
  }
  return open;
}

std::string WhereItStopped(const Trace& trace, const Location& location) {
  const std::vector<Open> open = OpenAtTheEnd(trace, location);
  const auto name = [&](const Open& visit) { return trace.regions()[visit.region].name; };
  if (open.empty()) return "had ended";
  const std::string since =
      fmt::format("{} since {:.6f} s", name(open.back()),
                  static_cast<double>(trace.TimeNs(location, open.back().ticks)) * 1e-9);
  if (trace.regions()[open.back().region].kind != RegionKind::kMpi) return "was in " + since;
  if (open.size() == 1) return "waits in " + since;
  return fmt::format("waits in {}, called by {}", since, name(open[open.size() - 2]));
}

}  // namespace

std::string WhereRanksStopped(const Trace& trace, std::size_t most_ranks) {
  const std::vector<int> ranks = trace.RanksInOrder();
  std::string text;
  for (std::size_t i = 0; i < std::min(ranks.size(), most_ranks); ++i)
    text += fmt::format("  rank {}{} {}\n", ranks[i], trace.IsHost(ranks[i]) ? " (host)" : "",
                        WhereItStopped(trace, *trace.MainOf(ranks[i])));
  if (ranks.size() > most_ranks)
    text += fmt::format("  and {} more\n", FormatCount(ranks.size() - most_ranks, "rank"));
  return text;
}

}  // namespace stipple
