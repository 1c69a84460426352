// SPDX-License-Identifier: MIT
#include "analysis/report/html_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Inclusive time pale, exclusive time before it; the number is the exclusive share.
std::string ShareCell(double exclusive, double inclusive, double whole, double largest) {
  const auto width = [largest](double value) {
    return largest > 0 ? std::clamp(value / largest, 0.0, 1.0) * 100 : 0;
  };
  return fmt::format(
      "<td class=\"share\"><span><i aria-hidden=\"true\"><b style=\"width:{:.1f}%\"></b><b "
      "style=\"width:{:.1f}%\"></b></i>{}</span></td>",
      width(inclusive), width(exclusive), FormatPercent(whole > 0 ? exclusive / whole : 0));
}

std::string NumberHead(std::string_view name, bool sorted = false) {
  return fmt::format("<th scope=\"col\" class=\"n\" data-sort=\"number\"{}>{}</th>",
                     sorted ? " aria-sort=\"descending\"" : "", name);
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

/// Least, mean and most over the ranks, hosts left out.
struct Spread {
  double least = 0, mean = 0, most = 0;
};
Spread SpreadOf(const FunctionSpread& function, const std::vector<TimelineRow>& rows) {
  Spread spread{std::numeric_limits<double>::max(), 0, 0};
  double count = 0;
  for (std::size_t i = 0; i < std::min(rows.size(), function.seconds.size()); ++i) {
    if (rows[i].is_host) continue;
    spread.least = std::min(spread.least, function.seconds[i]);
    spread.most = std::max(spread.most, function.seconds[i]);
    spread.mean += function.seconds[i];
    ++count;
  }
  if (count == 0) return {};
  spread.mean /= count;
  return spread;
}

constexpr std::size_t kMostSparkBars = 48;
constexpr double kSparkWidth = 96, kSparkHeight = 18;

/// A bar for each rank, the host last; of very many ranks for the mean of neighbours.
std::string Spark(const FunctionSpread& function) {
  const std::size_t ranks = function.seconds.size();
  const std::size_t bars = std::min(ranks, kMostSparkBars);
  std::vector<double> values(bars), counts(bars);
  for (std::size_t i = 0; i < ranks; ++i) {
    values[i * bars / ranks] += function.seconds[i];
    ++counts[i * bars / ranks];
  }
  double largest = 0;
  for (std::size_t i = 0; i < bars; ++i) largest = std::max(largest, values[i] /= counts[i]);
  if (bars == 0 || largest <= 0) return "<td></td>";
  const double pitch = std::floor(std::min(10.0, kSparkWidth / static_cast<double>(bars)));
  std::string path;
  for (std::size_t i = 0; i < bars; ++i) {
    const double height = std::round(values[i] / largest * kSparkHeight);
    if (height > 0)
      path += fmt::format("M{} {}h{}v-{}h-{}z", static_cast<double>(i) * pitch, kSparkHeight,
                          std::max(1.0, pitch - 1), height, std::max(1.0, pitch - 1));
  }
  return fmt::format(
      "<td class=\"spark\"><svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "aria-hidden=\"true\"><path d=\"{2}\"/></svg></td>",
      kSparkWidth, kSparkHeight, path);
}

constexpr double kNoticeable = 1.25;  // most over mean

std::string SpreadCells(const FunctionSpread* function, const std::vector<TimelineRow>& rows) {
  if (rows.size() < 2) return {};
  if (function == nullptr) return "<td></td><td></td><td></td><td></td><td></td>";
  const Spread spread = SpreadOf(*function, rows);
  if (!(spread.mean > 0))
    return "<td></td><td></td><td></td><td data-v=\"\"></td>" + Spark(*function);
  const double ratio = spread.most / spread.mean;
  return TimeCell(spread.least) + TimeCell(spread.mean) + TimeCell(spread.most) +
         fmt::format("<td class=\"n{}\" data-v=\"{:.4g}\">{:.2f}</td>",
                     ratio >= kNoticeable ? " uneven" : "", ratio, ratio) +
         Spark(*function);
}

struct ProfileScale {
  double whole = 0;    // of all exclusive times
  double largest = 0;  // inclusive time
};

std::string ProfileRow(const Table& profile, const Row& row, const ProfileScale& scale) {
  const Cell calls = CellOf(profile, row, "calls");
  const Cell exclusive = CellOf(profile, row, "exclusive_s");
  const Cell inclusive = CellOf(profile, row, "inclusive_s");
  const auto count = static_cast<std::int64_t>(CellNumber(calls));
  return FunctionCell(profile, row) +
         fmt::format("<td class=\"n\" data-v=\"{}\">{}</td>", count, FormatCount(count)) +
         TimeCell(inclusive) +
         DoubtfulCell(exclusive, CellOf(profile, row, "exclusive_low_s"),
                      CellOf(profile, row, "exclusive_high_s")) +
         ShareCell(CellNumber(exclusive), CellNumber(inclusive), scale.whole, scale.largest);
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

std::string ProfileSection(const ReportInput& input) {
  const Table& profile = input.profile;
  const std::vector<TimelineRow>& ranks = input.timeline.rows;
  if (profile.rows.empty()) return {};
  const std::vector<const Row*> rows = SortedBy(profile, "exclusive_s");
  ProfileScale scale;
  for (const Row* row : rows) {
    scale.whole += CellNumber(CellOf(profile, *row, "exclusive_s"));
    scale.largest = std::max(scale.largest, CellNumber(CellOf(profile, *row, "inclusive_s")));
  }
  std::string text = fmt::format(
      "<section class=\"panel profile\" id=\"profile\" aria-labelledby=\"h-profile\"><header "
      "class=\"panel\"><h3 id=\"h-profile\">Functions</h3><span class=\"note\">whole run, summed "
      "over all ranks \u00b7 exclusive: without the functions called</span></header>\n<div "
      "class=\"scroll\"><table class=\"sortable\" id=\"functions-table\"><caption "
      "class=\"unseen\">Time by function</caption><thead><tr><th scope=\"col\" "
      "data-sort=\"text\">function</th><th "
      "scope=\"col\" data-sort=\"text\">file</th>{}{}{}<th scope=\"col\">inclusive, "
      "exclusive</th>",
      NumberHead("calls"), NumberHead("inclusive"), NumberHead("exclusive", true));
  if (ranks.size() > 1)
    text += NumberHead("least") + NumberHead("mean") + NumberHead("most of a rank") +
            NumberHead("most / mean") + "<th scope=\"col\">by rank</th>";
  text += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(rows.size(), kMostFunctions); ++i) {
    const std::string region = CellText(CellOf(profile, *rows[i], "region"));
    const auto spread = std::ranges::find(input.spreads, region, &FunctionSpread::region);
    const auto& series = input.function_series.functions;
    const auto followed = std::ranges::find(series, region, &FunctionSeries::Function::region);
    text += followed == series.end() ? "<tr>"
                                     : fmt::format("<tr data-f=\"{}\">", followed - series.begin());
    text += ProfileRow(profile, *rows[i], scale) +
            SpreadCells(spread == input.spreads.end() ? nullptr : &*spread, ranks) + "</tr>\n";
  }
  text += "</tbody></table></div>\n";
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

std::string SingleWaitsSection(const std::vector<SingleWait>& waits, const Timeline& timeline,
                               std::string_view noun, int host) {
  if (waits.empty()) return {};
  std::string text =
      "<section class=\"panel half\" id=\"single-waits\" "
      "aria-labelledby=\"h-single-waits\"><header "
      "class=\"panel\"><h3 id=\"h-single-waits\">Longest single waits</h3><span "
      "class=\"note\">the time leads to the timeline</span></header>\n<div "
      "class=\"scroll\"><table class=\"sortable\"><caption class=\"unseen\">The calls that waited "
      "longest</caption><thead><tr><th scope=\"col\" data-sort=\"text\">kind</th><th scope=\"col\" "
      "data-sort=\"text\">waiter</th><th scope=\"col\" data-sort=\"text\">last to come</th><th "
      "scope=\"col\" data-sort=\"text\">in</th>" +
      NumberHead("from") + NumberHead("time", true) + "</tr></thead><tbody>\n";
  const double least = (timeline.end_s - timeline.begin_s) / 500;
  for (const SingleWait& w : waits) {
    const double length = std::max(w.end_s - w.begin_s, least);
    text += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td class=\"n\" "
        "data-v=\"{:.9g}\"><a href=\"#timeline\" data-from=\"{:.9g}\" "
        "data-to=\"{:.9g}\">{}</a></td>{}</tr>\n",
        Words(std::string(w.kind)), RankText(std::int64_t{w.waiter}, noun, host),
        RankText(std::int64_t{w.partner}, noun, host),
        EscapeMarkup(ShortenMiddle(ShortName(w.call), 40)), w.begin_s, w.begin_s - length / 2,
        w.end_s + length / 2, FormatSeconds(w.begin_s), TimeCell(w.end_s - w.begin_s));
  }
  return text + "</tbody></table></div></section>\n";
}

std::string WaitsSection(const Table& waits, int culprit, std::string_view noun, int host) {
  if (waits.rows.empty()) return {};
  std::string text =
      "<section class=\"panel waits half\" id=\"waits\" aria-labelledby=\"h-waits\"><header "
      "class=\"panel\"><h3 "
      "id=\"h-waits\">Who waited for "
      "whom</h3>"
      "<span class=\"note\">culprit: where the chain of delays began, and what it was "
      "doing</span></header>\n"
      "<div class=\"scroll\"><table class=\"sortable\"><caption class=\"unseen\">Who waited for "
      "whom</caption><thead><tr><th scope=\"col\" "
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
  text += "</tbody></table></div>\n";
  if (rows.size() > kMostWaits)
    text += fmt::format(
        "<p class=\"more\">and {} more: <code>stipple stats ARCHIVE --table waits</code></p>\n",
        FormatCount(static_cast<std::int64_t>(rows.size() - kMostWaits)));
  return text + "</section>\n";
}

std::string StatesTable(const Table& states, std::string_view noun, int host) {
  if (states.rows.empty() || states.rows.size() > kMostNumbers) return {};
  constexpr std::pair<std::string_view, std::string_view> kColumns[] = {
      {"user_s", "user"}, {"system_s", "system"}, {"message_s", "message"}, {"idle_s", "idle"}};
  std::string text = fmt::format(
      "<div class=\"scroll\"><table id=\"states-table\"><caption class=\"unseen\">Time in each "
      "state</caption><thead><tr><th scope=\"col\">{}</th>",
      noun);
  for (const auto& [name, title] : kColumns)
    text += fmt::format("<th scope=\"col\" class=\"n\">{}</th>", title);
  text += "</tr></thead><tbody>\n";
  for (const Row& row : states.rows) {
    text += "<tr><th scope=\"row\">" + RankText(CellOf(states, row, "rank"), noun, host) + "</th>";
    for (const auto& [name, title] : kColumns) text += TimeCell(CellOf(states, row, name));
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string MatrixDetails(const Table& matrix, bool bytes) {
  if (matrix.rows.empty() || matrix.rows.size() > kMostNumbers || matrix.columns.size() < 2)
    return {};
  std::string text = fmt::format(
      "<details><summary>{0} as numbers</summary><div class=\"scroll\"><table><caption "
      "class=\"unseen\">{0}</caption><thead><tr>"
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
