// SPDX-License-Identifier: MIT
#include "analysis/stats/visit_bars.h"

#include <cmath>
#include <map>
#include <utility>

#include "analysis/stats/visits.h"
#include "analysis/trace/demangle.h"

namespace stipple {

VisitBars VisitBarsOf(const Trace& trace, const Timeline& period, std::size_t most) {
  VisitBars bars;
  bars.rows.resize(period.rows.size());
  const auto ns = [](double seconds) { return std::llround(seconds * 1e9); };
  std::map<std::uint32_t, std::uint32_t> names;  // by region
  std::size_t count = 0;
  for (std::size_t row = 0; row < period.rows.size(); ++row)
    for (const Location& location : trace.locations()) {
      if (location.rank != period.rows[row].rank || !location.IsMain()) continue;
      const VisitsOfSpan found =
          VisitsIn(trace, location, ns(period.begin_s), ns(period.end_s), most);
      count += found.visits.size();
      if (!found.complete || count > most) return {};
      for (const VisitSpan& visit : found.visits) {
        const auto [name, is_new] =
            names.try_emplace(visit.region, static_cast<std::uint32_t>(bars.names.size()));
        if (is_new) bars.names.push_back(ShortName(trace.regions()[visit.region].name));
        bars.rows[row].push_back({static_cast<double>(visit.begin_ns) * 1e-9,
                                  static_cast<double>(visit.end_ns) * 1e-9, visit.depth,
                                  name->second});
      }
    }
  return bars;
}

}  // namespace stipple
