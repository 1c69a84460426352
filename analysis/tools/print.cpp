// SPDX-License-Identifier: MIT
// stipple print: events as text, all locations in one order of time; canonical: one location after
// the other.
#include <fmt/format.h>
#include <unistd.h>

#include <queue>
#include <span>
#include <string>
#include <vector>

#include "analysis/report/event_text.h"
#include "analysis/stats/analysis.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/selection_options.h"
#include "analysis/trace/call_stack.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

/// Collects lines and writes them in large pieces.
class Output {
 public:
  ~Output() { WriteOut({buffer_.data(), buffer_.size()}); }
  template <class... Values>
  void Line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
    buffer_.push_back('\n');
    if (buffer_.size() < kBufferBytes) return;
    WriteOut({buffer_.data(), buffer_.size()});
    buffer_.clear();
  }

 private:
  fmt::memory_buffer buffer_;
};

/// Regions of the frames that the event ended without being their leave.
std::span<const std::uint32_t> Follow(const Process& process, CallStack& stack,
                                      const Event& event) {
  if (event.record != nullptr && KindOf(*event.record) == RecordKind::kOpenFrames) {
    std::vector<std::uint32_t> regions = OpenRegions(event.record, process.RegionCount());
    for (std::uint32_t& region : regions) region = process.regions[region];
    stack.Begin(event.record, regions);
    return {};
  }
  return event.record != nullptr ? stack.Record(event.record)
                                 : stack.Function(event.region, event.leave);
}

void PrintCanonical(const Trace& trace, const Selection& selection) {
  Output out;
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank)) continue;
    out.Line("location {} {} {}", l.rank, l.process, l.thread);
    EventCursor cursor(trace, l);
    CallStack stack;
    while (const Event* event = cursor.Next()) {
      const std::uint32_t context = stack.context();
      const std::span<const std::uint32_t> left = Follow(trace.ProcessOf(l), stack, *event);
      if ((!selection.WholeTime() || trace.kept()) &&
          !selection.HasTime(trace.TimeNs(l, event->ticks)))
        continue;
      if (stack.context() != context) out.Line("context {}", stack.context());
      for (const std::uint32_t region : left)
        out.Line("{} {}", event->record != nullptr ? "unwound" : "unclosed",
                 trace.regions()[region].name);
      if (const std::string text = CanonicalText(trace, l, *event); !text.empty())
        out.Line("{}", text);
    }
  }
}

/// A location that is being printed.
struct Reader {
  EventCursor cursor;
  std::string name;  // "3.0", "host.1", "3/1.0" for a further process
  const Event* event = nullptr;
  std::int64_t time_ns = 0;
  CallStack stack;

  bool Advance(const Trace& trace) {
    event = cursor.Next();
    if (event != nullptr) time_ns = trace.TimeNs(cursor.location(), event->ticks);
    return event != nullptr;
  }
};

std::string LocationName(const Trace& trace, const Location& l) {
  const std::string process = l.process == 0 ? "" : fmt::format("/{}", l.process);
  return fmt::format("{}{}.{}", trace.RankName(l.rank), process, l.thread);
}

/// What a jump did: " to main, 3 left", " to context 1".
std::string JumpText(const Trace& trace, const CallStack& stack, std::uint32_t context_before,
                     std::size_t left) {
  std::string text;
  if (stack.context() != context_before) text += fmt::format(" to context {}", stack.context());
  if (left == 0) return text;
  const char* top = stack.depth() == 0 ? "no function" : trace.regions()[stack.top()].name.c_str();
  return text + fmt::format(" to {}, {} left", top, left);
}

/// Where a message or a mark belongs: " in main > solve > exchange"; empty for other events.
std::string WhereText(const Trace& trace, const CallStack& stack, const EventWord* record) {
  switch (KindOf(*record)) {
    case RecordKind::kMark:
    case RecordKind::kMpiSend:
    case RecordKind::kMpiReceive:
    case RecordKind::kMpiCollective:
    case RecordKind::kThreadSend:
    case RecordKind::kThreadReceive:
      break;
    default:
      return {};
  }
  std::string text;
  for (const std::uint32_t region : stack.frames())
    text += (text.empty() ? "  in " : " > ") + ShortName(trace.regions()[region].name);
  return text;
}

void PrintOne(const Trace& trace, const Selection& selection, Reader& r, Output& out) {
  const bool enter = r.event->record == nullptr && !r.event->leave;
  const std::uint32_t context = r.stack.context();
  const std::size_t left = Follow(trace.ProcessOf(r.cursor.location()), r.stack, *r.event).size();
  if (!selection.HasTime(r.time_ns)) return;
  std::string text = EventText(trace, r.cursor.location(), *r.event);
  if (r.event->record != nullptr)
    text += JumpText(trace, r.stack, context, left) + WhereText(trace, r.stack, r.event->record);
  else if (left != 0)
    text += fmt::format("  ({} left unseen)", left);
  if (r.event->earliest != r.event->latest) {
    const auto before = r.time_ns - trace.TimeNs(r.cursor.location(), r.event->earliest);
    const auto after = trace.TimeNs(r.cursor.location(), r.event->latest) - r.time_ns;
    text += fmt::format("  (time -{} +{} ns)", before, after);
  }
  const std::size_t depth = r.stack.depth() - (enter ? 1 : 0);
  out.Line("{:>4}.{:09} {:>7}  {:{}}{}", r.time_ns / 1'000'000'000, r.time_ns % 1'000'000'000,
           r.name, "", 2 * std::min<std::size_t>(depth, 64), text);
}

void PrintMerged(const Trace& trace, const Selection& selection) {
  std::vector<Reader> readers;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank))
      readers.push_back({EventCursor(trace, l), LocationName(trace, l), nullptr, 0, {}});
  const auto later = [&readers](std::size_t a, std::size_t b) {
    return std::pair(readers[a].time_ns, a) > std::pair(readers[b].time_ns, b);
  };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> next(later);
  for (std::size_t i = 0; i < readers.size(); ++i)
    if (readers[i].Advance(trace)) next.push(i);
  Output out;
  while (!next.empty()) {
    const std::size_t i = next.top();
    next.pop();
    if (readers[i].time_ns >= selection.end_ns) continue;
    PrintOne(trace, selection, readers[i], out);
    if (readers[i].Advance(trace)) next.push(i);
  }
}

}  // namespace

int RunPrint(const Arguments& arguments) {
  CommandOptions app("Events as text, in order of time.", "print");
  std::string archive;
  bool canonical = false;
  SelectionOptions selection;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"--canonical", "", "for comparing: location after location, no times or ids"},
          canonical);
  selection.AddTo(app);
  if (!app.Parse(arguments)) return 0;
  ProgressLine progress;
  const Trace trace = Trace::Open(archive, progress.meter());
  const Selection selected = selection.For(trace);
  if (isatty(STDOUT_FILENO) != 0) progress.Stop();  // the events are progress enough
  std::uint64_t bytes = 0;
  for (const Location& l : trace.locations())
    if (selected.HasRank(l.rank)) bytes += l.stream->Bytes();
  trace.BeginPhase("printing", bytes);
  (canonical ? PrintCanonical : PrintMerged)(trace, selected);
  const TraceHealth health = Analysis(trace).health;
  progress.Stop();
  WarnOfProblems(trace, health);
  return 0;
}

}  // namespace stipple
