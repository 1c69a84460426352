// SPDX-License-Identifier: MIT
#include "analysis/stats/counters.h"

#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace stipple {
namespace {

struct CounterEvent {
  std::size_t process = 0;  // in Trace::processes
  std::uint32_t name = 0;   // of the archive
  std::int64_t time_ns = 0;
  double value = 0;
};

/// Collects the counters of one location.
struct CounterVisitor {
  const Trace& trace;
  const Location& location;
  const Selection& selection;
  std::vector<CounterEvent> events = {};

  void Function(std::uint32_t, bool, std::uint64_t) {}
  void Record(const EventWord* record, std::uint64_t ticks) {
    if (KindOf(*record) != RecordKind::kCounter) return;
    const std::int64_t time_ns = trace.TimeNs(location, ticks);
    if (!selection.HasTime(time_ns)) return;
    const auto r = RecordAt<Counter>(record);
    events.push_back(
        {location.process_index, trace.ProcessOf(location).NameOf(r.name), time_ns, r.value});
  }
};

/// All counter events of the selection, by process and name, then in order of time.
std::vector<CounterEvent> EventsOf(const Trace& trace, const Selection& selection) {
  std::vector<const Location*> some;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) some.push_back(&l);
  std::vector<std::vector<CounterEvent>> found(trace.locations().size());
  trace.ForEachOf(some, "counters", [&](const Location& l) {
    CounterVisitor visitor{trace, l, selection};
    trace.Scan(l, visitor);
    found[l.index] = std::move(visitor.events);
  });
  std::vector<CounterEvent> events;
  for (const auto& of_location : found)
    events.insert(events.end(), of_location.begin(), of_location.end());
  std::ranges::stable_sort(
      events, {}, [](const CounterEvent& e) { return std::tuple(e.process, e.name, e.time_ns); });
  return events;
}

/// Mean of the values, each weighted by how long it held, the last one until `end_ns`; the plain
/// mean when no time passed.
double MeanOver(std::span<const CounterEvent> events, std::int64_t end_ns) {
  double sum = 0;
  double weighted = 0;
  double span_ns = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::int64_t until_ns = i + 1 < events.size() ? events[i + 1].time_ns : end_ns;
    const auto held_ns =
        static_cast<double>(std::max<std::int64_t>(0, until_ns - events[i].time_ns));
    sum += events[i].value;
    weighted += events[i].value * held_ns;
    span_ns += held_ns;
  }
  return span_ns > 0 ? weighted / span_ns : sum / static_cast<double>(events.size());
}

}  // namespace

Table CountersTable(const Trace& trace, const Selection& selection) {
  std::vector<std::int64_t> end_ns(trace.processes().size());
  for (const Location& l : trace.locations())
    end_ns[l.process_index] =
        std::max(end_ns[l.process_index], std::min(l.end_ns, selection.end_ns));
  Table table{"counters",
              TableShape::kRows,
              {{"rank"},
               {"process"},
               {"name"},
               {"unit"},
               {"count"},
               {"first"},
               {"last"},
               {"min"},
               {"max"},
               {"mean"}},
              {}};
  const std::vector<CounterEvent> events = EventsOf(trace, selection);
  for (std::size_t begin = 0; begin < events.size();) {
    const CounterEvent& first = events[begin];
    std::size_t end = begin;
    while (end < events.size() && events[end].process == first.process &&
           events[end].name == first.name)
      ++end;
    const std::span of_counter(events.data() + begin, end - begin);
    const auto [least, greatest] = std::ranges::minmax(of_counter, {}, &CounterEvent::value);
    const Process& process = trace.processes()[first.process];
    const Name& name = trace.names()[first.name];
    table.rows.push_back(RowOf(std::int64_t{process.rank}, std::int64_t{process.process}, name.text,
                               name.unit, static_cast<std::int64_t>(of_counter.size()), first.value,
                               of_counter.back().value, least.value, greatest.value,
                               MeanOver(of_counter, end_ns[first.process])));
    begin = end;
  }
  std::ranges::stable_sort(table.rows, {}, [](const std::vector<Cell>& row) {
    return std::tuple(std::get<std::int64_t>(row[0]), std::get<std::int64_t>(row[1]),
                      std::get<std::string>(row[2]));
  });
  return table;
}

TableAnswer CountersAnswer(const Analysis& analysis, const Selection& selection,
                           const TableOptions&) {
  Table table = CountersTable(analysis.trace, selection);
  std::string headline = table.rows.empty()
                             ? "No counter was recorded."
                             : "What the program counted: each value holds until the next one.";
  return {std::move(table), std::move(headline)};
}

}  // namespace stipple
