// SPDX-License-Identifier: MIT
#include "analysis/trace/native_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string_view>
#include <utility>

#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

constexpr std::uint32_t kEndsByAbort = 3;
constexpr std::uint32_t kEndsBySignal = 5;

template <class Record>
NativeFrames FramesBehind(const EventWord* record) {
  const auto head = RecordAt<Record>(record);
  return {{record + sizeof(Record) / sizeof(EventWord), head.frames},
          head.cut,
          Record::kKind == RecordKind::kCallPath};
}

/// Calls `use(names, word)` for each frame, innermost first, and `left_out(count)` where some are
/// missing.
template <class Use, class LeftOut>
void ForEachFrame(const Trace& trace, const Process& process, const NativeFrames& frames, Use use,
                  LeftOut left_out) {
  const std::size_t count = frames.words.size();
  const bool inside = frames.cut != 0 && frames.cut != kUnknownCut && count > kMostOuterFrames;
  for (std::size_t i = 0; i < count; ++i) {
    if (inside && i == count - kMostOuterFrames) left_out(frames.cut);
    const bool is_return = i != 0 || frames.first_is_call;
    use(trace.FrameNamesOf(process, frames.words[i], is_return), frames.words[i]);
  }
  if (frames.cut != 0 && !inside) left_out(frames.cut);
}

/// Libraries whose functions only pass a failure on: abort, assertions, terminate.
bool PassesFailureOn(const FrameName& frame) {
  static constexpr std::string_view kModules[] = {"libc.so.6", "libstdc++.so.6", "libstipple.so",
                                                  "libpthread.so.0"};
  return std::ranges::find(kModules, std::string_view(frame.module)) != std::end(kModules);
}

std::string PlaceText(const FrameName& name, std::uint64_t word) {
  if (!name.file.empty())
    return fmt::format("{} ({}:{})", ShortName(name.name),
                       std::filesystem::path(name.file).filename().string(), name.line);
  if (name.known) return fmt::format("{} ({})", ShortName(name.name), name.module);
  if (name.module.empty()) return fmt::format("{:#x}", word);
  return fmt::format("{}+{:#x}", name.module, word & kFrameOffsetMask);
}

/// Where the program was at fault: not the library that was told so.
std::string FaultPlace(const Trace& trace, const Process& process, const CrashedThread& thread) {
  std::string first;
  std::string place;
  ForEachFrame(
      trace, process, thread.Frames(),
      [&](const std::vector<FrameName>& names, std::uint64_t word) {
        if (first.empty()) first = PlaceText(names.front(), word);
        if (place.empty() && !PassesFailureOn(names.front()))
          place = PlaceText(names.front(), word);
      },
      [](std::uint32_t) {});
  return place.empty() ? first : place;
}

std::string WhoText(const Trace& trace, const Process& process) {
  if (process.in_world) return "rank " + trace.RankName(process.rank);
  return fmt::format("{} (pid {})", process.stream->program, process.stream->header.pid);
}

/// The last crash record of one thread: behind it there is nothing but the end. Copied: words of a
/// compacted chunk are gone after the scan.
struct CrashFinder {
  std::vector<EventWord> found;
  void Function(std::uint32_t, bool, std::uint64_t) {}
  void Record(const EventWord* record, std::uint64_t) {
    if (KindOf(*record) == RecordKind::kCrash) found.assign(record, record + WordsOf(*record));
  }
};

bool EndedBySignal(const Process& process) {
  return process.stream->end &&
         (process.stream->end->how == kEndsBySignal || process.stream->end->how == kEndsByAbort);
}

}  // namespace

NativeFrames FramesOf(const EventWord* record) {
  switch (KindOf(*record)) {
    case RecordKind::kSample:
      return FramesBehind<Sample>(record);
    case RecordKind::kCallPath:
      return FramesBehind<CallPath>(record);
    case RecordKind::kCrash:
      return FramesBehind<Crash>(record);
    default:
      return {};
  }
}

std::vector<std::string> PathOf(const Trace& trace, const Process& process,
                                const NativeFrames& frames) {
  std::vector<std::string> path;
  ForEachFrame(
      trace, process, frames,
      [&path](const std::vector<FrameName>& names, std::uint64_t) {
        for (const FrameName& n : names) path.push_back(n.name);
      },
      [&path](std::uint32_t) { path.emplace_back("..."); });
  std::ranges::reverse(path);
  return path;
}

std::vector<CrashedThread> CrashesOf(const Trace& trace) {
  std::vector<CrashedThread> crashes;
  for (const Location& l : trace.locations()) {
    const Process& process = trace.ProcessOf(l);
    if (!EndedBySignal(process)) continue;
    CrashFinder finder;
    ScanCounts counts;
    ScanPosition at;
    at.chunk = l.stream->chunks.size() - 1;
    ScanSome(*l.stream, process.RegionCount(), kNoTickLimit, at, counts, finder);
    if (finder.found.empty()) continue;
    const auto crash = RecordAt<Crash>(finder.found.data());
    crashes.push_back({&l, crash, std::move(finder.found)});
  }
  std::stable_partition(crashes.begin(), crashes.end(),
                        [](const CrashedThread& t) { return t.crash.signal != 0; });
  return crashes;
}

std::string SignalName(int signal) {
  static constexpr std::pair<int, std::string_view> kNames[] = {
      {SIGSEGV, "SIGSEGV"}, {SIGBUS, "SIGBUS"}, {SIGILL, "SIGILL"},  {SIGFPE, "SIGFPE"},
      {SIGABRT, "SIGABRT"}, {SIGSYS, "SIGSYS"}, {SIGTRAP, "SIGTRAP"}};
  for (const auto& [number, name] : kNames)
    if (number == signal) return std::string(name);
  return fmt::format("signal {}", signal);
}

std::vector<std::string> CrashTexts(const Trace& trace) {
  std::vector<std::string> texts;
  std::vector<bool> told(trace.processes().size());
  for (const CrashedThread& t : CrashesOf(trace)) {
    if (t.crash.signal == 0) continue;
    const Process& process = trace.ProcessOf(*t.location);
    told[t.location->process_index] = true;
    std::string what = SignalName(t.crash.signal);
    if (t.crash.code > 0 && t.crash.signal != SIGTRAP)
      what += fmt::format(" at {:#x}", t.crash.address);
    if (t.crash.code == 0) what += fmt::format(" sent by process {}", t.crash.address);
    texts.push_back(fmt::format("{} crashed: {} in {}", WhoText(trace, process), what,
                                FaultPlace(trace, process, t)));
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Process& process = trace.processes()[i];
    if (!told[i] && EndedBySignal(process))
      texts.push_back(fmt::format("{} crashed: {}", WhoText(trace, process),
                                  SignalName(process.stream->end->status)));
  }
  return texts;
}

std::vector<std::string> StackLines(const Trace& trace, const Process& process,
                                    const NativeFrames& frames) {
  std::vector<std::pair<std::string, std::size_t>> places;
  const auto add = [&places](std::string place) {
    if (places.empty() || places.back().first != place) places.emplace_back(std::move(place), 0);
    ++places.back().second;
  };
  ForEachFrame(
      trace, process, frames,
      [&add](const std::vector<FrameName>& names, std::uint64_t word) {
        for (const FrameName& n : names) add(PlaceText(n, word));
      },
      [&add](std::uint32_t cut) {
        add(cut == kUnknownCut ? "(more)" : fmt::format("({} frames left out)", cut));
      });
  std::vector<std::string> lines;
  for (const auto& [place, times] : places)
    lines.push_back(times == 1 ? place : fmt::format("{}, {} times", place, times));
  return lines;
}

}  // namespace stipple
