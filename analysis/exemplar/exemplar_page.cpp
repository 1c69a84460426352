// SPDX-License-Identifier: MIT
#include "analysis/exemplar/exemplar_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/exemplar/chart_scene.h"
#include "analysis/exemplar/page_frame.h"
#include "analysis/views/svg.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

constexpr std::string_view kChartStyle =
    ".chart{max-width:1480px}.chart h2{font-size:17px}.chart .lead{margin:2px 0 14px}"
    ".chart.one figure{max-width:760px}main>section.chart+section.chart{margin-top:44px}"
    "td.recommended,th.recommended{color:var(--accent);font-weight:600}"
    "@media screen and (max-width:1000px){.chart figure svg{min-width:720px}}\n";

/// "cpu_s" as people write it.
std::string HeadingOf(const std::string& column) {
  if (column == "cpu_s") return "CPU s";
  std::string words = column;
  for (char& letter : words)
    if (letter == '_') letter = ' ';
  return words;
}

std::string CellMarkup(const std::string& column, const Cell& cell, bool recommended) {
  if (std::holds_alternative<std::monostate>(cell)) return "<td class=\"n\">\u2013</td>";
  if (const auto* number = std::get_if<double>(&cell))
    return column == "recommended" ? fmt::format("<td>{}</td>", recommended ? "recommended" : "")
                                   : fmt::format("<td class=\"n\">{:.4g}</td>", *number);
  return fmt::format("<td{}>{}</td>", recommended ? " class=\"recommended\"" : "",
                     EscapeMarkup(CellText(cell)));
}

constexpr std::size_t kMostRows = 200;

/// All figures, or the first of very many, folded.
std::string Figures(const MeasuredChart& chart) {
  const Table& table = chart.table;
  std::string text =
      "<details><summary>All figures</summary><div class=\"scroll\"><table><thead><tr>";
  for (const Column& column : table.columns) {
    const bool words = column.name == "panel" || column.name == "series" ||
                       column.name == "label" || column.name == "recommended";
    text += fmt::format("<th scope=\"col\"{}>{}</th>", words ? "" : " class=\"n\"",
                        EscapeMarkup(HeadingOf(column.name)));
  }
  text += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < std::min(kMostRows, table.rows.size()); ++r) {
    const std::vector<Cell>& row = table.rows[r];
    const bool recommended = CellNumber(CellOf(table, row, "recommended")) > 0;
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += CellMarkup(table.columns[i].name, row[i], recommended);
    text += "</tr>\n";
  }
  text += "</tbody></table></div>";
  if (table.rows.size() > kMostRows)
    text += fmt::format("<p class=\"more\">and {} more: <code>{}.csv</code></p>",
                        table.rows.size() - kMostRows, EscapeMarkup(chart.name));
  return text + "</details>\n";
}

std::string ChartSection(const MeasuredChart& chart) {
  const Scene scene = SceneOf(chart);
  constexpr double kOnePanel = 800;
  const std::string note =
      (chart.kind == "map" ? "in the cells: " + chart.value.title + " \u00b7 " : "") + chart.effort;
  std::string text = fmt::format(
      "<section class=\"chart{0}\" id=\"{1}\" aria-labelledby=\"h-{1}\"><header "
      "class=\"panel end\"><h2 id=\"h-{1}\">{2}</h2><span class=\"note\">{3}</span></header>\n"
      "<p class=\"lead\">{4}</p>\n",
      scene.width < kOnePanel ? " one" : "", chart.name, EscapeMarkup(chart.title),
      EscapeMarkup(note), EscapeMarkup(chart.sentence));
  return text + "<figure>" + DrawSvg(scene) + "</figure>\n" + Figures(chart) + "</section>\n";
}

}  // namespace

std::string ExemplarPage(const ExemplarInput& input) {
  std::string sections;
  for (const MeasuredChart& chart : input.charts) sections += ChartSection(chart);
  return PageOf(input.title, input.lead, kChartStyle, sections);
}

}  // namespace stipple
