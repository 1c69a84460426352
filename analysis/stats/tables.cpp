// SPDX-License-Identifier: MIT
#include "analysis/stats/tables.h"

#include <array>
#include <string>
#include <vector>

#include "analysis/stats/callpaths.h"
#include "analysis/stats/causes.h"
#include "analysis/stats/channels.h"
#include "analysis/stats/counters.h"
#include "analysis/stats/critical_path.h"
#include "analysis/stats/efficiency.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/imbalance_split.h"
#include "analysis/stats/message_load.h"
#include "analysis/stats/message_matrix.h"
#include "analysis/stats/message_waits.h"
#include "analysis/stats/number.h"
#include "analysis/stats/overhead.h"
#include "analysis/stats/phases.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/switches.h"
#include "analysis/stats/syscalls.h"
#include "analysis/stats/transmissions.h"
#include "analysis/stats/utilisation.h"

namespace stipple {
namespace {

TableAnswer Overhead(const Analysis& analysis, const Selection& selection, const TableOptions&) {
  return OverheadTable(analysis, selection);
}

TableAnswer Waits(const Analysis& analysis, const Selection& selection, const TableOptions&) {
  const std::vector<Blame> blames = SelectedBlame(analysis, selection);
  std::string headline;
  if (selection.AllMessages()) {
    headline = FindingOf(analysis, selection, blames).sentence;
  } else {
    double seconds = 0;
    for (const Blame& b : blames) seconds += b.seconds;
    headline = "Ranks waited " + FormatSeconds(seconds) + " for such messages, summed over them.";
  }
  return {WaitsTable(analysis.trace, blames), std::move(headline)};
}

TableAnswer Imbalance(const Analysis& analysis, const Selection& selection, const TableOptions&) {
  Table table{"imbalance",
              TableShape::kObject,
              {{"max_over_mean"}, {"idle_share"}, {"cause"}, {"sentence"}},
              {}};
  const std::vector<Blame> blames = BlameOf(analysis, selection);
  const Finding f = FindingOf(analysis, selection, blames);
  if (!analysis.trace.locations().empty())
    table.rows.push_back({f.max_over_mean, f.idle_share, f.cause, f.sentence});
  return {std::move(table), f.sentence};
}

TableAnswer CriticalPath(const Analysis& analysis, const Selection& selection,
                         const TableOptions&) {
  const Causes causes = CausesOf(analysis, selection);
  return {CriticalPathTable(analysis, causes.path_rows, selection),
          CriticalPathSentence(analysis, causes.path_rows, selection)};
}

TableAnswer EfficiencyAnswer(const Analysis& analysis, const Selection& selection,
                             const TableOptions& options) {
  const Efficiency efficiency = EfficiencyOf(analysis, selection);
  return {options.per_rank ? EfficiencyByRankTable(efficiency) : EfficiencyTable(efficiency),
          EfficiencySentence(efficiency)};
}

TableAnswer Phases(const Analysis& analysis, const Selection& selection, const TableOptions&) {
  const std::vector<Phase> phases = PhasesOf(analysis, selection);
  return {PhasesTable(analysis, phases), PhasesSentence(analysis.trace, phases)};
}

TableAnswer ImbalanceSplit(const Analysis& analysis, const Selection& selection,
                           const TableOptions&) {
  const Causes causes = CausesOf(analysis, selection);
  return {ImbalanceSplitTable(analysis.trace, causes.split),
          ImbalanceSplitSentence(analysis.trace, causes.phases, causes.split)};
}

constexpr unsigned kPlaceAndRegions = kTakesPlace | kTakesRegions;
constexpr unsigned kPlaceAndMessages = kTakesPlace | kTakesMessages;
constexpr unsigned kPlaceAndWindow = kTakesPlace | kTakesWindow;

constexpr std::array kTables = {
    TableEntry{"profile", ProfileAnswer, "time and calls per region, most exclusive time first",
               true, kPlaceAndRegions},
    TableEntry{"states", StatesAnswer, "user, system, message and idle time of each rank"},
    TableEntry{"messages", MessagesAnswer,
               "how many messages each rank sent to each (sender = row)", false, kPlaceAndMessages},
    TableEntry{"volume", VolumeAnswer, "how many bytes each rank sent to each (sender = row)",
               false, kPlaceAndMessages},
    TableEntry{"waits", Waits, "who waited for whom, why, and what the late rank was doing", false,
               kPlaceAndMessages},
    TableEntry{"imbalance", Imbalance, "how unevenly the ranks compute, what it costs and why"},
    TableEntry{"callpaths", CallPathsAnswer, "time, calls and messages per chain of calls, a tree",
               false, kPlaceAndRegions, true},
    TableEntry{"counters", CountersAnswer, "values of the program's own counters over time"},
    TableEntry{"channels", ChannelsAnswer, "messages between threads, and who waited for whom"},
    TableEntry{"critical-path", CriticalPath, "what the length of the run is made of"},
    TableEntry{"efficiency", EfficiencyAnswer,
               "how much of the time is useful, and what takes the rest", true},
    TableEntry{"imbalance-split", ImbalanceSplit,
               "what makes the busiest rank of each phase the busiest"},
    TableEntry{"load", LoadAnswer, "messages and bytes sent, over time", true,
               kPlaceAndMessages | kTakesWindow},
    TableEntry{"mean-size", MeanSizeAnswer, "bytes per message from each rank to each", false,
               kPlaceAndMessages},
    TableEntry{"overhead", Overhead, "what recording each region cost, and time without it", false,
               kTakesPlace, true},
    TableEntry{"phases", Phases, "parts of the run in which the ranks divide their time alike"},
    TableEntry{"sizes", SizesAnswer, "messages by size, in powers of two", true, kPlaceAndMessages},
    TableEntry{"status", StatusAnswer, "the state of each rank, moment by moment", false,
               kPlaceAndWindow},
    TableEntry{"switches", SwitchesAnswer,
               "context switches and page faults of each thread; with --window over time", false,
               kPlaceAndWindow},
    TableEntry{"syscalls", SystemCallsAnswer,
               "system calls by name: how many, how long, what moved", true, kPlaceAndRegions},
    TableEntry{"transmissions", TransmissionsAnswer,
               "when each message was in the network of a simulated machine", false,
               kPlaceAndMessages},
    TableEntry{"types", TypesAnswer, "messages by tag", true, kPlaceAndMessages},
    TableEntry{"utilisation", UtilisationAnswer, "how much the nodes compute, over time", true,
               kPlaceAndWindow},
    TableEntry{"wait", WaitMatrixAnswer, "seconds that each rank (row) waited for each", false,
               kPlaceAndMessages}};

}  // namespace

std::span<const TableEntry> TableEntries() { return kTables; }

}  // namespace stipple
