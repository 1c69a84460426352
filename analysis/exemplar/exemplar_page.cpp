// SPDX-License-Identifier: MIT
#include "analysis/exemplar/exemplar_page.h"

#include <fmt/format.h>

#include "analysis/exemplar/chart_scene.h"
#include "analysis/report/html_style.h"
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

/// All figures, folded.
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
  for (const std::vector<Cell>& row : table.rows) {
    const bool recommended = CellNumber(CellOf(table, row, "recommended")) > 0;
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += CellMarkup(table.columns[i].name, row[i], recommended);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div></details>\n";
}

std::string ChartSection(const MeasuredChart& chart) {
  const Scene scene = SceneOf(chart);
  constexpr double kOnePanel = 800;
  std::string text = fmt::format(
      "<section class=\"chart{0}\" id=\"{1}\" aria-labelledby=\"h-{1}\"><header "
      "class=\"panel end\"><h2 id=\"h-{1}\">{2}</h2><span class=\"note\">{3}</span></header>\n"
      "<p class=\"lead\">{4}</p>\n",
      scene.width < kOnePanel ? " one" : "", chart.name, EscapeMarkup(chart.title),
      EscapeMarkup(chart.effort), EscapeMarkup(chart.sentence));
  return text + "<figure>" + DrawSvg(scene) + "</figure>\n" + Figures(chart) + "</section>\n";
}

}  // namespace

std::string ExemplarPage(const ExemplarInput& input) {
  const std::string title = EscapeMarkup(input.title);
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  page += title + "</title>\n<style>" + PageStyle(false);
  page += kChartStyle;
  page += "</style></head><body>\n<header><h1>" + title + "</h1>\n<p class=\"facts\">" +
          EscapeMarkup(input.lead) + "</p></header><main>\n";
  for (const MeasuredChart& chart : input.charts) page += ChartSection(chart);
  return page + "</main>\n</body></html>\n";
}

}  // namespace stipple
