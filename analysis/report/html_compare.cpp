// SPDX-License-Identifier: MIT
// Both timelines on one scale, one above the other, with bars; new time by state; what changed by
// function and by pair of ranks; matrices of both.
#include "analysis/report/html_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/html_panel.h"
#include "analysis/report/html_style.h"
#include "analysis/report/matrix_groups.h"
#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/table_access.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostFunctions = 40;
constexpr std::size_t kMostPairs = 20;

/// "+1.20 s", "−0.30 s"; nothing for no change.
std::string SignedSeconds(double seconds) {
  if (std::abs(seconds) < 5e-10) return "0";
  return (seconds > 0 ? "+" : "\u2212") + FormatSeconds(std::abs(seconds));
}
std::string SignedCount(std::int64_t count) {
  if (count == 0) return "0";
  return (count > 0 ? "+" : "\u2212") + FormatCount(std::abs(count));
}
std::string SignedBytes(double bytes) {
  if (bytes == 0) return "0";
  return (bytes > 0 ? "+" : "\u2212") + FormatBytes(std::abs(bytes));
}

std::string NumberCell(double value, const std::string& text) {
  return fmt::format("<td class=\"n\" data-v=\"{:.9g}\">{}</td>", value, text);
}
std::string SecondsCell(double seconds) { return NumberCell(seconds, FormatSeconds(seconds)); }

/// A bar from the middle: to the left for less, to the right for more.
std::string ChangeBar(double change, double largest) {
  const double half = largest > 0 ? std::abs(change) / largest * 50 : 0;
  return fmt::format(
      "<td class=\"change\"><span aria-hidden=\"true\"><i class=\"{}\" "
      "style=\"left:{:.1f}%;width:{:.1f}%\"></i></span></td>",
      change < 0 ? "less" : "more", change < 0 ? 50 - half : 50, half);
}

struct Head {
  std::string name;
  std::string_view sort;  // "text", "number" or none
};
std::string TableBegin(const std::string& caption, const std::vector<Head>& heads) {
  std::string text = fmt::format(
      "<div class=\"scroll\"><table class=\"sortable\"><caption class=\"unseen\">{}</caption>"
      "<thead><tr>",
      EscapeMarkup(caption));
  for (const Head& head : heads)
    text +=
        fmt::format("<th scope=\"col\"{}{}>{}</th>", head.sort == "number" ? " class=\"n\"" : "",
                    head.sort.empty() ? "" : fmt::format(" data-sort=\"{}\"", head.sort),
                    EscapeMarkup(head.name));
  return text + "</tr></thead><tbody>\n";
}
constexpr std::string_view kTableEnd = "</tbody></table></div>\n";

/// Timeline and bars of one run; elements of both must have names of their own.
std::string RunRow(const ComparedRun& run, std::string_view suffix, bool legend) {
  ViewInput views;
  views.timeline = &run.timeline;
  Scene timeline = TimelineView(views), bars = StateBarsView(views);
  if (timeline.layers.empty())
    return fmt::format("<p class=\"without\">{} has no rank with a timeline.</p>\n",
                       EscapeMarkup(run.name));
  timeline.name += suffix;
  bars.name += suffix;
  std::string key;
  if (legend) {
    key = "<ul class=\"legend\">";
    for (std::size_t s = 0; s < kStateCount; ++s)
      key += fmt::format("<li><i class=\"s{}\"></i>{}</li>", s, kStateNames[s]);
    key += "</ul>";
  }
  return PanelRow(PanelText({.heading = fmt::format("{}: {}", run.name, FormatSeconds(run.span_s)),
                             .style = "main",
                             .end_note = true,
                             .beside = key},
                            timeline) +
                      PanelText({.heading = fmt::format("By {}", NounFor(run.timeline)),
                                 .style = "side",
                                 .end_note = true,
                                 .note = "computing, of the longer run"},
                                bars),
                  "rows");
}

std::string StatesPanel(const CompareInput& input) {
  std::string text = TableBegin("Time of a rank on average, by state", {{"state", ""},
                                                                        {input.a.name, "number"},
                                                                        {input.b.name, "number"},
                                                                        {"change", "number"},
                                                                        {"less | more", ""}});
  double largest = 0;
  for (std::size_t s = 0; s < kStateCount; ++s)
    largest = std::max(largest, std::abs(input.b.state_s[s] - input.a.state_s[s]));
  for (std::size_t s = 0; s < kStateCount; ++s) {
    const double change = input.b.state_s[s] - input.a.state_s[s];
    const auto cell = [&](const ComparedRun& run) {
      return s == 1 && !run.has_system ? "<td class=\"n\" data-v=\"-1\">\u2013</td>"
                                       : SecondsCell(run.state_s[s]);
    };
    const bool known = s != 1 || (input.a.has_system && input.b.has_system);
    text +=
        fmt::format("<tr><th scope=\"row\"><i class=\"key s{}\"></i>{}</th>", s, kStateNames[s]) +
        cell(input.a) + cell(input.b) +
        (known ? NumberCell(change, SignedSeconds(change)) + ChangeBar(change, largest)
               : "<td class=\"n\" data-v=\"\">\u2013</td><td></td>") +
        "</tr>\n";
  }
  text += kTableEnd;
  return PanelAround(
      {.heading = "Time by state", .style = "half", .id = "states", .note = "of a rank on average"},
      text);
}

std::string WaitsPanel(const CompareInput& input) {
  std::map<std::string, std::pair<double, double>> waits;
  for (const auto& [who, seconds] : input.a.waited_s) waits[who].first = seconds;
  for (const auto& [who, seconds] : input.b.waited_s) waits[who].second = seconds;
  if (waits.empty()) return {};
  std::vector<std::pair<std::string, std::pair<double, double>>> sorted(waits.begin(), waits.end());
  const auto change = [](const auto& one) { return one.second.second - one.second.first; };
  std::ranges::stable_sort(sorted, std::greater<>(),
                           [&](const auto& one) { return std::abs(change(one)); });
  sorted.resize(std::min<std::size_t>(sorted.size(), 6));
  std::string text =
      TableBegin("Waiting, by the rank that was waited for", {{"waiting for", "text"},
                                                              {input.a.name, "number"},
                                                              {input.b.name, "number"},
                                                              {"change", "number"},
                                                              {"less | more", ""}});
  for (const auto& one : sorted)
    text += fmt::format("<tr><th scope=\"row\">{}</th>", EscapeMarkup(one.first)) +
            SecondsCell(one.second.first) + SecondsCell(one.second.second) +
            NumberCell(change(one), SignedSeconds(change(one))) +
            ChangeBar(change(one), std::abs(change(sorted.front()))) + "</tr>\n";
  text += kTableEnd;
  return PanelAround({.heading = "Who was waited for",
                      .style = "half",
                      .id = "waited",
                      .note = "of a rank on average"},
                     text);
}

std::string FunctionsPanel(const CompareInput& input) {
  const Table& table = input.functions;
  if (table.rows.empty()) return {};
  std::string text =
      TableBegin("Exclusive time by function in both runs", {{"function", "text"},
                                                             {input.a.name, "number"},
                                                             {input.b.name, "number"},
                                                             {"change", "number"},
                                                             {"less | more", ""},
                                                             {"calls in " + input.a.name, "number"},
                                                             {"in " + input.b.name, "number"}});
  const double largest = std::abs(CellNumber(table.rows.front()[3]));
  const std::size_t shown = std::min(table.rows.size(), kMostFunctions);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::vector<Cell>& row = table.rows[i];
    const std::string name = CellText(row[0]);
    const double change = CellNumber(row[3]);
    text += fmt::format("<tr><th scope=\"row\"><span class=\"name\" title=\"{}\">{}</span></th>",
                        EscapeMarkup(ShortenMiddle(name, 600)),
                        EscapeMarkup(ShortenMiddle(ShortName(name), 80))) +
            SecondsCell(CellNumber(row[1])) + SecondsCell(CellNumber(row[2])) +
            NumberCell(change, SignedSeconds(change)) + ChangeBar(change, largest);
    for (const std::size_t column : {std::size_t{4}, std::size_t{5}})
      text += NumberCell(CellNumber(row[column]),
                         FormatCount(static_cast<std::int64_t>(CellNumber(row[column]))));
    text += "</tr>\n";
  }
  text += kTableEnd;
  if (shown < table.rows.size())
    text += fmt::format("<p class=\"more\">and {} that changed less</p>\n",
                        FormatCount(static_cast<std::int64_t>(table.rows.size() - shown)));
  return PanelAround({.heading = "Functions",
                      .style = "profile",
                      .id = "functions",
                      .note = "exclusive time, summed over all ranks; most change first"},
                     text);
}

std::string PairsPanel(const CompareInput& input) {
  const Table& table = input.pairs;
  if (input.a.messages.rows.size() < 2 && input.b.messages.rows.size() < 2) return {};
  if (table.rows.empty())
    return PanelWithout({.heading = "Messages", .id = "pairs"},
                        "Each rank sent each other as many messages and bytes in both runs.");
  std::string text =
      TableBegin("Messages and bytes from rank to rank", {{"from", "text"},
                                                          {"to", "text"},
                                                          {"messages in " + input.a.name, "number"},
                                                          {"in " + input.b.name, "number"},
                                                          {"change", "number"},
                                                          {"bytes in " + input.a.name, "number"},
                                                          {"in " + input.b.name, "number"},
                                                          {"change", "number"}});
  const std::size_t shown = std::min(table.rows.size(), kMostPairs);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::vector<Cell>& row = table.rows[i];
    const auto count = [&](std::size_t c) { return static_cast<std::int64_t>(CellNumber(row[c])); };
    text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>", EscapeMarkup(CellText(row[0])),
                        EscapeMarkup(CellText(row[1])));
    text += NumberCell(CellNumber(row[2]), FormatCount(count(2))) +
            NumberCell(CellNumber(row[3]), FormatCount(count(3))) +
            NumberCell(CellNumber(row[3]) - CellNumber(row[2]), SignedCount(count(3) - count(2))) +
            NumberCell(CellNumber(row[4]), FormatBytes(CellNumber(row[4]))) +
            NumberCell(CellNumber(row[5]), FormatBytes(CellNumber(row[5]))) +
            NumberCell(CellNumber(row[5]) - CellNumber(row[4]),
                       SignedBytes(CellNumber(row[5]) - CellNumber(row[4]))) +
            "</tr>\n";
  }
  text += kTableEnd;
  if (shown < table.rows.size())
    text += fmt::format("<p class=\"more\">and {} more pairs</p>\n",
                        FormatCount(static_cast<std::int64_t>(table.rows.size() - shown)));
  return PanelAround(
      {.heading = "Messages that changed", .id = "pairs", .note = "most change in bytes first"},
      text);
}

std::string MatrixPanels(const ComparedRun& run, std::string_view suffix) {
  const GroupedMatrix messages = Grouped(run.messages), volume = Grouped(run.volume);
  ViewInput views;
  views.messages = &messages.table;
  views.volume = &volume.table;
  Scene count = MessageMatrixView(views), bytes = VolumeMatrixView(views);
  count.name += suffix;
  bytes.name += suffix;
  return PanelText({.heading = "Messages of " + run.name,
                    .style = "quarter",
                    .end_note = true,
                    .note = messages.note},
                   count) +
         PanelText({.heading = "Volume of " + run.name,
                    .style = "quarter",
                    .end_note = true,
                    .note = volume.note},
                   bytes);
}

std::string Header(const CompareInput& input) {
  std::string text = "<header><h1>" + EscapeMarkup(input.headline) + "</h1>\n";
  for (const std::string& note : input.notes)
    text += "<p class=\"lead\">" + EscapeMarkup(note) + "</p>\n";
  for (const ComparedRun* run : {&input.a, &input.b}) {
    text += "<p class=\"facts\">" + EscapeMarkup(run->name) + ": ";
    for (const std::string& fact : run->facts)
      text += (&fact == &run->facts.front() ? "" : " \u00b7 ") + EscapeMarkup(fact);
    if (!run->health.empty()) text += " \u00b7 <b>" + EscapeMarkup(run->health.front()) + "</b>";
    text += "</p>\n";
  }
  return text + "</header>\n";
}

}  // namespace

std::string ComparePage(const CompareInput& input) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  page += EscapeMarkup(input.headline) + "</title>\n<style>" + PageStyle(input.mono) +
          "</style></head><body>\n";
  if (input.mono) page += MonoPatterns();
  page += Header(input) +
          "<main><section class=\"page\" id=\"compare\" aria-labelledby=\"p-compare\">"
          "<h2 id=\"p-compare\">Both runs</h2>\n";
  page += RunRow(input.a, "-a", true) + RunRow(input.b, "-b", false);
  page += PanelRow(StatesPanel(input) + WaitsPanel(input), "halves") + FunctionsPanel(input);
  page += PanelRow(MatrixPanels(input.a, "-a") + MatrixPanels(input.b, "-b"), "quarters") +
          PairsPanel(input);
  page += "</section></main>\n<script>";
  page += PageScript();
  return page + "</script>\n</body></html>\n";
}

}  // namespace stipple
