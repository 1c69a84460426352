// SPDX-License-Identifier: MIT
#include "analysis/trace/health.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace stipple {
namespace {

constexpr std::array kDefects = {
    DefectEntry{Defect::kEmptyArchive, "empty-archive", "archive holds no stream with events",
                "archives hold no stream with events"},
    DefectEntry{Defect::kUnreadableFile, "unreadable-file", "file cannot be read",
                "files cannot be read"},
    DefectEntry{Defect::kBadFileHeader, "bad-file-header", "file header is damaged",
                "file headers are damaged"},
    DefectEntry{Defect::kTruncatedFile, "truncated-file",
                "header or chunk is cut off by the end of the file",
                "headers or chunks are cut off by the end of the file"},
    DefectEntry{Defect::kBadChunk, "bad-chunk", "16 KiB block is damaged and was skipped",
                "16 KiB blocks are damaged and were skipped"},
    DefectEntry{Defect::kMissingChunk, "missing-chunk", "chunk of events is missing",
                "chunks of events are missing"},
    DefectEntry{Defect::kDamagedChunk, "damaged-chunk",
                "compacted chunk is damaged: its events are lost",
                "compacted chunks are damaged: their events are lost"},
    DefectEntry{Defect::kBadTime, "bad-time", "chunk begins at an impossible time",
                "chunks begin at an impossible time"},
    DefectEntry{Defect::kBadRecord, "bad-record", "damaged record hides the rest of its chunk",
                "damaged records hide the rest of their chunks"},
    DefectEntry{Defect::kOpenRecord, "open-record", "record was begun and never finished",
                "records were begun and never finished"},
    DefectEntry{Defect::kUncommitted, "uncommitted-event", "event was begun and never committed",
                "events were begun and never committed"},
    DefectEntry{Defect::kLostEvents, "lost-event", "event could not be recorded",
                "events could not be recorded"},
    DefectEntry{Defect::kLostSwitches, "lost-switch", "context switch could not be recorded",
                "context switches could not be recorded"},
    DefectEntry{Defect::kBadDefinition, "bad-definition", "definition is damaged",
                "definitions are damaged"},
    DefectEntry{Defect::kUndefinedRegion, "undefined-region", "event of an undefined region",
                "events of undefined regions"},
    DefectEntry{Defect::kUndefinedName, "undefined-name", "mark, counter or message without a name",
                "marks, counters or messages without a name"},
    DefectEntry{Defect::kUnnamedFunction, "unnamed-function",
                "function has no name: its file is gone, was built anew or is stripped",
                "functions have no names: their file is gone, was built anew or is stripped"},
    DefectEntry{Defect::kUndefinedCommunicator, "undefined-communicator",
                "event on an undefined communicator", "events on undefined communicators"},
    DefectEntry{Defect::kLeaveWithoutEnter, "leave-without-enter", "leave event has no enter event",
                "leave events have no enter event"},
    DefectEntry{Defect::kEnterWithoutLeave, "enter-without-leave",
                "function was left without an event (unseen jump?)",
                "functions were left without an event (unseen jumps?)"},
    DefectEntry{Defect::kUnclosedProcess, "unclosed-process",
                "process did not end in order (killed?)",
                "processes did not end in order (killed?)"},
    DefectEntry{Defect::kStillRunning, "still-running",
                "process is still running: this is what it has recorded so far",
                "processes are still running: this is what they have recorded so far"},
    DefectEntry{Defect::kMissingRank, "missing-rank", "rank has no stream", "ranks have no stream"},
    DefectEntry{Defect::kUnmatchedSend, "unmatched-send", "sent message was never received",
                "sent messages were never received"},
    DefectEntry{Defect::kUnmatchedReceive, "unmatched-receive",
                "received message was never seen sent", "received messages were never seen sent"},
    DefectEntry{Defect::kIncompleteCollective, "incomplete-collective",
                "collective operation lacks some of its ranks",
                "collective operations lack some of their ranks"},
    DefectEntry{Defect::kClockUnknown, "clock-unknown", "clock without a known rate",
                "clocks without a known rate"},
    DefectEntry{Defect::kClockUnsynchronised, "clock-unsynchronised",
                "computer's clock was never compared with the others'",
                "computers' clocks were never compared with the others'"},
    DefectEntry{Defect::kClockStep, "clock-step",
                "step of a thread's clock: times behind it are no better than their chunk's",
                "steps of threads' clocks: times behind them are no better than their chunks'"},
};

std::string SecondsText(std::int64_t ns) {
  char text[48];
  std::snprintf(text, sizeof text, "%.6f s", static_cast<double>(ns) * 1e-9);
  return text;
}

std::string TextOf(const std::optional<ProblemSpan>& when) {
  if (!when) return "";
  if (when->from_ns == when->to_ns) return ", at " + SecondsText(when->from_ns);
  return ", between " + SecondsText(when->from_ns) + " and " + SecondsText(when->to_ns);
}

}  // namespace

const DefectEntry& EntryOf(Defect defect) {
  return *std::ranges::find(kDefects, defect, &DefectEntry::defect);
}

std::string TextOf(const Problem& problem) {
  const DefectEntry& entry = EntryOf(problem.defect);
  return (problem.where.empty() ? "" : problem.where + ": ") + std::to_string(problem.count) + " " +
         std::string(problem.count == 1 ? entry.one : entry.many) + TextOf(problem.when);
}

void TraceHealth::Add(Defect defect, std::string_view where, std::uint64_t count,
                      std::optional<ProblemSpan> when) {
  if (count == 0) return;
  for (Problem& p : problems_) {
    if (p.defect == defect && p.where == where && p.when == when) {
      p.count += count;
      return;
    }
  }
  problems_.push_back({defect, std::string(where), count, when});
}

void TraceHealth::Add(const TraceHealth& other) {
  for (const Problem& p : other.problems_) Add(p.defect, p.where, p.count, p.when);
}

void TraceHealth::AddAt(std::string_view where, const TraceHealth& other) {
  for (const Problem& p : other.problems_) Add(p.defect, where, p.count, p.when);
}

std::uint64_t TraceHealth::CountOf(Defect defect) const {
  std::uint64_t count = 0;
  for (const Problem& p : problems_)
    if (p.defect == defect) count += p.count;
  return count;
}

std::uint64_t TraceHealth::LostEvents() const {
  return CountOf(Defect::kLostEvents) + CountOf(Defect::kUncommitted) +
         CountOf(Defect::kOpenRecord);
}

std::size_t TraceHealth::RunningPlaces() const {
  return static_cast<std::size_t>(
      std::ranges::count(problems_, Defect::kStillRunning, &Problem::defect));
}

void TraceHealth::ForgiveUnfinished() {
  constexpr std::array kMayCome = {Defect::kEmptyArchive,         Defect::kMissingRank,
                                   Defect::kUnmatchedSend,        Defect::kUnmatchedReceive,
                                   Defect::kIncompleteCollective, Defect::kClockUnknown};
  if (Running())
    std::erase_if(problems_, [&kMayCome](const Problem& p) {
      return std::ranges::find(kMayCome, p.defect) != kMayCome.end();
    });
}

bool TraceHealth::LostUncounted() const {
  constexpr std::array kUncounted = {
      Defect::kEmptyArchive, Defect::kUnreadableFile, Defect::kTruncatedFile, Defect::kBadChunk,
      Defect::kMissingChunk, Defect::kDamagedChunk,   Defect::kBadRecord,     Defect::kMissingRank};
  return std::ranges::any_of(kUncounted, [this](Defect d) { return CountOf(d) != 0; });
}

}  // namespace stipple
