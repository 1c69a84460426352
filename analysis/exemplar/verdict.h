// SPDX-License-Identifier: MIT
// Claims as numbers with thresholds, and the verdict that follows from them. Nothing here knows
// where the numbers come from.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_H
#define STIPPLE_ANALYSIS_EXEMPLAR_VERDICT_H

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

enum class Relation { kAbove, kAtLeast, kBelow, kAtMost };

/// A number and what it has to be for the claim to be so. A number that is none fails.
struct Check {
  std::string what{};  // "rings: tiled over the next slowest"
  double value = 0;
  Relation relation = Relation::kAtLeast;
  double limit = 0;

  bool Holds() const;
};

/// ">=", as people write it.
std::string_view SignOf(Relation relation);

/// One statement of a claim; without checks it says nothing at this setting.
struct ClaimPart {
  std::string text;
  std::vector<Check> checks;
};

/// In part: some checks hold. Unstable: it is another one at another setting.
enum class Verdict { kHolds, kInPart, kRefuted, kUnstable };

/// "holds in part"
std::string_view NameOf(Verdict verdict);

/// None when nothing was checked.
std::optional<Verdict> VerdictOf(const ClaimPart& part);
/// Holds if all parts hold, refuted if all are refuted. A part in which nothing was checked does
/// neither: what did not arise was not shown. None when nothing at all was checked.
std::optional<Verdict> VerdictOf(std::span<const ClaimPart> parts);

/// What was varied, and how far. An empty parameter: nothing, the reference.
struct Variation {
  std::string parameter{};
  std::string value{};            // as people read it: "2 ms"
  std::string reference_value{};  // the same of what it varies
  double place = 0;               // orders the values; that of the reference has 0
  std::size_t reference = 0;      // index of the setting that it varies
  bool compared = false;          // a comparison: makes nothing unstable
};

/// The claim's parts at one setting; all settings have the same parts in the same order.
struct PartsAt {
  Variation variation;
  std::vector<ClaimPart> parts;
};

/// Between two neighbouring values of a parameter a part's verdict changes.
struct Turn {
  std::size_t part = 0;
  std::string parameter{};
  std::string from{};  // value
  std::string to{};
  Verdict before = Verdict::kHolds;
  Verdict after = Verdict::kHolds;
};

struct Judgement {
  std::optional<Verdict> verdict;                   // unstable if any part turns
  std::optional<Verdict> reference;                 // of the first setting alone
  std::vector<std::optional<Verdict>> parts;        // of each, unstable included
  std::vector<std::optional<Verdict>> as_measured;  // of each, at the first setting alone
  std::vector<Turn> turns;                          // by part, then parameter
};

/// The first setting is the reference. A setting at which a part has nothing to check turns
/// nothing.
Judgement Judge(std::span<const PartsAt> settings);

}  // namespace stipple

#endif
