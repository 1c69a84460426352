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
  const std::int64_t length = end_ns - begin_ns;
  const bool within = begin_ns >= wide.begin_ns && end_ns <= wide.end_ns;
  VisitsOfSpan found;
  found.complete = false;
  if (within && length >= wide.too_many_ns) return found;
  if (!within || wide.too_many_ns != kNever) {
    VisitsOfSpan exact = source.VisitsOf(rank, begin_ns, end_ns, most);
    const std::int64_t from = std::max<std::int64_t>(0, begin_ns - length), to = end_ns + length;
    wide = {from, to, exact.complete ? kNever : length - length / 8, {}};
    if (!exact.complete) return found;
    VisitsOfSpan asked = source.VisitsOf(rank, from, to, most * kWiderMost);
    if (!asked.complete) {
      wide = {};
      return exact;
    }
    wide.visits = std::move(asked.visits);
  }
  std::ranges::copy_if(wide.visits, std::back_inserter(found.visits), [&](const VisitSpan& v) {
    return v.end_ns >= begin_ns && v.begin_ns <= end_ns;
  });
  found.complete = found.visits.size() <= most;
  if (!found.complete) found.visits.clear();
  return found;
}

}  // namespace stipple
