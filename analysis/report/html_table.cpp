// SPDX-License-Identifier: MIT
#include "analysis/report/html_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostFunctions = 30;
constexpr std::size_t kMostWaits = 10;
constexpr std::size_t kMostNumbers = 33;  // rows of a folded table
constexpr std::size_t kNameCharacters = 88;
constexpr std::size_t kMostTitle = 600;  // some instances have names of many kilobytes

using Row = std::vector<Cell>;

/// Rows of `table`, most of `column` first; equal ones keep their order.
std::vector<const Row*> SortedBy(const Table& table, std::string_view column) {
  std::vector<const Row*> rows;
  for (const Row& row : table.rows) rows.push_back(&row);
  std::ranges::stable_sort(rows, [&](const Row* a, const Row* b) {
    return CellNumber(CellOf(table, *a, column)) > CellNumber(CellOf(table, *b, column));
  });
  return rows;
}

std::string TimeCell(const Cell& cell) {
  if (std::holds_alternative<std::monostate>(cell))
    return "<td class=\"n\" data-v=\"-1\">\u2013</td>";
  const double seconds = CellNumber(cell);
  return fmt::format("<td class=\"n\" data-v=\"{:.9g}\">{}</td>", seconds, FormatSeconds(seconds));
}

/// A time with what it may be wrong by, where that is more than a hundredth of it.
std::string DoubtfulCell(const Cell& cell, const Cell& low, const Cell& high) {
  const double seconds = CellNumber(cell);
  const double doubt = std::max(CellNumber(high) - seconds, seconds - CellNumber(low));
  if (std::holds_alternative<std::monostate>(high) || !(doubt > 0.01 * seconds))
    return TimeCell(cell);
  return fmt::format("<td class=\"n\" data-v=\"{:.9g}\">{} \u00b1{}</td>", seconds,
                     FormatSeconds(seconds), FormatSeconds(doubt));
}

std::string ShareCell(double value, double whole, double largest) {
  const double share = whole > 0 ? value / whole : 0;
  return fmt::format(
      "<td class=\"share\"><span><i style=\"width:{:.1f}%\" "
      "aria-hidden=\"true\"></i>{}</span></td>",
      largest > 0 ? value / largest * 78 : 0, FormatPercent(share));
}

std::string FileName(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == path.npos ? path : path.substr(slash + 1);
}

/// File and line, the folder in the tooltip.
std::string PlaceCell(const Table& profile, const Row& row) {
  const std::string file = CellText(CellOf(profile, row, "file"));
  const std::string line = CellText(CellOf(profile, row, "line"));
  if (file.empty()) return "<td class=\"where\" data-v=\"\"></td>";
  const std::string place = FileName(file) + (line.empty() || line == "0" ? "" : ":" + line);
  return fmt::format("<td class=\"where\" data-v=\"{0}\" title=\"{1}\">{0}</td>",
                     EscapeMarkup(place), EscapeMarkup(file));
}

std::string FunctionCell(const Table& profile, const Row& row) {
  const std::string region = CellText(CellOf(profile, row, "region"));
  const std::string shown = ShortenMiddle(ShortName(region), kNameCharacters);
  std::string cell =
      fmt::format("<th scope=\"row\" data-v=\"{}\"><span class=\"name\"", EscapeMarkup(shown));
  if (shown != CleanUtf8(region))
    cell += fmt::format(" title=\"{}\"", EscapeMarkup(ShortenMiddle(region, kMostTitle)));
  cell += fmt::format(">{}</span>", EscapeMarkup(shown));
  return cell + "</th>" + PlaceCell(profile, row);
}

std::string ProfileRow(const Table& profile, const Row& row, double whole, double largest) {
  const Cell calls = CellOf(profile, row, "calls");
  const Cell exclusive = CellOf(profile, row, "exclusive_s");
  const auto count = static_cast<std::int64_t>(CellNumber(calls));
  return "<tr>" + FunctionCell(profile, row) +
         fmt::format("<td class=\"n\" data-v=\"{}\">{}</td>", count, FormatCount(count)) +
         TimeCell(CellOf(profile, row, "inclusive_s")) +
         DoubtfulCell(exclusive, CellOf(profile, row, "exclusive_low_s"),
                      CellOf(profile, row, "exclusive_high_s")) +
         ShareCell(CellNumber(exclusive), whole, largest) + "</tr>\n";
}

/// "late-sender" -> "late sender"
std::string Words(std::string text) {
  std::ranges::replace(text, '-', ' ');
  return text;
}

std::string RankText(const Cell& cell, std::string_view noun, int host = -1) {
  const std::string text = CellText(cell);
  if (text.empty() || text[0] == '-') return "\u2013";
  if (text == std::to_string(host)) return "host";
  const bool number = text.find_first_not_of("0123456789") == text.npos;
  return number ? fmt::format("{} {}", noun, text) : EscapeMarkup(text);
}

}  // namespace

std::string ProfileSection(const Table& profile) {
  if (profile.rows.empty()) return {};
  const std::vector<const Row*> rows = SortedBy(profile, "exclusive_s");
  double whole = 0;
  for (const Row* row : rows) whole += CellNumber(CellOf(profile, *row, "exclusive_s"));
  const double largest = CellNumber(CellOf(profile, *rows.front(), "exclusive_s"));
  std::string text =
      "<section class=\"profile\" aria-labelledby=\"h-profile\"><header class=\"panel\">"
      "<h2 id=\"h-profile\">Functions</h2><span class=\"note\">summed over all ranks \u00b7 "
      "exclusive: "
      "without the functions called</span></header>\n<table class=\"sortable\"><thead><tr>"
      "<th scope=\"col\" data-sort=\"text\">function</th><th scope=\"col\" "
      "data-sort=\"text\">file</th><th scope=\"col\" class=\"n\" "
      "data-sort=\"number\">calls</th>"
      "<th scope=\"col\" class=\"n\" data-sort=\"number\">inclusive</th>"
      "<th scope=\"col\" class=\"n\" data-sort=\"number\" aria-sort=\"descending\">exclusive</th>"
      "<th scope=\"col\">share of exclusive time</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(rows.size(), kMostFunctions); ++i)
    text += ProfileRow(profile, *rows[i], whole, largest);
  text += "</tbody></table>\n";
  if (rows.size() > kMostFunctions) {
    double rest = 0;
    for (std::size_t i = kMostFunctions; i < rows.size(); ++i)
      rest += CellNumber(CellOf(profile, *rows[i], "exclusive_s"));
    text += fmt::format(
        "<p class=\"more\">and {} more, {} together: <code>stipple stats ARCHIVE --table "
        "profile</code></p>\n",
        FormatCount(static_cast<std::int64_t>(rows.size() - kMostFunctions)), FormatSeconds(rest));
  }
  return text + "</section>\n";
}

std::string WaitsSection(const Table& waits, int culprit, std::string_view noun, int host) {
  if (waits.rows.empty()) return {};
  std::string text =
      "<section class=\"waits\" aria-labelledby=\"h-waits\"><header class=\"panel\"><h2 "
      "id=\"h-waits\">Longest "
      "waits</h2>"
      "<span class=\"note\">culprit: where the chain of delays began, and what it was "
      "doing</span></header>\n"
      "<table class=\"sortable\"><thead><tr><th scope=\"col\" "
      "data-sort=\"text\">kind</th><th scope=\"col\" data-sort=\"text\">waiter</th>"
      "<th scope=\"col\" data-sort=\"text\">culprit</th>"
      "<th scope=\"col\" data-sort=\"text\">culprit was in</th>"
      "<th scope=\"col\" class=\"n\" data-sort=\"number\" "
      "aria-sort=\"descending\">time</th></tr></thead><tbody>\n";
  const std::vector<const Row*> rows = SortedBy(waits, "seconds");
  for (std::size_t i = 0; i < std::min(rows.size(), kMostWaits); ++i) {
    const Row& row = *rows[i];
    const Cell blamed = CellOf(waits, row, "culprit");
    const std::string region = CellText(CellOf(waits, row, "region"));
    const bool accent = culprit >= 0 && CellText(blamed) == std::to_string(culprit);
    text += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td{}>{}</td><td title=\"{}\">{}</td>{}</tr>\n",
        EscapeMarkup(Words(CellText(CellOf(waits, row, "kind")))),
        RankText(CellOf(waits, row, "waiter"), noun, host), accent ? " class=\"culprit\"" : "",
        RankText(blamed, noun, host), EscapeMarkup(ShortenMiddle(region, kMostTitle)),
        EscapeMarkup(ShortenMiddle(ShortName(region), 48)),
        TimeCell(CellOf(waits, row, "seconds")));
  }
  text += "</tbody></table>\n";
  if (rows.size() > kMostWaits)
    text += fmt::format(
        "<p class=\"more\">and {} more: <code>stipple stats ARCHIVE --table waits</code></p>\n",
        FormatCount(static_cast<std::int64_t>(rows.size() - kMostWaits)));
  return text + "</section>\n";
}

std::string StatesDetails(const Table& states, std::string_view noun, int host) {
  if (states.rows.empty() || states.rows.size() > kMostNumbers) return {};
  constexpr std::pair<std::string_view, std::string_view> kColumns[] = {
      {"user_s", "user"}, {"system_s", "system"}, {"message_s", "message"}, {"idle_s", "idle"}};
  std::string text = fmt::format(
      "<details><summary>States as numbers</summary><div class=\"scroll\"><table><thead><tr><th "
      "scope=\"col\">{}</th>",
      noun);
  for (const auto& [name, title] : kColumns)
    text += fmt::format("<th scope=\"col\" class=\"n\">{}</th>", title);
  text += "</tr></thead><tbody>\n";
  for (const Row& row : states.rows) {
    text += "<tr><th scope=\"row\">" + RankText(CellOf(states, row, "rank"), noun, host) + "</th>";
    for (const auto& [name, title] : kColumns) text += TimeCell(CellOf(states, row, name));
    text += "</tr>\n";
  }
  return text + "</tbody></table></div></details>\n";
}

std::string MatrixDetails(const Table& matrix, bool bytes) {
  if (matrix.rows.empty() || matrix.rows.size() > kMostNumbers || matrix.columns.size() < 2)
    return {};
  std::string text = fmt::format(
      "<details><summary>{} as numbers</summary><div class=\"scroll\"><table><thead><tr>"
      "<th scope=\"col\">sender \\ receiver</th>",
      bytes ? "Volume" : "Messages");
  for (std::size_t i = 1; i < matrix.columns.size(); ++i)
    text +=
        fmt::format("<th scope=\"col\" class=\"n\">{}</th>", EscapeMarkup(matrix.columns[i].name));
  text += "</tr></thead><tbody>\n";
  for (const Row& row : matrix.rows) {
    text += fmt::format("<tr><th scope=\"row\">{}</th>", EscapeMarkup(CellText(row[0])));
    for (std::size_t i = 1; i < row.size(); ++i) {
      const double value = CellNumber(row[i]);
      text += fmt::format("<td class=\"n\">{}</td>",
                          bytes ? FormatBytes(value) : FormatCount(std::llround(value)));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div></details>\n";
}

}  // namespace stipple
