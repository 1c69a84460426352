// SPDX-License-Identifier: MIT
// The pages about the nodes at a moment, and about time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "analysis/report/html_pages.h"
#include "analysis/report/html_panel.h"
#include "analysis/report/html_table.h"
#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"
#include "analysis/views/layout.h"
#include "analysis/views/quantity.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostDials = 32;  // more nodes have no room for one each
constexpr std::size_t kMostTableRows = 12;

/// Rows time_s, rank, utilisation: what contours are drawn from.
Table UtilisationByRow(const ViewInput& views, std::size_t steps) {
  Table table{"utilisation", TableShape::kRows, {{"time_s"}, {"rank"}, {"utilisation"}}, {}};
  const Timeline& timeline = *views.timeline;
  const double length = timeline.end_s - timeline.begin_s;
  std::vector<std::vector<StateShares>> columns;
  for (const TimelineRow& row : timeline.rows)
    columns.push_back(AverageColumns(std::span(&row, 1), steps));
  for (std::size_t i = 0; i < steps; ++i)
    for (std::size_t r = 0; r < columns.size(); ++r)
      table.rows.push_back(stipple::RowOf(
          timeline.begin_s + length * static_cast<double>(i) / static_cast<double>(steps),
          std::int64_t{timeline.rows[r].rank}, static_cast<double>(columns[r][i][0])));
  return table;
}

/// Rows rank, utilisation: of the whole run.
Table UtilisationOfRun(const ViewInput& views) {
  Table table{"utilisation", TableShape::kRows, {{"rank"}, {"utilisation"}}, {}};
  for (const TimelineRow& row : views.timeline->rows)
    table.rows.push_back(
        stipple::RowOf(std::int64_t{row.rank},
                       static_cast<double>(AverageColumns(std::span(&row, 1), 1).front()[0])));
  return table;
}

/// Any small table as it is.
std::string PlainTable(const Table& table, const std::string& caption, const Timeline& timeline) {
  const std::string noun(NounFor(timeline));
  const std::int64_t host = HostOf(timeline);
  std::string text = fmt::format(
      "<div class=\"scroll\"><table class=\"plain\"><caption "
      "class=\"unseen\">{}</caption><thead><tr>",
      EscapeMarkup(caption));
  for (const Column& column : table.columns) {
    std::string name = column.name;
    if (name.ends_with("_s")) name.resize(name.size() - 2);
    std::ranges::replace(name, '_', ' ');
    const bool is_text = !table.rows.empty() && std::holds_alternative<std::string>(
                                                    CellOf(table, table.rows.front(), column.name));
    text += fmt::format("<th scope=\"col\"{}>{}</th>", is_text ? "" : " class=\"n\"",
                        EscapeMarkup(name == "rank"           ? noun
                                     : name == "busiest rank" ? "busiest " + noun
                                                              : name));
  }
  text += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < std::min(table.rows.size(), kMostTableRows); ++r) {
    text += "<tr>";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const Cell& cell = table.rows[r][c];
      const std::string& name = table.columns[c].name;
      const bool share = QuantityOf(name) == Quantity::kShare;
      if (const auto* words = std::get_if<std::string>(&cell))
        text += fmt::format("<td title=\"{}\">{}</td>", EscapeMarkup(ShortenMiddle(*words, 600)),
                            EscapeMarkup(ShortenMiddle(ShortName(*words), 60)));
      else if (std::holds_alternative<std::monostate>(cell))
        text += "<td class=\"n\">\u2013</td>";
      else if (name == "begin_s" && table.columns.size() > c + 1 &&
               table.columns[c + 1].name == "end_s")
        text += fmt::format(
            "<td class=\"n\"><a href=\"#timeline\" data-from=\"{:.9g}\" "
            "data-to=\"{:.9g}\">{}</a></td>",
            CellNumber(cell), CellNumber(table.rows[r][c + 1]), FormatSeconds(CellNumber(cell)));
      else if (name.ends_with("_s") || name == "seconds")
        text += fmt::format("<td class=\"n\">{}</td>", FormatSeconds(CellNumber(cell)));
      else if (share)
        text += fmt::format("<td class=\"n\">{}</td>", FormatPercent(CellNumber(cell)));
      else if (const auto* whole = std::get_if<std::int64_t>(&cell))
        text += fmt::format("<td class=\"n\">{}</td>",
                            name == "rank" && *whole == host ? "host" : FormatCount(*whole));
      else
        text += fmt::format("<td class=\"n\">{}</td>", FormatThreeDigits(CellNumber(cell)));
    }
    text += "</tr>\n";
  }
  text += "</tbody></table></div>";
  if (table.rows.size() > kMostTableRows)
    text += fmt::format(
        "<p class=\"more\">and {} more: <code>stipple stats ARCHIVE --table {}</code></p>",
        FormatCount(static_cast<std::int64_t>(table.rows.size() - kMostTableRows)), table.name);
  return text;
}

std::string TableSection(const Table& table, const std::string& heading, std::string_view id,
                         const std::string& sentence, const Timeline& timeline,
                         const std::string& style = "half") {
  if (table.rows.empty()) return {};
  std::string lead;
  if (!sentence.empty()) lead = "<p>" + EscapeMarkup(sentence) + "</p>";
  return PanelAround({.heading = heading, .style = style, .id = id},
                     lead + PlainTable(table, heading, timeline));
}

/// Efficiencies as bars: parts of one, each the factor of what stands above it.
std::string EfficiencyPanel(const ReportInput& input) {
  if (input.efficiency.rows.empty()) return {};
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"parallel_efficiency", "parallel efficiency"},
      {"load_balance", "load balance"},
      {"communication_efficiency", "communication"},
      {"serialisation_efficiency", "serialisation"},
      {"transfer_efficiency", "transfer"}};
  std::string text =
      "<table class=\"plain\"><caption class=\"unseen\">Efficiencies</caption><tbody>\n";
  for (const auto& [name, title] : kNames) {
    const Cell cell = CellOf(input.efficiency, input.efficiency.rows.front(), name);
    const bool known = !std::holds_alternative<std::monostate>(cell);
    text += fmt::format("<tr><th scope=\"row\">{}</th>", title);
    text += known
                ? fmt::format(
                      "<td class=\"share\"><span><i aria-hidden=\"true\"><b "
                      "style=\"width:100%\"></b><b style=\"width:{:.1f}%\"></b></i>{}"
                      "</span></td></tr>\n",
                      std::clamp(CellNumber(cell), 0.0, 1.0) * 100, FormatPercent(CellNumber(cell)))
                : "<td>not known</td></tr>\n";
  }
  std::string lead;
  if (!input.efficiency_text.empty()) lead = "<p>" + EscapeMarkup(input.efficiency_text) + "</p>";
  return PanelAround({.heading = "Efficiencies",
                      .style = "half",
                      .id = "efficiency",
                      .note = "parallel = load balance \u00d7 communication; communication = "
                              "serialisation \u00d7 transfer"},
                     lead + text + "</tbody></table>");
}

bool HasTime(const ViewInput& views) {
  return HasRows(views.timeline) && views.timeline->end_s > views.timeline->begin_s;
}

}  // namespace

std::string NodesPage(const ReportInput& input, const ViewInput& views) {
  if (!HasTime(views) || input.timeline.rows.size() < 2) return {};
  const Table utilisation = UtilisationOfRun(views);
  std::string text;
  if (input.timeline.rows.size() <= kMostDials)
    text += TablePanel(views, {utilisation}, DialsView, "Utilisation, whole run", "dials", "main");
  std::string both =
      TablePanel(views, {utilisation}, KiviatView, "Balance, whole run", "kiviat", "half");
  if (const std::string states =
          StatesTable(input.states, NounFor(input.timeline), HostOf(input.timeline));
      !states.empty())
    both += PanelAround({.heading = "Time in each state", .style = "half", .id = "states"}, states);
  text += PanelRow(both, "halves");
  return text +
         (input.switches.rows.empty()
              ? PanelWithout({.heading = "Context switches", .id = "switches"},
                             "Not recorded: stipple run --switches records when threads left "
                             "their processors.")
              : TablePanel(views, {input.switches}, StripView, "Context switches", "switches",
                           "main"));
}

std::string TimePage(const ReportInput& input, const ViewInput& views) {
  if (!HasTime(views)) return {};
  const std::string_view noun = NounFor(input.timeline);
  std::string text;
  if (input.timeline.rows.size() > 1)
    text += TablePanel(views, {UtilisationByRow(views, 96)}, ContourView,
                       fmt::format("Utilisation by {} and time", noun), "contour", "main");
  return text +
         TablePanel(views, {input.phases}, PhaseBarsView, "Whole run, by phase", "phase-bars",
                    "main") +
         TableSection(input.phases, "Phases", "phases", input.phases_text, input.timeline, "main") +
         PanelRow(EfficiencyPanel(input) + TableSection(input.critical_path, "Critical path",
                                                        "critical-path", input.critical_path_text,
                                                        input.timeline),
                  "halves");
}

}  // namespace stipple
