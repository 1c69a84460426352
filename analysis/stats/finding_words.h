// SPDX-License-Identifier: MIT
// How the finding speaks: ranks by name, and a clause for each cause.
#ifndef STIPPLE_ANALYSIS_STATS_FINDING_WORDS_H
#define STIPPLE_ANALYSIS_STATS_FINDING_WORDS_H

#include <string>
#include <string_view>
#include <vector>

#include "analysis/trace/trace.h"

namespace stipple {

/// What is said of a cause (a kind of wait) when it is charged to one rank, to several, or to
/// nobody in particular; and what would mend it.
struct CauseWords {
  std::string_view cause;
  std::string_view of_one;     // after "spend 37% of the run waiting for rank 0: "
  std::string_view of_many;    // likewise, "... for ranks 0 and 1: "
  std::string_view of_all;     // after "waiting for each other: "; empty: it is nobody's: imbalance
  bool spread = false;         // mended by spreading the culprit's work over the others
  std::string_view if_mended;  // after "at most 2 s could be gained "
};

/// The row of a cause; one without words for a cause that is not in the table.
const CauseWords& WordsOf(std::string_view cause);

/// Names of a run's ranks.
class RankWords {
 public:
  explicit RankWords(const Trace& trace)
      : trace_(trace), noun_(trace.HasHost() ? "node" : "rank") {}

  std::string Noun() const { return noun_; }
  /// "rank 0", "the host"
  std::string One(int rank) const;
  /// "ranks 1-3, 7 and the host"; "19 ranks" when that would be a long list.
  std::string Many(std::vector<int> ranks) const;

 private:
  const Trace& trace_;
  std::string noun_;
};

std::string Capitalised(std::string text);

}  // namespace stipple

#endif
