// SPDX-License-Identifier: MIT
#include "analysis/views/window/wide_visits.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace stipple {
namespace {

constexpr std::size_t kWiderMost = 4;  // times as many visits as were asked for are kept

}  // namespace

VisitsOfSpan WideVisits::Of(const WindowSource& source, int rank, std::int64_t begin_ns,
                            std::int64_t end_ns, std::size_t most) {
  Wide& wide = by_rank_[rank];
  if (begin_ns < wide.begin_ns || end_ns > wide.end_ns) {
    VisitsOfSpan exact = source.VisitsOf(rank, begin_ns, end_ns, most);
    if (!exact.complete) return exact;
    const std::int64_t length = end_ns - begin_ns;
    const std::int64_t from = std::max<std::int64_t>(0, begin_ns - length), to = end_ns + length;
    VisitsOfSpan asked = source.VisitsOf(rank, from, to, most * kWiderMost);
    if (!asked.complete) return exact;
    wide = {from, to, std::move(asked.visits)};
  }
  VisitsOfSpan found;
  std::ranges::copy_if(wide.visits, std::back_inserter(found.visits), [&](const VisitSpan& v) {
    return v.end_ns >= begin_ns && v.begin_ns <= end_ns;
  });
  found.complete = found.visits.size() <= most;
  if (!found.complete) found.visits.clear();
  return found;
}

}  // namespace stipple
