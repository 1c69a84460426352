// SPDX-License-Identifier: MIT
// What is wrong with an archive: every defect the reader meets is counted by kind and carried to
// every output. A defect never stops the reader; only an archive that is not there does.
#ifndef STIPPLE_ANALYSIS_TRACE_HEALTH_H
#define STIPPLE_ANALYSIS_TRACE_HEALTH_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

enum class Defect {
  kEmptyArchive,
  kUnreadableFile,
  kBadFileHeader,
  kTruncatedFile,
  kBadChunk,
  kMissingChunk,
  kDamagedChunk,
  kBadTime,
  kBadRecord,
  kOpenRecord,
  kUncommitted,
  kLostEvents,
  kLostSwitches,
  kBadDefinition,
  kUndefinedRegion,
  kUndefinedName,
  kUnnamedFunction,
  kUndefinedCommunicator,
  kLeaveWithoutEnter,
  kEnterWithoutLeave,
  kUnclosedProcess,
  kStillRunning,
  kMissingRank,
  kUnmatchedSend,
  kUnmatchedReceive,
  kIncompleteCollective,
  kClockUnknown,
  kClockUnsynchronised,
  kClockStep,
};

/// Name and sentence of a Defect; the sentence follows a count.
struct DefectEntry {
  Defect defect;
  std::string_view name;
  std::string_view one;   // "event was lost"
  std::string_view many;  // "events were lost"
};
const DefectEntry& EntryOf(Defect defect);

/// Two times of the archive.
struct ProblemSpan {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  bool operator==(const ProblemSpan&) const = default;
};

/// `count` defects of one kind in one place.
struct Problem {
  Defect defect;
  std::string where;  // stream file, rank or process; empty: the archive
  std::uint64_t count = 1;
  std::optional<ProblemSpan> when = {};
};

/// "node7.4711.stream: 3 events were lost, between 1.250000 s and 1.500000 s"
std::string TextOf(const Problem& problem);

class TraceHealth {
 public:
  /// Adds to what is known of this defect in this place; a count of 0 changes nothing.
  void Add(Defect defect, std::string_view where, std::uint64_t count = 1,
           std::optional<ProblemSpan> when = std::nullopt);
  void Add(const TraceHealth& other);
  /// The same, all of them in one place.
  void AddAt(std::string_view where, const TraceHealth& other);

  std::uint64_t CountOf(Defect defect) const;
  /// Events that happened and cannot be read, as far as they can be counted.
  std::uint64_t LostEvents() const;
  /// More were lost than LostEvents, and nobody knows how many.
  bool LostUncounted() const;
  /// Some processes still run, which is no defect.
  bool Running() const { return RunningPlaces() != 0; }
  bool Sound() const { return problems_.size() == RunningPlaces(); }
  /// While processes run, what others are waiting for is not lost: drops what may yet come.
  void ForgiveUnfinished();
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::size_t RunningPlaces() const;
  std::vector<Problem> problems_;
};

}  // namespace stipple

#endif
