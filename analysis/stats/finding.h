// SPDX-License-Identifier: MIT
// The sentence at the top of a report: what cost the time, who is to blame, and how much there is
// to gain.
#ifndef STIPPLE_ANALYSIS_STATS_FINDING_H
#define STIPPLE_ANALYSIS_STATS_FINDING_H

#include <string>
#include <vector>

namespace stipple {

/// Time that all ranks together spent waiting for one rank.
struct WaitedFor {
  int rank = 0;
  std::string name;    // "3" or "host"
  double seconds = 0;  // rank-seconds
  std::string region;  // where the culprit was meanwhile, mostly
};

struct Finding {
  std::string sentence;  // "Nodes 1-7 spend 37 % of the run waiting for node 0"
  std::string
      detail;  // a second sentence: where the culprit was, and what would be gained; may be empty
  int culprit = -1;                   // world rank; -1: none
  std::vector<WaitedFor> waited_for;  // sorted, most first
  double max_over_mean = 1;           // of the ranks' computing time
  double idle_share = 0;              // of the ranks' time (the host's left out)
  std::string cause =
      "none";         // of the waiting: a kind of wait; "imbalance": nobody's in particular
  double gain_s = 0;  // by so much the run would be shorter if the cause were mended, at most
};

}  // namespace stipple

#endif
