// SPDX-License-Identifier: MIT
#include "analysis/tools/stopped_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

constexpr std::size_t kMostNames = 3;  // of functions inside each other

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
  if (open.empty()) return "had ended";
  const bool waits = trace.regions()[open.back().region].kind == RegionKind::kMpi;
  std::string way;
  for (std::size_t i = open.size(); i > open.size() - std::min(open.size(), kMostNames); --i)
    way += (way.empty() ? "" : " < ") + ShortName(trace.regions()[open[i - 1].region].name);
  return fmt::format("{} since {:.6f} s in {}", waits ? "waits" : "was",
                     static_cast<double>(trace.TimeNs(location, open.back().ticks)) * 1e-9, way);
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
