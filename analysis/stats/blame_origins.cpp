// SPDX-License-Identifier: MIT
#include "analysis/stats/blame_origins.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

namespace stipple {
namespace {

// A piece is divided among so many earlier pieces at most; what is left stays where it is.
constexpr std::size_t kMostParts = 4;

bool CanBegin(WaitKind kind) { return kind <= WaitKind::kCollective; }

class Mover {
 public:
  Mover(const WaitGraph& graph, std::vector<BlamePiece>& pieces)
      : graph_(graph), pieces_(pieces), own_(graph.All().size()), moved_(graph.All().size()) {
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      Range& own = own_[pieces[i].wait];
      if (own.begin == own.end) own.begin = i;
      own.end = i + 1;
    }
  }

  void Move() {
    std::vector<std::uint32_t> by_end(own_.size());
    std::iota(by_end.begin(), by_end.end(), 0U);
    std::ranges::sort(by_end, {}, [this](std::uint32_t w) { return graph_.All()[w].end_ns; });
    for (const std::uint32_t w : by_end) {
      moved_[w].begin = static_cast<std::uint32_t>(pieces_.size());
      for (std::uint32_t i = own_[w].begin; i < own_[w].end; ++i)
        if (CanBegin(pieces_[i].kind)) MovePiece(i);
      moved_[w].end = static_cast<std::uint32_t>(pieces_.size());
    }
    std::erase_if(pieces_, [](const BlamePiece& p) { return p.begin_ns == p.end_ns; });
  }

 private:
  /// Of pieces.
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };

  /// When the rank's wait before this one was over.
  std::int64_t LastEnd(std::int32_t rank, const WaitSpan& wait) const {
    return &wait == graph_.OfRank(rank).data() ? 0 : std::prev(&wait)->end_ns;
  }

  void MovePiece(std::uint32_t i) {
    const WaitSpan& wait = graph_.All()[pieces_[i].wait];
    const std::int32_t waiter = pieces_[i].waiter;
    const std::int64_t free_ns = LastEnd(waiter, wait);
    const std::span<const WaitSpan> late = graph_.OfRank(pieces_[i].culprit);
    auto before = std::ranges::lower_bound(late, wait.begin_ns, {}, &WaitSpan::begin_ns);
    const std::size_t most_pieces = pieces_.size() + kMostParts;
    while (before != late.begin() && pieces_[i].begin_ns < pieces_[i].end_ns) {
      const WaitSpan& earlier = *--before;
      // What it waited for the waiter itself is over when the waiter has come.
      if (earlier.end_ns <= free_ns || earlier.partner == waiter) break;
      const std::int64_t waited_ns =
          std::min(earlier.end_ns, wait.begin_ns) - std::max(earlier.begin_ns, free_ns);
      MoveTo(graph_.IdOf(earlier), waited_ns, i, most_pieces);
    }
  }

  /// Of piece i at most waited_ns to those who are charged with an earlier wait of its culprit.
  void MoveTo(std::size_t earlier, std::int64_t waited_ns, std::uint32_t i,
              std::size_t most_pieces) {
    for (const Range& range : {own_[earlier], moved_[earlier]})
      for (std::uint32_t k = range.begin; k < range.end && pieces_.size() < most_pieces; ++k) {
        BlamePiece part = pieces_[k];
        BlamePiece& from = pieces_[i];
        const std::int64_t ns =
            std::min({part.end_ns - part.begin_ns, waited_ns, from.end_ns - from.begin_ns});
        if (ns <= 0 || !CanBegin(part.kind) || part.culprit == from.waiter) continue;
        part.begin_ns = from.begin_ns;
        part.end_ns = from.begin_ns += ns;
        part.waiter = from.waiter;
        part.wait = from.wait;
        part.kind = from.kind;
        waited_ns -= ns;
        pieces_.push_back(part);
      }
  }

  const WaitGraph& graph_;
  std::vector<BlamePiece>& pieces_;
  std::vector<Range> own_;    // by wait
  std::vector<Range> moved_;  // likewise: parts of its pieces
};

}  // namespace

void ChargeOrigins(const WaitGraph& graph, std::vector<BlamePiece>& pieces) {
  Mover(graph, pieces).Move();
}

}  // namespace stipple
