// SPDX-License-Identifier: MIT
// Visits that are open, and sums of those that were: what the two ways to a profile share, that of
// runs whose events all cost nothing (profile_visitor.h) and that of runs with a budget
// (estimate_visitor.h).
#ifndef STIPPLE_ANALYSIS_STATS_VISIT_SUMS_H
#define STIPPLE_ANALYSIS_STATS_VISIT_SUMS_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/trace/anchors.h"
#include "analysis/trace/scan.h"

namespace stipple {

/// All that an event touches of a region: one line of the cache, and few additions. Sums are of the
/// times of events, and wrap: their differences are right, and are the times between them.
struct alignas(64) VisitSums {
  /// Over enters and leaves of outermost visits, then over those of nested ones.
  using Sums = std::uint64_t[4];
  Sums ticks = {};
  std::uint64_t inside[2] = {};  // ticks over enters and leaves of visits directly inside
  std::uint64_t events = 0;      // their number, and in the low bits how many visits are open
  std::uint64_t is_watched = 0;  // its events go to the collector, too

  // A stack of so many frames takes 4 GB, so many events of a region 500 GB. Beyond, numbers are
  // wrong, but what counts as open is: they are right modulo this.
  static constexpr std::uint64_t kEvent = std::uint64_t{1} << 28;

  std::uint64_t Open() const { return events % kEvent; }
  std::uint64_t Calls() const { return (events / kEvent + Open()) / 2; }
  std::uint64_t Inclusive() const { return ticks[1] - ticks[0]; }
  /// While it was on top of the stack.
  std::uint64_t Exclusive() const {
    return Inclusive() + (ticks[3] - ticks[2]) - (inside[1] - inside[0]);
  }
  /// One enter or leave; the place of its sums.
  std::size_t Count(std::uint64_t leave, std::uint64_t now) {
    // Whether a visit is the outermost one depends on the recursion, which nobody can foretell, and
    // of a choice between two values the compiler may make a branch: so this is arithmetic, -1 for
    // an outermost visit, else 0.
    const std::int64_t outermost = static_cast<std::int64_t>((Open() ^ leave) - 1) >> 63;
    const auto place =
        static_cast<std::size_t>(2 + static_cast<std::int64_t>(leave) + 2 * outermost);
    events += kEvent + 1 - 2 * leave;
    ticks[place] += now;  // last, for its place is known late: what is written behind it waits
    return place;
  }
  /// The enter that was or will be counted is no call.
  void NoCall() { events -= 2 * kEvent; }
};

/// A visit that is open.
template <class Region>
struct VisitFrame {
  Region* region;
  std::uint64_t enter;
};

/// Room for the visits that are open. Below the outermost one lies that of a region that is none,
/// so that there is always one on top. Where the top is, the visitor knows: its hot part has it as
/// `top`, and the last place that there is as `limit`.
template <class Region>
class VisitStack {
 public:
  using Frame = VisitFrame<Region>;

  explicit VisitStack(Region* none) : frames_(1024) { frames_.front() = {none, 0}; }

  Frame* bottom() { return frames_.data(); }
  const Frame* bottom() const { return frames_.data(); }
  Frame* limit() { return frames_.data() + frames_.size() - 1; }
  template <class Hot>
  std::size_t Depth(const Hot& hot) const {
    return static_cast<std::size_t>(hot.top - frames_.data());
  }
  /// Doubles a full stack; returns its top.
  Frame* Grow() {
    const std::size_t used = frames_.size();
    frames_.resize(2 * used);
    return frames_.data() + used - 1;
  }
  /// Room for so many frames more.
  template <class Hot>
  void Reserve(Hot& hot, std::size_t frames) {
    while (static_cast<std::size_t>(hot.limit - hot.top) < frames) {
      const std::size_t depth = Depth(hot);
      Grow();
      hot.top = frames_.data() + depth;
      hot.limit = limit();
    }
  }
  /// Those below the top and it, outermost first. `regions`: the first of all.
  std::vector<OpenVisit> OpenVisits(const Frame* top, const Region* regions) const {
    std::vector<OpenVisit> open;
    for (const Frame* f = bottom(); f++ != top;)
      open.push_back({f->enter, static_cast<std::uint64_t>(f->region - regions)});
    return open;
  }

 private:
  std::vector<Frame> frames_;
};

/// Takes plain events (scan.h) that lie in the selected span, all of regions whose frames are
/// alike; returns how many. Room for them must be there. `more(around, region, leave, place)` may
/// count what else there is; `around` is the region of the frame below.
///
/// Enter or leave, at random, is a branch that no processor foretells. So both take the same way:
/// what a leave takes off the stack, an enter puts there, and it is put there for both. Only what
/// seldom happens is a branch, and for Function: a leave of a region that is not on top, and what
/// the collector wants to see, for with a call here the loop would not have its registers to
/// itself.
template <class Hot, class More>
std::size_t TakePlain(Hot& hot, const EventWord* words, std::size_t count, std::uint64_t offset,
                      More&& more) {
  auto* const regions = hot.regions;
  auto* top = hot.top;
  std::size_t i = 0;
  for (; i < count; ++i) {
    const EventWord word = words[i];
    const std::uint64_t now = TimeOf(word) + offset;
    const std::uint64_t leave = (word / kLeaveBit) & 1;
    auto* const region = regions + (word & kRegionMask);
    auto* const place = top + 1 - leave;
    if (((static_cast<std::uint64_t>(place->region != region) & leave) | region->is_watched) != 0)
        [[unlikely]]
      break;
    auto& around = *place[-1].region;
    around.inside[leave] += now;
    *place = {region, now};
    top = place - leave;
    more(around, *region, leave, region->Count(leave, now));
  }
  hot.top = top;
  if (i != 0) hot.last = TimeOf(words[i - 1]) + offset;
  return i;
}

/// Whether plain events lie in the span that the visitor has selected.
template <class Hot>
bool InSpan(const Hot& hot, const EventWord* words, std::size_t count, std::uint64_t offset) {
  return TimeOf(words[0]) + offset >= hot.begin && TimeOf(words[count - 1]) + offset <= hot.end;
}

}  // namespace stipple

#endif
