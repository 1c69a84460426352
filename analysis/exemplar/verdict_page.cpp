// SPDX-License-Identifier: MIT
#include "analysis/exemplar/verdict_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/exemplar/figure_scene.h"
#include "analysis/exemplar/page_frame.h"
#include "analysis/views/svg.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

constexpr std::string_view kVerdictStyle =
    "table.parts+section.experiment{margin-top:34px}main>section.experiment+section.experiment{"
    "margin-top:56px;border-top:1px solid var(--hair);"
    "padding-top:18px}.experiment h2{font-size:20px}.experiment h3{margin-top:26px}"
    ".experiment p{max-width:74em}.claim{margin:6px 0 2px;font-size:15px}.answer{margin:10px 0 4px;"
    "font-size:15px}.experiment h2 "
    ".note{font-weight:400;font-size:14px}.verdict{font-weight:650;white-space:nowrap}.refuted,."
    "unstable{color:var(--"
    "accent)}"
    "table.parts{margin-top:10px;width:auto}table.parts td,table.parts th{padding-right:26px}"
    "table.parts td:first-child{max-width:34em}figure.chart{max-width:1340px;margin-top:8px}"
    ".legend{margin-top:2px}@media screen and (max-width:1000px){figure.chart "
    "svg{min-width:900px}}\n";

std::string ClassOf(Verdict verdict) {
  return verdict == Verdict::kRefuted    ? " refuted"
         : verdict == Verdict::kUnstable ? " unstable"
                                         : "";
}

std::string VerdictMarkup(const std::optional<Verdict>& verdict) {
  if (!verdict) return "<span class=\"note\">does not arise</span>";
  return fmt::format("<span class=\"verdict{}\">{}</span>", ClassOf(*verdict), NameOf(*verdict));
}

/// Index of the cluster of today; none if it was not compared.
std::optional<std::size_t> ComparedIn(const PaperResult& result) {
  for (std::size_t i = 0; i < result.settings.size(); ++i)
    if (result.settings[i].variation.compared) return i;
  return std::nullopt;
}

std::string NumberText(double value) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::abs(value);
  return size >= 100                 ? fmt::format("{:.0f}", value)
         : size >= 0.01 || size == 0 ? fmt::format("{:.3g}", value)
                                     : fmt::format("{:.2g}", value);
}

/// "1.02, 1.31 ≥ 1; 0.4 < 0.5": neighbours with one limit share it.
std::string ChecksMarkup(const ClaimPart& part) {
  std::string text;
  for (std::size_t i = 0; i < part.checks.size(); ++i) {
    const Check& c = part.checks[i];
    text += c.Holds() ? NumberText(c.value) : "<b>" + NumberText(c.value) + "</b>";
    const bool last = i + 1 == part.checks.size();
    const bool shared =
        !last && part.checks[i + 1].limit == c.limit && part.checks[i + 1].relation == c.relation;
    text += shared ? ", "
                   : fmt::format(" <span class=\"note\">{} {}</span>{}", SignOf(c.relation),
                                 NumberText(c.limit), last ? "" : "; ");
  }
  return text;
}

std::string TurnsOf(const PaperResult& result, std::size_t part) {
  std::string text;
  for (const Turn& t : result.judgement.turns)
    if (t.part == part)
      text += fmt::format("{}{}: {} at {}, {} at {}", text.empty() ? "" : "<br>",
                          EscapeMarkup(t.parameter), NameOf(t.before), EscapeMarkup(t.from),
                          NameOf(t.after), EscapeMarkup(t.to));
  return text.empty() ? "nowhere" : text;
}

/// At which settings a part that says nothing at the reference has a verdict.
std::string ElsewhereOf(const PaperResult& result, std::size_t part) {
  std::string text;
  for (std::size_t i = 1; i < result.parts.size(); ++i) {
    const Variation& v = result.parts[i].variation;
    const std::optional<Verdict> verdict = VerdictOf(result.parts[i].parts[part]);
    if (verdict && !v.compared)
      text += fmt::format("<br>{} at {} {}", NameOf(*verdict), EscapeMarkup(v.parameter),
                          EscapeMarkup(v.value));
  }
  return text;
}

std::string PartsTable(const PaperResult& result) {
  const std::optional<std::size_t> compared = ComparedIn(result);
  std::string text =
      "<table class=\"parts\"><thead><tr><th>the claim says</th><th>numbers, and what they have to "
      "be (bold: fails)</th>"
      "<th>" +
      result.machine + "</th><th>turns</th>";
  if (compared) text += "<th>" + result.settings[*compared].setting.machine + "</th>";
  text += "</tr></thead><tbody>\n";
  const std::vector<ClaimPart>& parts = result.parts.front().parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::optional<Verdict>& at_reference = result.judgement.as_measured[p];
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}{}</td><td>{}</td>",
                        EscapeMarkup(parts[p].text), ChecksMarkup(parts[p]),
                        VerdictMarkup(at_reference), at_reference ? "" : ElsewhereOf(result, p),
                        TurnsOf(result, p));
    if (compared)
      text +=
          fmt::format("<td>{}</td>", VerdictMarkup(VerdictOf(result.parts[*compared].parts[p])));
    text += "</tr>\n";
  }
  return "<div class=\"scroll\">" + text + "</tbody></table></div>\n";
}

std::string CheckRows(const PaperResult& result) {
  std::string rows;
  for (const PartsAt& at : result.parts)
    for (const ClaimPart& part : at.parts)
      for (const Check& c : part.checks)
        rows += fmt::format(
            "<tr><td>{} {}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{} {}</td>"
            "<td>{}</td></tr>\n",
            EscapeMarkup(at.variation.parameter.empty() ? "reference" : at.variation.parameter),
            EscapeMarkup(at.variation.value), EscapeMarkup(c.what), NumberText(c.value),
            SignOf(c.relation), NumberText(c.limit), c.Holds() ? "holds" : "<b>fails</b>");
  return "<details><summary>All checks at all settings</summary><div class=\"scroll\"><table>"
         "<thead><tr><th>setting</th><th>check</th><th class=\"n\">number</th><th "
         "class=\"n\">has to be</th><th></th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div></details>\n";
}

std::string CellMarkup(const Cell& cell) {
  if (std::holds_alternative<std::monostate>(cell)) return "<td class=\"n\">\u2013</td>";
  if (const auto* number = std::get_if<double>(&cell))
    return "<td class=\"n\">" + NumberText(*number) + "</td>";
  return "<td>" + EscapeMarkup(CellText(cell)) + "</td>";
}

/// "waits_for_host_node_s" as people write it.
std::string HeadingOf(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string CausesTable(const Table& table) {
  std::string text =
      "<details><summary>What the cause was read from: states and waits of each run</summary>"
      "<div class=\"scroll\"><table><thead><tr>";
  for (const Column& column : table.columns)
    text += "<th>" + EscapeMarkup(HeadingOf(column.name)) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    text += "<tr>";
    for (const Cell& cell : row) text += CellMarkup(cell);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div></details>\n";
}

std::string Commands(const PaperResult& result) {
  std::string text = "<details><summary>Commands of the reference</summary>\n";
  for (const Case& c : result.experiment->cases(result.settings.front().setting, result.quick))
    text += "<div><code>" + EscapeMarkup(CommandLineOf(c.run)) + "</code></div>\n";
  return text + "</details>\n";
}

std::string FigureMarkup(const Figure& figure) {
  std::string text = fmt::format(
      "<header class=\"panel end\"><h3>{}</h3><span class=\"note\">{}</span></header>\n",
      EscapeMarkup(figure.title), EscapeMarkup(figure.note));
  const Scene scene = SceneOf(figure);
  if (!scene.key.empty()) {
    text += "<ul class=\"legend\">";
    for (std::size_t s = 0; s < scene.key.size(); ++s)
      text += fmt::format("<li><i class=\"s{}\"></i>{}</li>", s, EscapeMarkup(scene.key[s].label));
    text += "</ul>\n";
  }
  return text + "<figure class=\"chart\">" + DrawSvg(scene) + "</figure>\n";
}

/// What an unstable claim is where nothing is varied.
std::string AtReference(const Judgement& j) {
  if (j.turns.empty() || !j.reference) return {};
  return fmt::format(" <span class=\"note\">{} at the reference</span>", NameOf(*j.reference));
}

std::string Section(const PaperResult& result) {
  const PaperExperiment& e = *result.experiment;
  const Judgement& j = result.judgement;
  std::string text = fmt::format(
      "<section class=\"experiment\" id=\"{0}\"><header class=\"panel\"><h2>{0} \u00b7 {1}: "
      "{2}</h2>"
      "</header>\n",
      e.name, EscapeMarkup(e.title), VerdictMarkup(j.verdict) + AtReference(j));
  text += fmt::format("<p class=\"claim\"><b>Claim.</b> {}</p>\n<p class=\"facts\">{}{}</p>\n",
                      EscapeMarkup(e.claim), EscapeMarkup(e.method),
                      result.quick ? " \u00b7 <b>quick look: smaller than that</b>" : "");
  text += fmt::format(
      "<p class=\"answer\"><b>Found.</b> {}</p>\n<p class=\"answer\"><b>Cause.</b> "
      "{}</p>\n",
      EscapeMarkup(result.account.sentence), EscapeMarkup(result.account.cause));
  text += PartsTable(result);
  for (const Figure& figure : result.account.figures) text += FigureMarkup(figure);
  return text + CheckRows(result) + CausesTable(result.account.causes) + Commands(result) +
         "</section>\n";
}

std::string Overview(const VerdictInput& input) {
  std::string text =
      "<table class=\"parts\"><thead><tr><th></th><th>what is compared</th><th>verdict</th>"
      "<th>at the reference</th></tr></thead><tbody>\n";
  for (const PaperResult& r : input.results)
    text += fmt::format(
        "<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td><td>{2}</td><td>{3}</td></tr>\n",
        r.experiment->name, EscapeMarkup(r.experiment->title), VerdictMarkup(r.judgement.verdict),
        VerdictMarkup(r.judgement.reference));
  return text + "</tbody></table>\n";
}

}  // namespace

std::string VerdictPage(const VerdictInput& input) {
  std::string sections;
  if (input.results.size() > 1) sections += Overview(input);
  for (const PaperResult& result : input.results) sections += Section(result);
  return PageOf(input.title, input.lead, kVerdictStyle, sections);
}

}  // namespace stipple
