// SPDX-License-Identifier: MIT
#include "analysis/stats/selection.h"

#include <charconv>
#include <set>
#include <string>

#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

int ParseRank(std::string_view text, std::string_view whole) {
  int rank = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rank);
  if (error != std::errc() || end != text.data() + text.size() || rank < 0)
    throw InputError("--ranks", "'" + std::string(whole) + "' is not a list like 0-3,7,host");
  return rank;
}

}  // namespace

std::vector<int> ParseRanks(const Trace& trace, std::string_view text) {
  std::set<int> ranks;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? "" : rest.substr(comma + 1);
    if (item == "host") {
      if (!trace.HasHost()) throw InputError("--ranks", "this archive has no host");
      for (const Process& p : trace.processes())
        if (p.is_host) ranks.insert(p.rank);
      continue;
    }
    const std::size_t dash = item.find('-');
    const int first = ParseRank(item.substr(0, dash), text);
    const int last =
        dash == std::string_view::npos ? first : ParseRank(item.substr(dash + 1), text);
    if (last < first || last >= trace.RankCount())
      throw InputError("--ranks", "'" + std::string(item) + "': the archive has ranks 0-" +
                                      std::to_string(trace.RankCount() - 1));
    for (int rank = first; rank <= last; ++rank) ranks.insert(rank);
  }
  if (ranks.empty()) throw InputError("--ranks", "names no rank");
  return {ranks.begin(), ranks.end()};
}

}  // namespace stipple
