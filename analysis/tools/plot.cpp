// SPDX-License-Identifier: MIT
// stipple plot: computes the tables that a display shows; the library that draws it is opened only
// here, and it says which displays there are and what fits them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "analysis/report/plot_input.h"
#include "analysis/report/text.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/selection_options.h"
#include "analysis/tools/views_library.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

constexpr const char* kCommand = "stipple plot";
constexpr std::size_t kColumns = 1000;     // of a timeline
constexpr std::size_t kMostVisits = 3000;  // function bars beyond that are too thin to see

template <class Function>
Function FunctionOf(const char* name) {
  return reinterpret_cast<Function>(FunctionOfViews(kCommand, name));
}

using Choices = std::span<const PlotChoice>;

Choices ChoicesOfLibrary() {
  const PlotChoice* first = nullptr;
  const std::size_t count =
      FunctionOf<decltype(&stipple_plot_choices)>("stipple_plot_choices")(&first);
  return {first, count};
}

std::string Help(Choices choices) {
  std::string text = "Views (and the tables they show by themselves):\n";
  for (const PlotChoice& c : choices)
    text += fmt::format("  {:<10}{}{}\n", c.name, c.description,
                        c.tables.empty() ? "" : fmt::format(" ({})", c.tables));
  return text + "Tables: as of stipple stats.\n";
}

/// The row of that name; an InputError lists the names there are.
template <class Rows>
const auto& Choose(const Rows& rows, std::string_view option, std::string_view name) {
  const auto entry = std::ranges::find_if(rows, [&](const auto& row) { return row.name == name; });
  if (entry != std::end(rows)) return *entry;
  std::string known;
  for (const auto& row : rows) known.append(" ").append(row.name);
  throw InputError(option, fmt::format("'{}' is unknown; known:{}", name, known));
}

std::vector<std::string> Split(std::string_view text) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    if (comma > 0) parts.emplace_back(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return parts;
}

struct PlotOptions {
  std::string archive, view, tables, output, x, y;
  double at_s = std::numeric_limits<double>::quiet_NaN();
  bool mono = false;
  SelectionOptions selected;
};

/// What is made of an archive for one display.
struct Plot {
  const Analysis& analysis;
  const Selection& selection;
  const PlotChoice& choice;
  const SelectionOptions& selected;
  PlotInput input{};
  std::string headline{};

  /// The table in the form that fits: by rank or not. None, if neither does.
  std::optional<TableAnswer> Fitting(const TableEntry& entry, const PlotChoice& view) const {
    const bool first = view.by_rank && entry.per_rank;
    for (const bool per_rank : {first, !first}) {
      if (per_rank && !entry.per_rank) continue;
      TableAnswer answer =
          entry.make(analysis, selection, TableOptions{per_rank, selected.WindowNs()});
      if (view.fits(answer.table)) return answer;
    }
    return std::nullopt;
  }

  [[noreturn]] void Refuse(const TableEntry& entry, Choices choices) const {
    std::string views, tables;
    for (const PlotChoice& view : choices)
      if (view.fits != nullptr && Fitting(entry, view)) views.append(" ").append(view.name);
    for (const TableEntry& other : TableEntries())
      if (Fitting(other, choice)) tables.append(" ").append(other.name);
    throw InputError(
        "--table", fmt::format("'{}' does not fit view '{}'; views that fit it:{}; tables that fit "
                               "'{}':{}",
                               entry.name, choice.name, views.empty() ? " none" : views,
                               choice.name, tables.empty() ? " none" : tables));
  }

  void AddTable(const TableEntry& entry, Choices choices) {
    selected.RefuseFor(entry);
    std::optional<TableAnswer> answer = Fitting(entry, choice);
    if (!answer) Refuse(entry, choices);
    input.tables.push_back(std::move(answer->table));
    if (headline.empty()) headline = answer->headline;
  }

  void AddTimeline() {
    const double run_s = static_cast<double>(analysis.trace.SpanNs()) * 1e-9;
    const double begin_s =
        static_cast<double>(std::max<std::int64_t>(0, selection.begin_ns)) * 1e-9;
    const double end_s = selection.end_ns == Selection::kNoEnd
                             ? run_s
                             : std::min(run_s, static_cast<double>(selection.end_ns) * 1e-9);
    input.timeline = TimelineOf(analysis, begin_s, std::max(begin_s, end_s),
                                // Tables need the ranks' names and the span only.
                                choice.fits == nullptr ? kColumns : 1);
    // At the end of a run nothing happens any more.
    if (std::isnan(input.at_s)) input.at_s = (input.timeline.begin_s + input.timeline.end_s) / 2;
    KeepRanks();
    input.zoomed = !selection.WholeTime();
    if (input.zoomed && choice.fits == nullptr)
      input.visits = VisitBarsOf(analysis.trace, input.timeline, kMostVisits);
  }

  /// Rows that were not asked for leave, and their messages with them.
  void KeepRanks() {
    if (!selection.ranks) return;
    Timeline& timeline = input.timeline;
    std::vector<std::size_t> place(timeline.rows.size(), timeline.rows.size());
    std::vector<TimelineRow> kept;
    for (std::size_t i = 0; i < timeline.rows.size(); ++i) {
      if (!selection.HasRank(timeline.rows[i].rank)) continue;
      place[i] = kept.size();
      kept.push_back(std::move(timeline.rows[i]));
    }
    std::erase_if(timeline.messages, [&](TimelineMessage& message) {
      message.sender_row = place[message.sender_row];
      message.receiver_row = place[message.receiver_row];
      return message.sender_row == place.size() || message.receiver_row == place.size();
    });
    std::erase_if(timeline.marks,
                  [&](const TimelineMark& mark) { return !selection.HasRank(mark.rank); });
    timeline.message_count = std::min(timeline.message_count, timeline.messages.size());
    timeline.rows = std::move(kept);
  }
};

/// Columns that are asked for must be there: in one of the tables, as themselves or behind its
/// name.
void CheckColumns(const std::vector<Table>& tables, std::string_view option,
                  const std::vector<std::string>& asked) {
  for (const std::string& name : asked) {
    std::string known;
    bool found = false;
    for (const Table& table : tables)
      for (const Column& column : table.columns) {
        found = found || name == column.name || name == table.name + "." + column.name;
        known.append(" ").append(column.name);
      }
    if (!found) throw InputError(option, fmt::format("'{}' is unknown; columns:{}", name, known));
  }
}

void AddOptions(CommandOptions& app, PlotOptions& options) {
  app.Add({"A", "", "the archive", true}, options.archive);
  app.Add({"--view", "NAME", "how; see below", true}, options.view);
  app.Add({"--table", "NAME,...", "what, with commas between"}, options.tables);
  app.Add({"-o", "F.svg|pdf|png", "the picture, by its ending (default: VIEW.svg)"},
          options.output);
  app.Add({"--mono", "", "patterns instead of colours"}, options.mono);
  options.selected.AddTo(app, kTakesEverything);
  app.Add({"--at", "SECONDS", "the moment that dials, leds, status and kiviat show"}, options.at_s);
  app.Add({"--x", "COLUMN", "column along the x axis (graph)"}, options.x);
  app.Add({"--y", "COLUMN,...", "columns to show, with commas between"}, options.y);
}

void CheckOutput(const std::string& output) {
  for (const std::string_view ending : {".svg", ".pdf", ".png"})
    if (output.ends_with(ending)) return;
  throw InputError("-o", "'" + output + "' ends in none of .svg .pdf .png");
}

Plot Compute(const Analysis& analysis, const Selection& selection, const PlotOptions& options,
             const PlotChoice& choice, Choices choices) {
  Plot plot{analysis, selection, choice, options.selected};
  plot.input.view = options.view;
  plot.input.mono = options.mono;
  plot.input.at_s = options.at_s;
  plot.input.x = options.x;
  plot.input.columns = Split(options.y);
  if (choice.fits == nullptr)
    options.selected.RefuseFor({choice.name, nullptr, choice.description, false, kTakesPlace});
  if (choice.fits == nullptr && !options.tables.empty())
    throw InputError("--table", fmt::format("view '{}' shows no table", choice.name));
  const std::string names = options.tables.empty() ? std::string(choice.tables) : options.tables;
  for (const std::string& name : Split(names))
    plot.AddTable(Choose(TableEntries(), "--table", name), choices);
  CheckColumns(plot.input.tables, "--y", plot.input.columns);
  CheckColumns(plot.input.tables, "--x", Split(options.x));
  plot.input.finding = FindingOf(analysis, selection, BlameOf(analysis, selection));
  plot.AddTimeline();
  if (choice.fits == nullptr) plot.headline = plot.input.finding.sentence;
  return plot;
}

}  // namespace

int RunPlot(const Arguments& arguments) {
  CommandOptions app("A display of one or more statistics as SVG, PDF or PNG; no display needed.",
                     "plot");
  PlotOptions options;
  AddOptions(app, options);
  const Choices choices = ChoicesOfLibrary();
  app.Footer(Help(choices));
  if (!app.Parse(arguments)) return 0;
  const PlotChoice& choice = Choose(choices, "--view", options.view);
  if (options.output.empty()) options.output = options.view + ".svg";
  CheckOutput(options.output);
  for (const std::string& name : Split(options.tables)) Choose(TableEntries(), "--table", name);
  ProgressLine progress;
  const Trace trace = Trace::Open(options.archive, progress.meter());
  const Selection selection = options.selected.For(trace);
  const Analysis analysis(trace);
  const Plot plot = Compute(analysis, selection, options, choice, choices);
  trace.BeginPhase("drawing", 0);
  const Drawer<PlotInput> draw(kCommand, "stipple_draw_plot");
  draw(plot.input, options.output);
  progress.Stop();
  const bool empty = trace.EventCount() == 0;
  WriteOut((empty ? "The archive holds no events." : plot.headline) + RunningText(trace) + "\n" +
           options.output + "\n");
  WarnOfProblems(trace, analysis.health);
  return 0;
}

}  // namespace stipple
