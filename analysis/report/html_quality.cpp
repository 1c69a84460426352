// SPDX-License-Identifier: MIT
#include "analysis/report/html_quality.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"
#include "analysis/views/svg.h"
#include "analysis/views/svg_write.h"
#include "analysis/views/text.h"
#include "analysis/views/xy_view.h"

namespace stipple {
namespace {

constexpr std::size_t kMostSteps = 12;
constexpr std::size_t kNameCharacters = 60;

std::string Name(const std::string& region) {
  return EscapeMarkup(ShortenMiddle(ShortName(region), kNameCharacters));
}

std::string PercentOf(double share) { return FormatThreeDigits(share * 100) + " %"; }

std::string Fact(std::string_view what, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", what, value);
}

std::string Facts(const RunAccuracy& a) {
  const bool known = a.calibrated && a.time_s > 0;
  std::string text = "<table><caption class=\"unseen\">How exact this run is</caption><tbody>\n" +
                     Fact("clock", EscapeMarkup(a.clock));
  text += Fact("what recording took",
               known ? fmt::format("{}, {} of the time that was recorded", FormatSeconds(a.cost_s),
                                   PercentOf(a.cost_s / a.time_s))
                     : "not measured in this run");
  text += Fact("largest doubt of an exclusive time",
               a.doubtful.empty()
                   ? "none: every visit has its times"
                   : fmt::format("\u00b1{} of {}", PercentOf(a.doubt), Name(a.doubtful)));
  text +=
      Fact("functions not recorded in full", FormatCount(static_cast<std::int64_t>(a.degraded)));
  text += Fact("clocks of different computers",
               a.computers < 2 ? "one computer, one clock"
                               : fmt::format("within {}", FormatSeconds(a.residual_s)));
  return text + "</tbody></table>\n";
}

std::string Steps(const RunAccuracy& a) {
  if (a.steps.empty()) return {};
  std::string text =
      "<table><caption class=\"unseen\">Steps of the budget</caption><thead><tr><th "
      "scope=\"col\">function</th><th scope=\"col\">from here on</th>"
      "<th scope=\"col\" class=\"n\">at</th><th scope=\"col\" class=\"n\">visits until then</th>"
      "<th scope=\"col\" class=\"n\">mean visit</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < std::min(a.steps.size(), kMostSteps); ++i) {
    const RunAccuracy::Step& s = a.steps[i];
    text += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td></tr>\n",
        Name(s.region), s.what, FormatSeconds(s.time_s),
        FormatCount(static_cast<std::int64_t>(s.visits)), FormatSeconds(s.mean_s));
  }
  text += "</tbody></table>\n";
  if (a.steps.size() > kMostSteps)
    text += fmt::format("<p class=\"more\">and {} more steps</p>\n",
                        FormatCount(static_cast<std::int64_t>(a.steps.size() - kMostSteps)));
  return text;
}

/// A run whose cost or doubt is nothing lies on the axis.
std::string Picture(const RunAccuracy& a) {
  if (!a.calibrated || !(a.time_s > 0)) return {};
  XyChart chart{.name = "accuracy", .title = "This run between speed and accuracy"};
  chart.x = {"recording, % of the time", -2, 2};
  chart.y = {"largest doubt of an exclusive time, %", -2, 2};
  chart.series = {{false, {{100 * a.cost_s / a.time_s, 100 * a.doubt, "this run", true}}}};
  chart.width = 360;
  chart.height = 236;
  return "<figure>" + DrawSvg(XyView(chart)) + "</figure>";
}

}  // namespace

std::string AccuracySection(const RunAccuracy& a) {
  if (a.clock.empty()) return {};
  return "<section class=\"panel accuracy\" aria-labelledby=\"h-accuracy\"><header "
         "class=\"panel\"><h3 "
         "id=\"h-accuracy\">How exact this run is</h3><span class=\"note\">functions with over 1% "
         "of "
         "the time; all: <code>stipple stats ARCHIVE --table overhead</code></span></header>\n"
         "<div class=\"line\"><div class=\"main\">" +
         Facts(a) + Steps(a) + "</div><div class=\"side\">" + Picture(a) +
         "</div></div></section>\n";
}

}  // namespace stipple
