// SPDX-License-Identifier: MIT
#include "analysis/report/html_pages.h"

#include <fmt/format.h>

#include <vector>

#include "analysis/report/html_panel.h"
#include "analysis/report/html_quality.h"
#include "analysis/report/html_table.h"
#include "analysis/report/matrix_groups.h"
#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/matrix_view.h"
#include "analysis/views/palette.h"
#include "analysis/views/svg_write.h"

namespace stipple {
namespace {

/// Matrices of more ranks stand on one page only.
constexpr std::size_t kMostTwice = 33;

constexpr PageEntry kPages[] = {{"summary", "Summary", SummaryPage},
                                {"nodes", "Nodes", NodesPage},
                                {"communication", "Communication", CommunicationPage},
                                {"functions", "Functions", FunctionsPage},
                                {"time", "Time", TimePage},
                                {"quality", "Quality", QualityPage}};

/// What the words leave open: calls into MPI count as messages unless a partner is waited for.
constexpr std::string_view kStateHints[kStateCount] = {"", "", " (in MPI, not waiting)",
                                                       " (waiting)"};

std::string Legend(bool hints) {
  std::string text = "<ul class=\"legend\">";
  for (std::size_t s = 0; s < kStateCount; ++s)
    text += fmt::format("<li><i class=\"s{}\"></i>{}{}</li>", s, kStateNames[s],
                        hints ? kStateHints[s] : "");
  return text + "</ul>";
}

/// Timeline and bars, row by row side by side; below, curves on the timeline's axis.
std::string Overview(const ReportInput& input, const ViewInput& views) {
  if (!HasRows(views.timeline)) return "<p class=\"without\">No rank has a timeline.</p>\n";
  const std::string noun(NounFor(input.timeline));
  const bool one = input.timeline.rows.size() == 1;
  std::string text =
      PanelRow(PanelText({.heading = one ? "State over time" : "State of each " + noun,
                          .style = "main",
                          .end_note = true,
                          .beside = Legend(!one)},
                         TimelineView(views)) +
                   PanelText({.heading = one ? "Whole run" : "Whole run, by " + noun,
                              .style = "side",
                              .end_note = true},
                             StateBarsView(views)),
               "rows");
  const std::string curves =
      PanelText({.heading = "Processor utilisation"}, UtilisationView(views)) +
      PanelText({.heading = "Message load"}, MessageLoadView(views));
  const std::string waited =
      PanelText({.heading = "Who was waited for", .style = "side"}, WaitedForView(views));
  if (curves.empty() && waited.empty()) return text;
  return text + PanelRow("<div class=\"main\">" + curves + "</div>" + waited);
}

std::string Detail(const ReportInput& input, const ViewInput& views) {
  if (input.detail.message_count == 0) return {};
  return PanelText({.heading = "Detail " + FormatSpan(input.detail.begin_s, input.detail.end_s),
                    .style = "detail"},
                   DetailView(views));
}

Scene Named(Scene scene, std::string_view name) {
  if (!scene.layers.empty()) scene.name = name;
  return scene;
}

std::string MatrixPanel(const GroupedMatrix& matrix, const std::string& heading,
                        std::string_view id, const MatrixWords& words) {
  if (matrix.table.rows.size() < 2) return {};
  return PanelText({.heading = heading, .style = "quarter", .end_note = true, .note = matrix.note},
                   Named(MatrixPanelView(matrix.table, words), id));
}

}  // namespace

std::string TablePanel(const ViewInput& views, const std::vector<Table>& tables, View view,
                       const std::string& heading, std::string_view id, const std::string& style,
                       const std::string& below) {
  ViewInput input = views;
  for (const Table& table : tables) {
    if (table.rows.empty()) return {};
    input.tables.push_back(&table);
  }
  return PanelText({.heading = heading, .style = style, .below = below}, Named(view(input), id));
}

std::span<const PageEntry> Pages() { return kPages; }

ViewInput ViewsOf(const ReportInput& input) {
  return {&input.timeline, &input.detail, &input.states,
          &input.messages, &input.volume, &input.finding};
}

std::string SummaryPage(const ReportInput& input, const ViewInput& views) {
  std::string lower = Detail(input, views);
  if (input.messages.rows.size() <= kMostTwice) {
    lower += PanelText({.heading = "Messages", .style = "matrix", .end_note = true},
                       MessageMatrixView(views));
    lower += PanelText({.heading = "Volume", .style = "matrix", .end_note = true},
                       VolumeMatrixView(views));
  }
  // With several nodes the numbers stand on their page.
  std::string numbers;
  if (input.timeline.rows.size() <= 1)
    numbers = StatesTable(input.states, NounFor(input.timeline), HostOf(input.timeline));
  if (!numbers.empty())
    numbers = "<details><summary>States as numbers</summary>" + numbers + "</details>\n";
  return Overview(input, views) + PanelRow(lower, "lower") + numbers;
}

std::string CommunicationPage(const ReportInput& input, const ViewInput& views) {
  if (input.messages.rows.size() < 2) return {};
  const GroupedMatrix messages = Grouped(input.messages), volume = Grouped(input.volume);
  ViewInput grouped = views;
  grouped.messages = &messages.table;
  grouped.volume = &volume.table;
  std::string panels = PanelText({.heading = "Messages",
                                  .style = "quarter",
                                  .end_note = true,
                                  .below = MatrixDetails(input.messages, false),
                                  .note = messages.note},
                                 Named(MessageMatrixView(grouped), "matrix-count")) +
                       PanelText({.heading = "Volume",
                                  .style = "quarter",
                                  .end_note = true,
                                  .below = MatrixDetails(input.volume, true),
                                  .note = volume.note},
                                 Named(VolumeMatrixView(grouped), "matrix-bytes"));
  if (panels.empty())
    panels = PanelWithout({.heading = "Messages", .id = "messages"},
                          "No messages were sent between ranks.");
  panels += MatrixPanel(GroupedMean(input.mean_size, input.volume, input.messages), "Mean size",
                        "matrix-mean", {.title = "Bytes per message"}) +
            MatrixPanel(Grouped(input.wait_matrix), "Waiting", "matrix-wait",
                        {.title = "Time waited", .rows = "waiter", .columns = "waited for"});
  const std::string_view noun = NounFor(input.timeline);
  const int host = HostOf(input.timeline);
  return PanelRow(panels, "quarters") +
         PanelRow(TablePanel(views, {input.sizes}, HistogramView, "By size", "sizes", "half") +
                      TablePanel(views, {input.types}, HistogramView, "By tag", "types", "half"),
                  "halves") +
         PanelRow(WaitsSection(input.waits, input.finding.culprit, noun, host) +
                      SingleWaitsSection(input.longest_waits, input.timeline, noun, host),
                  "halves");
}

std::string FunctionsPage(const ReportInput& input, const ViewInput& views) {
  const std::string left_out =
      input.callpaths_note.empty()
          ? ""
          : "<p class=\"more\">" + EscapeMarkup(input.callpaths_note) + "</p>\n";
  return ProfileSection(input) + TablePanel(views, {input.callpaths}, FlameView, "Call paths",
                                            "callpaths", "paths", left_out);
}

std::string QualityPage(const ReportInput& input, const ViewInput&) {
  std::string text =
      "<section class=\"panel quality\" aria-labelledby=\"h-health\">"
      "<header class=\"panel\"><h3 id=\"h-health\">Data quality</h3></header>\n";
  if (input.health.empty()) {
    text += "<p>Nothing was lost; the archive is sound.</p>";
  } else {
    text += "<ul>";
    for (const std::string& line : input.health) text += "<li>" + EscapeMarkup(line) + "</li>";
    text += "</ul>";
  }
  return text + "</section>\n" + AccuracySection(input.accuracy);
}

}  // namespace stipple
