// SPDX-License-Identifier: MIT
// The frame: what was found, the run in facts, the way to the pages, the bar with the range.
#include <fmt/format.h>

#include <vector>

#include "analysis/report/html.h"
#include "analysis/report/html_pages.h"
#include "analysis/report/html_style.h"
#include "analysis/report/page_data.h"
#include "analysis/views/layout.h"
#include "analysis/views/svg_write.h"

namespace stipple {
namespace {

constexpr std::size_t kLargestPage = 990'000;
constexpr std::size_t kLeastData = 60'000;

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

/// Hidden until the script shows it: without it nothing here works.
std::string RangeBar(const ReportInput& input) {
  if (input.timeline.rows.empty() || !(input.timeline.end_s > input.timeline.begin_s)) return {};
  constexpr std::string_view kButtons[][3] = {
      {"earlier", "Earlier: half a range to the left", "\u2190"},
      {"later", "Later: half a range to the right", "\u2192"},
      {"closer", "Closer: half of the range", "+"},
      {"wider", "Wider: twice the range", "\u2212"},
      {"whole", "Show the whole run", "whole run"}};
  std::string text =
      "<div id=\"range-bar\" role=\"region\" aria-label=\"Part of the run that is shown\" hidden>"
      "<div id=\"overview\" title=\"Drag to choose a part of the run\" aria-hidden=\"true\">"
      "<canvas></canvas><div class=\"box\" hidden></div><div class=\"moment\" hidden></div></div>"
      "<span id=\"range-text\"></span><div class=\"buttons\">";
  for (const auto& [id, label, sign] : kButtons)
    text += fmt::format(
        "<button type=\"button\" id=\"range-{}\" aria-label=\"{}\" title=\"{}\">{}</button>", id,
        label, label, sign);
  return text +
         "</div><p id=\"range-said\" class=\"unseen\" role=\"status\" aria-live=\"polite\"></p>"
         "</div>\n";
}

struct Written {
  const PageEntry* page;
  std::string content;
};

std::string Navigation(const std::vector<Written>& pages) {
  std::string text = "<nav aria-label=\"Pages\"><ul>";
  for (const Written& one : pages)
    text += fmt::format("<li><a href=\"#{}\">{}</a></li>", one.page->id, one.page->title);
  return text + "</ul></nav>\n";
}

}  // namespace

std::string ReportPage(const ReportInput& input) {
  const ViewInput views = ViewsOf(input);
  std::vector<Written> pages;
  for (const PageEntry& page : Pages())
    if (std::string content = page.content(input, views); !content.empty())
      pages.push_back({&page, std::move(content)});
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  page += EscapeMarkup(Headline(input)) + "</title>\n<style>" + PageStyle(input.mono) +
          "</style></head><body>\n<a class=\"skip\" href=\"#summary\">To the summary</a>\n";
  if (input.mono) page += MonoPatterns();
  page += Header(input) + Navigation(pages) + RangeBar(input) + "<main>\n";
  for (const Written& one : pages)
    page += fmt::format(
        "<section class=\"page\" id=\"{0}\" aria-labelledby=\"p-{0}\">\n<h2 "
        "id=\"p-{0}\">{1}</h2>\n{2}</section>\n",
        one.page->id, one.page->title, one.content);
  page += "</main>\n";
  const std::string_view script = PageScript();
  const std::size_t used = page.size() + script.size();
  page +=
      "<script type=\"application/json\" id=\"data\">" +
      PageData(input, views, std::max(kLeastData, kLargestPage - std::min(used, kLargestPage))) +
      "</script>\n<script>";
  page += script;
  return page + "</script>\n</body></html>\n";
}

}  // namespace stipple
