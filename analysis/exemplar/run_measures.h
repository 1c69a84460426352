// SPDX-License-Identifier: MIT
// What experiments need to know of a run, read from its archive by the statistics that users have,
// too. It is small: it is kept, the archive is not.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_RUN_MEASURES_H
#define STIPPLE_ANALYSIS_EXEMPLAR_RUN_MEASURES_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// How a rank divided its time (stats/states.h), in seconds.
struct RankTimes {
  int rank = 0;
  double user_s = 0;
  double system_s = 0;
  double message_s = 0;
  double idle_s = 0;

  double SpanSeconds() const { return user_s + system_s + message_s + idle_s; }
};

/// Seconds that all nodes together lost in waits of one kind by the fault of one rank.
struct NodeWait {
  std::string kind;
  int culprit = 0;
  double seconds = 0;
};

/// Share of time that nodes compute, over time: of the window that ends at time_s.
struct UtilisationPoint {
  double time_s = 0;
  double mean = 0;
  double least = 0;
  double most = 0;
};

struct RunMeasures {
  double simulated_s = 0;
  std::string hash{};
  std::uint64_t messages = 0;
  int host = -1;                     // its rank; -1: there is none
  std::vector<RankTimes> nodes{};    // hosts left out
  std::vector<NodeWait> waits{};     // of nodes
  std::optional<double> supply_s{};  // when the host gave its last bundle away
  std::vector<RankTimes> before{};   // the nodes until then; empty where there was no such moment
  std::vector<RankTimes> after{};    // and from then on
  std::vector<UtilisationPoint> utilisation{};
  std::map<std::string, std::map<int, double>> counters{};  // last values, by name and rank
};

/// Errors: InputError, where the archive cannot be read or lost events.
RunMeasures MeasureArchive(const std::string& archive);

/// As text that is kept, and back; `command` stands in it for readers. Errors of reading: nothing,
/// as if it had not been measured.
std::string JsonOf(const RunMeasures& measures, const std::string& command);
std::optional<RunMeasures> MeasuresFrom(const std::string& json);

/// Sums and means over nodes.
RankTimes SumOf(const std::vector<RankTimes>& nodes);
/// Of computing time; 1 where nobody computed.
double MaxOverMean(const std::vector<RankTimes>& nodes);
/// Node-seconds lost in waits by the fault of `rank`, or with -1 of all.
double WaitsFor(const RunMeasures& measures, int rank);

}  // namespace stipple

#endif
