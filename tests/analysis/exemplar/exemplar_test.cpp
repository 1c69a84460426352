// SPDX-License-Identifier: MIT
// From a CSV file to scenes and a page.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "analysis/exemplar/chart_scene.h"
#include "analysis/exemplar/exemplar_page.h"
#include "analysis/exemplar/figure_scene.h"
#include "analysis/exemplar/measured_chart.h"
#include "analysis/exemplar/result_files.h"
#include "analysis/exemplar/verdict_page.h"
#include "analysis/trace/input_error.h"
#include "analysis/views/palette.h"

namespace stipple {
namespace {

constexpr const char* kPoints =
    "# title: Rays per pixel\n# sentence: Take <4>, not 1.\n# kind: xy\n# quiet: old\n"
    "# x: cpu_s, CPU seconds\n# y: error, RMS error\n# other: is for others\n"
    "panel,series,label,cpu_s,error,recommended,bytes\n"
    "balls,new,1,0.1,0.02,0,\nballs,new,4,0.4,0.005,1,12\nballs,old,1,0.2,0.03,0,7\n"
    "rings,new,1,0.3,0.04,0,\nrings,new,4,1.2,0,1,12\n";

MeasuredChart ReadText(const std::string& text) {
  const std::string path = testing::TempDir() + "/points.csv";
  std::ofstream(path) << text;
  MeasuredChart chart = ReadMeasuredChart(path);
  std::filesystem::remove(path);
  return chart;
}

std::string ProblemOf(const std::string& text) {
  try {
    ReadText(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::size_t Count(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Texts in the accent colour.
std::vector<std::string> Accented(const Scene& scene) {
  std::vector<std::string> texts;
  for (const Layer& layer : scene.layers)
    for (const Shape& shape : layer.shapes)
      if (const auto* text = std::get_if<TextShape>(&shape))
        if (text->style.colour == kAccent) texts.push_back(text->text);
  return texts;
}

TEST(MeasuredChart, IsWhatTheFileSays) {
  const MeasuredChart chart = ReadText(kPoints);
  EXPECT_EQ(chart.name, "points");
  EXPECT_EQ(chart.sentence, "Take <4>, not 1.");
  EXPECT_EQ(chart.quiet, "old");
  EXPECT_EQ(chart.y.column, "error");
  EXPECT_EQ(chart.y.title, "RMS error");
  ASSERT_EQ(chart.table.rows.size(), 5U);
  EXPECT_EQ(std::get<std::string>(chart.table.rows[1][2]), "4") << "a label stays text";
  EXPECT_EQ(std::get<double>(chart.table.rows[1][3]), 0.4);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(chart.table.rows[0][6]));
}

TEST(MeasuredChart, UnusableFilesAreRefusedWithTheirLine) {
  const std::string text = kPoints;
  const auto with = [&](std::string_view from, std::string_view to) {
    std::string changed = text;
    return ProblemOf(changed.replace(changed.find(from), from.size(), to));
  };
  EXPECT_NE(with("0.02,0,", "0.02,").find("points.csv:9: 6 fields, but 7 columns"), text.npos);
  EXPECT_NE(with("0.02", "high").find("points.csv:9: column error: 'high'"), text.npos);
  EXPECT_NE(with("kind: xy", "kind: pie").find("kind 'pie'"), text.npos);
  EXPECT_NE(with("x: cpu_s,", "x: time,").find("'time', which is no column"), text.npos);
  EXPECT_NE(with("recommended", "advised").find("no column 'recommended'"), text.npos);
  EXPECT_NE(ProblemOf("").find("kind ''"), text.npos);
}

TEST(ChartScene, MarksTheRecommendedPointOfEachPanel) {
  const Scene scene = SceneOf(ReadText(kPoints));
  EXPECT_EQ(Accented(scene), (std::vector<std::string>{"4, recommended", "4, recommended"}));
}

TEST(ChartScene, AMapHasACellForEachValueAndNamesTheRecommendedPanel) {
  std::string text =
      "# kind: map\n# x: distance, d\n# y: size, s\n# value: error, share\n"
      "panel,series,label,cpu_s,error,recommended,size,distance\n";
  for (const char* panel : {"fixed,fixed,acne,,0.48,0,", "relative,relative,acne,,0,1,"})
    for (const char* place : {"0.001,0", "0.001,1e+06", "1,0", "1,1e+06"})
      text += std::string(panel) + place + "\n";
  const Scene scene = SceneOf(ReadText(text));
  EXPECT_EQ(Accented(scene), (std::vector<std::string>{"relative, recommended"}));
  int numbers = 0;
  for (const Layer& layer : scene.layers)
    if (layer.name == "numbers") numbers += static_cast<int>(layer.shapes.size());
  EXPECT_EQ(numbers, 4) << "48 in each cell of the first panel, nothing where nothing went wrong";
}

TEST(ExemplarPage, HoldsEveryChartItsSentenceAndItsFigures) {
  const std::string page = ExemplarPage({"Charts", "lead", {ReadText(kPoints)}});
  EXPECT_EQ(Count(page, "<svg"), 1U);
  EXPECT_NE(page.find("Take &lt;4&gt;, not 1."), page.npos);
  EXPECT_EQ(Count(page, "<tr>"), 6U) << "a head and five points";
  EXPECT_EQ(Count(page, "<td>recommended</td>"), 2U);
  EXPECT_EQ(page.find("http"), page.npos) << "nothing from outside";
}

/// Numbers that nobody measured: node 1 has the more to do the fewer messages there are.
std::vector<RunMeasures> MadeUp(std::span<const Case> cases) {
  std::vector<RunMeasures> all;
  for (const Case& c : cases) {
    RunMeasures m{.simulated_s = 2, .hash = "0", .messages = 9, .host = 2};
    const double more = c.labels.back() == "512" ? 0.9 : 0.0;
    m.nodes = {{0, 1.9 - more, 0.001, 0.002, 0.097 + more}, {1, 1.95, 0.001, 0.002, 0.047}};
    m.waits = {{"end-imbalance", 1, 0.1 + more}, {"late-sender", 2, 0.04}};
    all.push_back(m);
  }
  return all;
}

TEST(VerdictPage, TellsClaimVerdictCauseFiguresAndCommands) {
  const PaperResult result = Examine(kF12, "ipsc2", true, MadeUp);
  EXPECT_EQ(result.judgement.verdict, Verdict::kHolds);
  const std::string page = VerdictPage({"Claims", "lead", {result}});
  EXPECT_NE(page.find("<span class=\"verdict\">holds</span>"), page.npos);
  EXPECT_NE(page.find("96 % of it for node 1 (end-imbalance)"), page.npos) << "from the waits";
  EXPECT_EQ(Count(page, "<svg"), 2U) << "the reference's and the cluster of today's";
  EXPECT_EQ(Count(page, "<code>stipple simulate --machine ipsc2"), 2U);
  EXPECT_EQ(page.find("http"), page.npos) << "nothing from outside";
  EXPECT_NE(ResultJson(result).find("\"verdict\": \"holds\""), std::string::npos);
}

}  // namespace
}  // namespace stipple
