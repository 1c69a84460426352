// SPDX-License-Identifier: MIT
// What makes the busiest rank busier than the mean, and in which phase of the run.
//
// In each phase (phases.h) the rank that computes longest is compared with the mean of all. Its
// time divides into the four states, so does theirs, and what it has more in one it has less in
// others:
//   more-work     it entered functions more often: visits above the mean x mean time of a visit, as
//                 in the whole run (a visit may be longer than a phase)
//   dearer-work   its visits took longer: the rest of its computation above the mean
//   system        it was longer in the kernel, or off its processor
//   messages      it was longer in MPI calls, without waiting
//   waiting       it waited longer (less, where others wait for it: negative)
// The five sum to how much longer the rank was there than the mean, which is nothing unless ranks
// begin or end within the phase.
#ifndef STIPPLE_ANALYSIS_STATS_IMBALANCE_SPLIT_H
#define STIPPLE_ANALYSIS_STATS_IMBALANCE_SPLIT_H

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/phases.h"
#include "analysis/stats/region_times.h"
#include "analysis/stats/selection.h"
#include "analysis/stats/table.h"

namespace stipple {

struct Analysis;

enum class SplitKind : std::uint32_t { kMoreWork, kDearerWork, kSystem, kMessages, kWaiting };
inline constexpr std::size_t kSplitKinds = 5;
std::string_view NameOf(SplitKind kind);

/// The busiest rank of a phase less the mean.
struct SplitPart {
  std::uint32_t phase = 0;
  SplitKind what = SplitKind::kMoreWork;
  double seconds = 0;
  double share = 0;  // of the selected span
  std::int32_t rank = 0;
  std::uint32_t region = 0;  // of work: the one with most of it; 0: none
};

/// Regions of one rank in one phase.
struct RankRegions {
  std::int32_t rank = 0;
  std::vector<RegionPart> parts;
};

/// Of phase number `index`; `regions` are those of all ranks that are compared. Empty when fewer
/// than two are.
std::vector<SplitPart> SplitOf(const Analysis& analysis, const Selection& selection,
                               const Phase& phase, std::uint32_t index,
                               std::span<const RankRegions> regions);

/// Ranks that are compared: the selected ones, hosts left out.
std::vector<int> ComparedRanks(const Trace& trace, const Selection& selection);

/// Rows phase, what, seconds, share, rank, region.
Table ImbalanceSplitTable(const Trace& trace, const std::vector<SplitPart>& split);

/// "0.42 s of the run: rank 3 calls trace() more often than the mean, from 1.2 s to 3.4 s."
std::string ImbalanceSplitSentence(const Trace& trace, const std::vector<Phase>& phases,
                                   const std::vector<SplitPart>& split);

}  // namespace stipple

#endif
