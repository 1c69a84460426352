// SPDX-License-Identifier: MIT
// Where a scan of a thread can begin: begins of chunks, about every 64 k events, with the visits
// that are open there. What a thread does with contexts and jump points cannot be told so shortly:
// behind the first of them there are no anchors, and a scan begins further in front.
#ifndef STIPPLE_ANALYSIS_TRACE_ANCHORS_H
#define STIPPLE_ANALYSIS_TRACE_ANCHORS_H

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/trace/array.h"
#include "analysis/trace/scan.h"

namespace stipple {

/// A visit that has begun, in a region of the process.
struct OpenVisit {
  std::uint64_t enter_ticks = 0;
  std::uint64_t region = 0;
};

struct ScanAnchor {
  ScanPlace place;
  std::uint64_t first_open = 0;  // of Anchors::open
  std::uint64_t open_count = 0;
};

/// Of one thread, in order. The begin of the thread is no anchor of its own.
struct Anchors {
  static constexpr std::uint64_t kWordsBetween = 64 * 1024;

  Array<ScanAnchor> places;
  Array<OpenVisit> open;

  /// The last from which a scan meets all events at `ticks` and later; null: the thread's begin.
  const ScanAnchor* Before(std::uint64_t ticks) const {
    const ScanAnchor* found = nullptr;
    for (std::size_t low = 0, high = places.size(); low < high;) {
      const std::size_t middle = (low + high) / 2;
      if (places[middle].place.now < ticks) {
        found = &places[middle];
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return found;
  }
  std::span<const OpenVisit> OpenAt(const ScanAnchor& anchor) const {
    if (anchor.first_open > open.size() || anchor.open_count > open.size() - anchor.first_open)
      return {};
    return std::span<const OpenVisit>(open).subspan(anchor.first_open, anchor.open_count);
  }
};

/// Gathers the anchors of a thread in the scan that sees all of it: to be called between its parts.
class AnchorGatherer {
 public:
  /// The visitor tells the visits that are open, and whether they are all there is to know.
  template <class Visitor>
  void Take(const ScanPosition& at, std::uint64_t words, const Visitor& visitor) {
    words_ += words;
    if (words_ < Anchors::kWordsBetween || at.words_behind != 0 || !visitor.IsPlain()) return;
    words_ = 0;
    const std::vector<OpenVisit> open = visitor.OpenVisits();
    places_.push_back({at.Place(), open_.size(), open.size()});
    open_.insert(open_.end(), open.begin(), open.end());
  }
  Anchors Finish() { return {std::move(places_), std::move(open_)}; }

 private:
  std::vector<ScanAnchor> places_;
  std::vector<OpenVisit> open_;
  std::uint64_t words_ = 0;
};

}  // namespace stipple

#endif
