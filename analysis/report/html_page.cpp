// SPDX-License-Identifier: MIT
// The page from top to bottom: what was found, the run in facts, what everyone did and when, who
// was waited for, the worst period, who talked to whom, where the time went in the program.
#include <fmt/format.h>

#include <utility>

#include "analysis/report/html.h"
#include "analysis/report/html_quality.h"
#include "analysis/report/html_style.h"
#include "analysis/report/html_table.h"
#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/svg.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

ViewInput ViewsOf(const ReportInput& input) {
  return {&input.timeline, &input.detail, &input.states,
          &input.messages, &input.volume, &input.finding};
}

/// A view with its heading; empty where the view has nothing to show.
struct Panel {
  std::string heading;
  std::string style;  // class of the section
  bool note_at_end = false;
  std::string beside;  // between heading and note
  std::string below;   // under the picture
};

std::string PanelText(const Panel& panel, const Scene& scene) {
  if (scene.layers.empty()) return {};
  std::string text = fmt::format(
      "<section class=\"{0}\" aria-labelledby=\"h-{1}\"><header class=\"panel{2}\"><h2 "
      "id=\"h-{1}\">{3}</h2>{4}",
      panel.style, scene.name, panel.note_at_end ? " end" : "", EscapeMarkup(panel.heading),
      panel.beside);
  if (!scene.note.empty())
    text += fmt::format("<span class=\"note\">{}</span>", EscapeMarkup(scene.note));
  return text + "</header>\n<figure>" + DrawSvg(scene) + "</figure>" + panel.below + "</section>\n";
}

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

std::string Headline(const ReportInput& input) {
  return input.finding.sentence.empty() ? input.title : input.finding.sentence;
}

/// Facts in one line; what was lost stands out.
std::string FactsLine(const ReportInput& input) {
  std::string text = "<p class=\"facts\">";
  // Without a finding the title is the headline already.
  if (!input.finding.sentence.empty()) text += EscapeMarkup(input.title) + " \u00b7 ";
  for (const std::string& fact : input.facts)
    text += (&fact == &input.facts.front() ? "" : " \u00b7 ") + EscapeMarkup(fact);
  if (!input.health.empty()) text += " \u00b7 <b>" + EscapeMarkup(input.health.front()) + "</b>";
  if (input.health.size() > 1)
    text += fmt::format(" <a href=\"#quality\">and {} more</a>", input.health.size() - 1);
  return text + "</p>\n";
}

std::string Header(const ReportInput& input) {
  std::string text = "<header><h1>" + EscapeMarkup(Headline(input)) + "</h1>\n";
  if (!input.finding.detail.empty())
    text += "<p class=\"lead\">" + EscapeMarkup(input.finding.detail) + "</p>\n";
  return text + FactsLine(input) + "</header>\n";
}

/// World rank of the host; -1: none.
int HostOf(const Timeline& timeline) {
  for (const TimelineRow& row : timeline.rows)
    if (row.is_host) return row.rank;
  return -1;
}

/// Timeline and bars, row by row side by side; below, curves on the timeline's axis.
std::string Overview(const ReportInput& input, const ViewInput& views) {
  if (!HasRows(views.timeline)) return {};
  const std::string noun(NounFor(input.timeline));
  std::string text = "<div class=\"line rows\">";
  const bool one = input.timeline.rows.size() == 1;
  text +=
      PanelText({one ? "State over time" : "State of each " + noun, "main", true, Legend(!one), {}},
                TimelineView(views));
  text += PanelText({one ? "Whole run" : "Whole run, by " + noun, "side", true, {}, {}},
                    StateBarsView(views));
  text += "</div>\n";
  const std::string curves =
      PanelText({"Processor utilisation", "", false, {}, {}}, UtilisationView(views)) +
      PanelText({"Message load", "", false, {}, {}}, MessageLoadView(views));
  const std::string waited =
      PanelText({"Who was waited for", "side", true, {}, {}}, WaitedForView(views));
  if (curves.empty() && waited.empty())
    return text + StatesDetails(input.states, noun, HostOf(input.timeline));
  return text + "<div class=\"line\"><div class=\"main\">" + curves +
         StatesDetails(input.states, noun, HostOf(input.timeline)) + "</div>" + waited + "</div>\n";
}

std::string Communication(const ReportInput& input, const ViewInput& views) {
  std::string panels;
  if (input.detail.message_count > 0)
    panels += PanelText(
        {"Detail " + FormatSpan(input.detail.begin_s, input.detail.end_s), "detail", false, {}, {}},
        DetailView(views));
  panels += PanelText({"Messages", "matrix", true, {}, MatrixDetails(input.messages, false)},
                      MessageMatrixView(views));
  panels += PanelText({"Volume", "matrix", true, {}, MatrixDetails(input.volume, true)},
                      VolumeMatrixView(views));
  return panels.empty() ? "" : "<div class=\"line lower\">" + panels + "</div>\n";
}

std::string Quality(const ReportInput& input) {
  std::string text = "<footer class=\"quality\" id=\"quality\">";
  if (input.health.empty())
    return text + "Data quality: nothing was lost; the archive is sound.</footer>\n";
  text += "<strong class=\"problems\">Data quality</strong><ul>";
  for (const std::string& line : input.health) text += "<li>" + EscapeMarkup(line) + "</li>";
  return text + "</ul></footer>\n";
}

}  // namespace

std::string ReportPage(const ReportInput& input) {
  const ViewInput views = ViewsOf(input);
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  page += EscapeMarkup(Headline(input)) + "</title>\n<style>" + PageStyle(input.mono) +
          "</style></head><body>\n";
  if (input.mono) page += MonoPatterns();
  page += Header(input) + "<main>\n" + Overview(input, views) + Communication(input, views);
  const std::string waits = WaitsSection(input.waits, input.finding.culprit,
                                         NounFor(input.timeline), HostOf(input.timeline));
  page += ProfileSection(input.profile) + waits + AccuracySection(input.accuracy) + "</main>\n" +
          Quality(input);
  page +=
      "<script type=\"application/json\" id=\"hover\">" + HoverData(views) + "</script>\n<script>";
  page += PageScript();
  return page + "</script>\n</body></html>\n";
}

}  // namespace stipple
