// SPDX-License-Identifier: MIT
// stipple info: what an archive holds.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/report/left_out.h"
#include "analysis/report/recorded.h"
#include "analysis/report/text.h"
#include "analysis/stats/analysis.h"
#include "analysis/stats/number.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/trace/native_stack.h"
#include "analysis/trace/ranks.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

Json ClockJson(const Analysis& info) {
  const ClockReport& clock = info.trace.clock();
  const auto& processes = info.trace.processes();
  return {{"kind", clock.kind == ClockKind::kVirtual ? "virtual" : "tsc"},
          {"settings", processes.empty() ? "" : processes.front().stream->settings},
          {"hz", clock.hz > 0 ? Json(clock.hz) : Json(nullptr)},
          {"computers", clock.computers},
          {"synchronised", clock.synchronised},
          {"residual_s", clock.synchronised ? Json(clock.residual_ns * 1e-9) : Json(nullptr)},
          {"reversed_messages", info.mpi.reversed}};
}

/// What was recorded and what could not be.
Json RecordedJson(const Trace& trace) {
  Json recorded = Json::object();
  for (const Recorded& r : RecordedOf(trace)) recorded[r.what] = r.available;
  return recorded;
}

/// Why not.
Json NotRecordedJson(const Trace& trace) {
  Json reasons = Json::array();
  for (const Recorded& r : RecordedOf(trace))
    if (!r.available)
      reasons.push_back({{"what", r.what}, {"errno", r.error}, {"reason", r.Reason()}});
  return reasons;
}

/// Null: there was no filter.
Json FilterJson(const Trace& trace) {
  const FilterTotals filter = FilterOf(trace);
  if (filter.path.empty()) return nullptr;
  return {{"file", filter.path}, {"functions", filter.functions}, {"filtered", filter.filtered}};
}

/// Null: nothing was overwritten.
Json RingJson(const Trace& trace) {
  if (!trace.kept()) return nullptr;
  return {{"kept_from_s", trace.kept()->from_s},
          {"kept_s", Seconds(trace.SpanNs())},
          {"overwritten_events", trace.kept()->overwritten_events},
          {"overwritten_bytes", trace.kept()->overwritten_bytes}};
}

/// Null: more than can be counted.
Json LostJson(const TraceHealth& health) {
  return health.LostUncounted() ? Json(nullptr) : Json(health.LostEvents());
}

/// Threads of crashed processes, those that were hit first.
Json CrashesJson(const Trace& trace) {
  Json crashes = Json::array();
  for (const CrashedThread& t : CrashesOf(trace)) {
    const bool hit = t.crash.signal != 0;
    const bool has_address = hit && t.crash.code > 0;
    crashes.push_back({{"rank", t.location->rank},
                       {"process", t.location->process},
                       {"thread", t.location->thread},
                       {"signal", hit ? Json(SignalName(t.crash.signal)) : Json(nullptr)},
                       {"address", has_address ? Json(t.crash.address) : Json(nullptr)},
                       {"stack", StackLines(trace, trace.ProcessOf(*t.location), t.Frames())}});
  }
  return crashes;
}

/// Each crashed thread and its stack.
std::string CrashesText(const Trace& trace) {
  std::string text;
  for (const CrashedThread& t : CrashesOf(trace)) {
    const std::string thread =
        fmt::format("{}.{}", trace.RankName(t.location->rank), t.location->thread);
    text += fmt::format("\n{:<11}thread {}\n",
                        t.crash.signal != 0 ? SignalName(t.crash.signal) : "meanwhile", thread);
    for (const std::string& line : StackLines(trace, trace.ProcessOf(*t.location), t.Frames()))
      text += fmt::format("           {}\n", line);
  }
  return text;
}

Json JobsJson(const Trace& trace) {
  Json jobs = Json::array();
  for (const Job& j : JobsOf(trace.processes()))
    jobs.push_back({{"program", j.program}, {"first_rank", j.first_rank}, {"ranks", j.rank_count}});
  return jobs;
}

std::string InfoJson(const Analysis& info) {
  const Trace& trace = info.trace;
  Json locations = Json::array();
  for (const Location& l : trace.locations())
    locations.push_back({{"rank", l.rank},
                         {"process", l.process},
                         {"thread", l.thread},
                         {"events", trace.CountsOf(l).Events()}});
  Json problems = Json::array();
  for (const Problem& p : info.health.problems()) {
    if (p.defect == Defect::kStillRunning) continue;
    problems.push_back(
        {{"problem", EntryOf(p.defect).name}, {"where", p.where}, {"count", p.count}});
    if (!p.when) continue;
    problems.back()["from_s"] = Seconds(p.when->from_ns);
    problems.back()["to_s"] = Seconds(p.when->to_ns);
  }
  const Json json = {{"program", trace.Program()},
                     {"locations", locations},
                     {"ranks", trace.RankCount()},
                     {"processes", trace.processes().size()},
                     {"events", trace.EventCount()},
                     {"lost", LostJson(info.health)},
                     {"messages", info.mpi.matched},
                     {"unmatched_messages", info.mpi.Unmatched()},
                     {"thread_messages", info.mpi.thread_messages.matched.size()},
                     {"unmatched_thread_messages", info.mpi.thread_messages.unmatched.size()},
                     {"span_s", Seconds(trace.SpanNs())},
                     {"paused_s", LongestPaused(trace).seconds},
                     {"paused_times", LongestPaused(trace).times},
                     {"ring", RingJson(trace)},
                     {"filter", FilterJson(trace)},
                     {"clock", ClockJson(info)},
                     {"recorded", RecordedJson(trace)},
                     {"not_recorded", NotRecordedJson(trace)},
                     {"jobs", JobsJson(trace)},
                     {"crashes", CrashesJson(trace)},
                     {"running", info.health.CountOf(Defect::kStillRunning)},
                     {"problems", problems}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ClockText(const Analysis& info) {
  const ClockReport& clock = info.trace.clock();
  if (clock.kind == ClockKind::kVirtual) return "virtual time";
  if (clock.computers <= 1)
    return fmt::format("one time-stamp counter, {:.6f} MHz", clock.hz / 1e6);
  if (!clock.synchronised)
    return fmt::format("{} computers, not synchronised by readings", clock.computers);
  return fmt::format("{} computers, synchronised to {}; {} against the order of time",
                     clock.computers, FormatSeconds(clock.residual_ns * 1e-9),
                     FormatCount(info.mpi.reversed, "message"));
}

std::string InfoText(const Analysis& info) {
  const Trace& trace = info.trace;
  const auto rank_count = static_cast<std::uint64_t>(trace.RankCount());
  std::string text = fmt::format(
      "{}: {} on {} in {}, {}{}\n", trace.path(), FormatCount(trace.EventCount(), "event"),
      FormatCount(rank_count, "rank"), FormatSeconds(Seconds(trace.SpanNs())),
      LossText(info.health), RunningText(trace));
  text += fmt::format("program    {}\n", trace.Program());
  text += fmt::format("processes  {}\n", trace.processes().size());
  text += fmt::format("threads    {}\n", trace.locations().size());
  text += fmt::format("messages   {} matched ({} sent), {} unmatched\n",
                      FormatCount(static_cast<std::int64_t>(info.mpi.matched)),
                      FormatBytes(static_cast<double>(info.mpi.bytes)),
                      FormatCount(static_cast<std::int64_t>(info.mpi.Unmatched())));
  if (const ThreadMessages& m = info.mpi.thread_messages;
      m.matched.size() + m.unmatched.size() != 0)
    text += fmt::format("           {} between threads matched, {} unmatched\n",
                        FormatCount(m.matched.size(), "message"),
                        FormatCount(static_cast<std::int64_t>(m.unmatched.size())));
  text += fmt::format("clock      {}\n", ClockText(info));
  if (const std::string recorded = RecordedText(trace); !recorded.empty())
    text += fmt::format("recorded   {}\n", recorded);
  if (const Paused paused = LongestPaused(trace); paused.times != 0)
    text += fmt::format("paused     {}, {}\n", FormatSeconds(paused.seconds),
                        FormatCount(paused.times, "time"));
  if (trace.kept())
    text += fmt::format("ring       keeps the last {}, from {} on; {} overwritten\n",
                        FormatSeconds(Seconds(trace.SpanNs())), FormatSeconds(trace.kept()->from_s),
                        FormatCount(trace.kept()->overwritten_events, "event"));
  if (const FilterTotals filter = FilterOf(trace); !filter.path.empty())
    text += fmt::format("filter     {}: {} of {} left out\n", filter.path,
                        FormatCount(static_cast<std::int64_t>(filter.filtered)),
                        FormatCount(filter.functions, "function"));
  text += CrashesText(trace);
  text += '\n';
  Table table{"locations",
              TableShape::kRows,
              {{"rank"}, {"process"}, {"thread"}, {"events"}, {"begin_s"}, {"end_s"}},
              {}};
  for (const Location& l : trace.locations())
    table.rows.push_back({trace.RankName(l.rank), std::int64_t{l.process}, std::int64_t{l.thread},
                          static_cast<std::int64_t>(trace.CountsOf(l).Events()),
                          Seconds(l.begin_ns), Seconds(l.end_ns)});
  return text + TableText(table);
}

}  // namespace

int RunInfo(const Arguments& arguments) {
  CommandOptions app("What an archive holds.", "info");
  std::string archive;
  bool json = false;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"--json", "", "as one JSON object"}, json);
  if (!app.Parse(arguments)) return 0;
  ProgressLine progress;
  const Trace trace = Trace::Open(archive, progress.meter());
  const Analysis analysis(trace);
  progress.Stop();
  WriteOut(json ? InfoJson(analysis) : InfoText(analysis));
  if (!json) WarnOfProblems(trace, analysis.health);
  return 0;
}

}  // namespace stipple
