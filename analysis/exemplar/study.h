// SPDX-License-Identifier: MIT
// What the experiments share: the four scenes, ways to find a case and to say what was waited for.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_STUDY_H
#define STIPPLE_ANALYSIS_EXEMPLAR_STUDY_H

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/exemplar/paper.h"

namespace stipple {

/// The sizes of the study's scenes.
inline constexpr std::array<std::string_view, 4> kScenes{"balls", "rings", "teapot", "tree"};

/// The ray tracer's words for a scene of the study through its own camera, one ray through each
/// pixel's centre, `side` x `side` pixels. Of a quick look the scene is small, too.
std::vector<std::string> SceneWords(std::string_view scene, int side, bool quick);

/// The measures of the case with these labels; null when there is none.
const RunMeasures* FindCase(std::span<const MeasuredCase> cases,
                            const std::vector<std::string>& labels);

/// Node time: nodes x span.
double NodeSeconds(const RunMeasures& measures);
/// Share of node time in start-up and transmission of messages: what the original study draws as
/// system.
double OverheadShare(const RunMeasures& measures);
double IdleShare(const RunMeasures& measures);

/// Seconds of a mean node in each state.
std::array<double, kStateCount> MeanStates(const std::vector<RankTimes>& nodes);

/// "92.2 s", "1.30 ms"
std::string SecondsText(double seconds);

/// "host", "node 3": who was waited for longest, and its share of all waits.
struct WaitedLongest {
  std::string kind;  // of its waits, mostly; empty: nobody waited
  std::string culprit;
  double seconds = 0;
  double share = 0;  // of all waits of nodes
  int rank = -1;     // of the culprit
};
WaitedLongest WaitedLongestFor(const RunMeasures& measures);

/// The setting with this parameter and value; null when it is not among them.
const MeasuredSetting* FindSetting(std::span<const MeasuredSetting> settings,
                                   std::string_view parameter, std::string_view value);

/// Of two series; 0 where one of them does not vary.
double CorrelationOf(std::span<const double> x, std::span<const double> y);

/// A row for each labelled case: what its time went to and who was waited for.
Table CauseTable(std::span<const MeasuredCase> cases, const std::vector<std::string>& label_names);

}  // namespace stipple

#endif
