// SPDX-License-Identifier: MIT
// stipple stats: one table, for people, spreadsheets or scripts.
#include <fmt/format.h>

#include <algorithm>

#include "analysis/report/text.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/team.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/selection_options.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

struct FormatEntry {
  std::string_view name;
  std::string (*text)(const Table&);
};
constexpr FormatEntry kFormats[] = {{"text", TableText}, {"csv", TableCsv}, {"json", TableJson}};

/// The row of that name; an InputError lists the names there are.
template <class Rows>
const auto& Choose(const Rows& rows, std::string_view option, const std::string& name) {
  const auto entry =
      std::ranges::find_if(rows, [&name](const auto& row) { return row.name == name; });
  if (entry != std::end(rows)) return *entry;
  std::string known;
  for (const auto& row : rows) known.append(" ").append(row.name);
  throw InputError(option, "'" + name + "' is unknown; known:" + known);
}

std::string TableHelp() {
  std::string text = "Tables:\n";
  for (const TableEntry& t : TableEntries())
    text += fmt::format("  {:<13}{}\n", t.name, t.description);
  return text;
}

/// Why the table is empty or of zeros; empty when there is something to count.
std::string NothingText(const Trace& trace, const Selection& selection) {
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) / 1e9; };
  if (trace.EventCount() == 0) return "The archive holds no events.";
  if (selection.begin_ns > trace.SpanNs())
    return fmt::format("There is nothing from {} s on: the run ends at {} s.",
                       seconds(selection.begin_ns), seconds(trace.SpanNs()));
  if (selection.begin_ns == selection.end_ns)
    return fmt::format("There is no time between {0} s and {0} s.", seconds(selection.end_ns));
  return {};
}

}  // namespace

int RunStats(const Arguments& arguments) {
  CommandOptions app("A statistic as a table.", "stats");
  std::string archive;
  std::string table;
  std::string format = "text";
  bool per_rank = false;
  SelectionOptions selected;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"--table", "NAME", "which; see below", true}, table);
  app.Add({"--format", "FORMAT", "text, csv or json"}, format);
  app.Add({"--per-rank", "", "a row for each rank instead of the sum"}, per_rank);
  selected.AddTo(app, kTakesEverything);
  app.Footer(TableHelp());
  if (!app.Parse(arguments)) return 0;
  const TableEntry& entry = Choose(TableEntries(), "--table", table);
  const FormatEntry& form = Choose(kFormats, "--format", format);
  selected.RefuseFor(entry);
  const std::int64_t window_ns = selected.WindowNs();
  // These are by rank anyway.
  if (per_rank && !entry.per_rank && entry.name != "states" && entry.name != "status")
    throw InputError("--per-rank", fmt::format("table '{}' cannot be given by rank", entry.name));
  ProgressLine progress;
  const Trace trace = Trace::Open(archive, progress.meter());
  const Selection selection = selected.For(trace);
  const Team team = Team::OfEnvironment();
  const bool together =
      team.size > 1 && trace.index() == nullptr && !trace.header_health().Running();
  const bool with_paths = entry.needs_paths && selection.WholeTime();
  if (together && team.rank != 0) LeaveShare(trace, team, with_paths);
  if (team.rank != 0) return 0;
  const Analysis analysis =
      together ? Analysis(trace, ScanTogether(trace, team, with_paths)) : Analysis(trace);
  const TableAnswer answer = entry.make(analysis, selection, {per_rank, window_ns});
  progress.Stop();
  const std::string nothing = NothingText(trace, selection);
  if (form.name == "text")
    WriteOut((nothing.empty() ? answer.headline : nothing) + RunningText(trace) + "\n\n");
  WriteOut(form.text(answer.table));
  if (!nothing.empty() && form.name != "text") fmt::print(stderr, "stipple: {}\n", nothing);
  WarnOfProblems(trace, analysis.health);
  return 0;
}

}  // namespace stipple
