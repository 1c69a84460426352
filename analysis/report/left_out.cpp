// SPDX-License-Identifier: MIT
#include "analysis/report/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "analysis/report/recorded.h"
#include "analysis/stats/number.h"
#include "analysis/trace/native_stack.h"

namespace stipple {
namespace {

/// Ticks of one stream as seconds; 0 if its clock's rate is not known.
double SecondsPerTick(const Stream& stream) {
  const auto [first, last] = std::ranges::minmax_element(stream.clock_pairs, {}, &ClockPair::ticks);
  if (first == stream.clock_pairs.end() || last->ticks <= first->ticks ||
      last->raw_ns <= first->raw_ns)
    return 0;
  return 1e-9 * static_cast<double>(last->raw_ns - first->raw_ns) /
         static_cast<double>(last->ticks - first->ticks);
}

std::uint64_t LastTicks(const Stream& stream) {
  std::uint64_t last = stream.end ? stream.end->ticks : 0;
  for (const ClockPair& pair : stream.clock_pairs) last = std::max(last, pair.ticks);
  return last;
}

std::string FilterText(const FilterTotals& filter) {
  if (filter.functions == 0)
    return fmt::format(
        "the filter {} was not applied: only functions of -finstrument-functions were recorded, "
        "which have no names while the program runs",
        filter.path);
  std::string text = filter.filtered == 0
                         ? fmt::format("the filter {} excludes none of the {}", filter.path,
                                       FormatCount(filter.functions, "function"))
                         : fmt::format("the filter {} left out {} of {}", filter.path,
                                       FormatCount(static_cast<std::int64_t>(filter.filtered)),
                                       FormatCount(filter.functions, "function"));
  if (filter.has_code) text += "; it is not applied to functions of -finstrument-functions";
  return text;
}

/// Whether the process met functions after its region ids had run out.
bool RanOutOfIds(const Process& process) {
  return std::ranges::any_of(process.stream->availability, [](const AvailabilityDefinition& a) {
    return a.what == "region ids" && !a.available;
  });
}

}  // namespace

Paused PausedOf(const Stream& stream) {
  Paused paused;
  std::uint64_t ticks = 0;
  std::uint64_t off_since = 0;
  bool on = true;
  for (const Switched& s : stream.switches) {
    if (s.region != 0 || (s.on != 0) == on) continue;
    on = s.on != 0;
    if (on)
      ticks += std::max(s.ticks, off_since) - off_since;
    else
      off_since = s.ticks;
    paused.times += on ? 0 : 1;
  }
  if (!on) ticks += std::max(LastTicks(stream), off_since) - off_since;
  paused.seconds = static_cast<double>(ticks) * SecondsPerTick(stream);
  return paused;
}

Paused LongestPaused(const Trace& trace) {
  Paused longest;
  for (const Process& p : trace.processes()) {
    const Paused paused = PausedOf(*p.stream);
    if (longest.times == 0 || paused.seconds > longest.seconds) longest = paused;
  }
  return longest;
}

FilterTotals FilterOf(const Trace& trace) {
  FilterTotals totals;
  for (const Process& p : trace.processes()) {
    const FilterUse& use = p.stream->filter;
    if (!use.path.empty()) totals.path = use.path;
    if (std::tie(use.filtered, use.functions) > std::tie(totals.filtered, totals.functions)) {
      totals.functions = use.functions;
      totals.filtered = use.filtered;
    }
    totals.has_code = totals.has_code || !p.stream->code.empty();
  }
  return totals;
}

std::vector<std::string> LeftOutTexts(const Trace& trace) {
  std::vector<std::string> texts = CrashTexts(trace);
  if (trace.kept())
    texts.push_back(fmt::format(
        "keeps only the last {}: from {} after the run's begin on, which is time 0 here; {} before "
        "were overwritten (--max-bytes)",
        FormatSeconds(static_cast<double>(trace.SpanNs()) * 1e-9),
        FormatSeconds(trace.kept()->from_s),
        FormatCount(trace.kept()->overwritten_events, "event")));
  if (const Paused paused = LongestPaused(trace); paused.times != 0)
    texts.push_back(fmt::format(
        "recording was switched off {}, {} in all: nothing of that time is shown, and functions "
        "that were open then include it",
        FormatCount(paused.times, "time"), FormatSeconds(paused.seconds)));
  if (const FilterTotals filter = FilterOf(trace); !filter.path.empty())
    texts.push_back(FilterText(filter));
  if (std::ranges::any_of(trace.processes(), RanOutOfIds))
    texts.push_back(fmt::format("more than {}: those that came later have no id and are left out",
                                FormatCount(std::uint64_t{kMaxRegion}, "function")));
  for (std::string& text : NotRecordedTexts(trace)) texts.push_back(std::move(text));
  return texts;
}

}  // namespace stipple
