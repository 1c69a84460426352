// SPDX-License-Identifier: MIT
// What VTK's device makes is repaired before it is written; no display is needed.
#include "analysis/views/svg.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/html.h"
#include "analysis/report/html_compare.h"
#include "analysis/report/html_style.h"
#include "analysis/report/page_code.h"
#include "analysis/report/page_data.h"
#include "analysis/views/palette.h"
#include "sample_inputs.h"

namespace stipple {
namespace {

Scene SceneWith(Shape shape) {
  return {
      .name = "test", .width = 100, .height = 50, .layers = {Layer{"layer", {std::move(shape)}}}};
}

bool Contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

std::size_t Count(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Svg, RightAlignedTextEndsAtItsAnchor) {
  const std::string svg = DrawSvg(
      SceneWith(TextShape{60, 20, "node 0", {.size = 13, .colour = kInk, .anchor = Anchor::kEnd}}));
  EXPECT_TRUE(Contains(
      svg,
      R"(<text x="60" y="24.73" fill="#1f2933" font-size="13" text-anchor="end">node 0</text>)"))
      << svg;
}

TEST(Svg, TextIsEscapedAndStaysText) {
  const std::string svg =
      DrawSvg(SceneWith(TextShape{1, 1, "f<\"a\"> & \u00b5s\xff", {.size = 12, .colour = kInk}}));
  EXPECT_TRUE(Contains(svg, ">f&lt;&quot;a&quot;&gt; &amp; \u00b5s?</text>")) << svg;
}

TEST(Svg, AreasHaveNoOutlineAndLinesNoFilling) {
  const std::string area = DrawSvg(SceneWith(RectShape{10, 5, 20, 30, kInk, {}}));
  EXPECT_FALSE(Contains(area, "stroke=\"#"));
  EXPECT_TRUE(Contains(area, R"(<path fill="#1f2933" d="M10 35h20v-30h-20z"/>)")) << area;
  const std::string line = DrawSvg(SceneWith(LineShape{{{0, 0}, {9, 7}}, kInk, 2, true, 1}));
  EXPECT_TRUE(Contains(line, R"(fill="none")"));
  EXPECT_TRUE(Contains(line, R"(stroke-width="2" stroke-dasharray="3 3" d="M0 0l9 7")")) << line;
}

TEST(Svg, TooltipBelongsToItsRectangle) {
  const std::string svg = DrawSvg(SceneWith(RectShape{0, 0, 1, 1, kInk, "0 \u2192 1: 2 < 3"}));
  EXPECT_TRUE(Contains(svg, "<title>0 \u2192 1: 2 &lt; 3</title></path>")) << svg;
}

TEST(Svg, EqualNeighboursBecomeOneElement) {
  Scene scene = SceneWith(RectShape{0, 0, 1, 1, kInk, {}});
  for (int i = 1; i < 50; ++i)
    scene.layers[0].shapes.emplace_back(RectShape{2.0 * i, 0, 1, 1, kInk, {}});
  EXPECT_EQ(Count(DrawSvg(scene), "<path"), 1U);
}

TEST(Svg, StandaloneFileHasItsOwnGround) {
  const std::string svg = DrawSvg(SceneWith(RectShape{0, 0, 1, 1, kInk, {}}), {.standalone = true});
  EXPECT_TRUE(Contains(svg, "xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\""));
  EXPECT_TRUE(Contains(svg, "fill=\"#ffffff\""));
}

TEST(Report, SameInputGivesTheSameBytesWithoutADisplay) {
  unsetenv("DISPLAY");
  for (const int nodes : {1, 8, 40})
    EXPECT_EQ(ReportPage(SampleReport(nodes, true)), ReportPage(SampleReport(nodes, true)))
        << nodes;
}

TEST(Report, StaysBelowAMegabyteForAnyTrace) {
  for (const SampleEntry& sample : Samples())
    EXPECT_LE(ReportPage(sample.make()).size(), 1'000'000U) << sample.name;
}

TEST(Report, FirstLineIsTheFinding) {
  const ReportInput report = SampleReport(8, true);
  const std::string page = ReportPage(report);
  EXPECT_TRUE(Contains(page, "<header><h1>" + report.finding.sentence + "</h1>"));
}

TEST(Report, RefersToNothingOutsideItself) {
  const std::string page = ReportPage(SampleReport(8, true));
  for (const char* reference : {"http:", "https:", "src=", "@import", "<link"})
    EXPECT_FALSE(Contains(page, reference)) << reference;
}

TEST(Report, SerialProgramHasNoCommunicationSections) {
  const std::string page = ReportPage(SampleSerial());
  for (const char* id :
       {"h-matrix", "h-volume", "h-detail", "h-waited-for", "h-utilisation", "h-waits"})
    EXPECT_FALSE(Contains(page, id)) << id;
  EXPECT_TRUE(Contains(page, "h-timeline"));
  EXPECT_TRUE(Contains(page, "h-profile"));
}

TEST(Report, LossesStandInTheFactsLine) {
  const std::string page = ReportPage(SampleReport(3, false));
  EXPECT_TRUE(Contains(page, "<b>1,204 events of rank 2 lost</b>"));
  EXPECT_TRUE(Contains(page, "<li>3 messages without a receive</li>"));
}

TEST(Report, HostileNamesCannotLeaveTheirPlace) {
  ReportInput report = SampleSerial();
  const std::string hostile = "</script><script>alert(1)</script>\"'&<";
  report.title = report.finding.sentence = hostile;
  report.timeline.rows[0].name = hostile;
  report.profile.rows[0][0] = hostile;
  report.profile.rows[0][1] = hostile;
  EXPECT_FALSE(Contains(ReportPage(report), "<script>alert"));
}

TEST(Report, NamesInThePagesDataAreJson) {
  ReportInput report = SampleReport(3, true);
  report.timeline.rows.back().name = "a\\b\"c</script>";
  const std::string data = PageData(report, ViewsOfSample(report), 400'000);
  EXPECT_TRUE(Contains(data, R"("name":"a\\b\"c\u003c/script>")")) << data.substr(0, 200);
}

/// What the page's script makes of packed bytes.
std::vector<int> Unpacked(const std::string& packed) {
  std::vector<int> bytes;
  for (std::size_t i = 0; i < packed.size();) {
    const int n = static_cast<unsigned char>(packed[i++]);
    if (n < 128)
      for (int k = 0; k <= n; ++k) bytes.push_back(static_cast<unsigned char>(packed[i++]));
    else
      bytes.insert(bytes.end(), static_cast<std::size_t>(258 - n),
                   static_cast<unsigned char>(packed[i++]));
  }
  return bytes;
}

TEST(Report, SharesOfAnyPartAreRightToTwoUnitsOfAColumn) {
  std::mt19937 random(7);
  for (const int kind : {0, 1, 2, 3}) {
    std::vector<double> shares;
    for (int i = 0; i < 3000; ++i) {
      const double any = static_cast<double>(random() % 1000) / 999;
      shares.push_back(kind == 0 ? any : kind == 1 ? 0.0013 : kind == 2 ? i / 500 % 2 : any * 0.01);
    }
    const std::string bytes = ByteShares(shares);
    const std::vector<int> told =
        Unpacked(PackBits({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
    ASSERT_EQ(told.size(), shares.size());
    double error = 0, most = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      error += told[i] - shares[i] * 255;
      most = std::max(most, std::abs(error));
    }
    EXPECT_LE(most, 2.01) << kind;
  }
}

TEST(Report, PackedRunsAreShort) {
  const std::vector<std::uint8_t> same(1300, 9);
  EXPECT_EQ(PackBits(same).size(), 20U);
  EXPECT_EQ(Base64(std::vector<std::uint8_t>{'a', 'b', 'c', 'd'}), "YWJjZA==");
}

TEST(Compare, HeadlineNamesWhatChangedMost) {
  const CompareInput input = SampleCompare(8, 8);
  EXPECT_EQ(input.headline,
            "after is 1.25 times as fast as before: 4.10 s less waiting for node 0");
  EXPECT_EQ(CompareHeadline(input.b, input.a),
            "before takes 1.25 times as long as after: 4.10 s more waiting for node 0");
  EXPECT_EQ(CompareHeadline(input.a, input.a), "before takes as long as before");
}

TEST(Compare, SameInputGivesTheSameBytesBelowAMegabyte) {
  for (const auto& [a, b] : {std::pair(1, 1), std::pair(4, 8), std::pair(1000, 1024)}) {
    const std::string page = ComparePage(SampleCompare(a, b));
    EXPECT_EQ(page, ComparePage(SampleCompare(a, b)));
    EXPECT_LE(page.size(), 1'000'000U) << a;
  }
}

TEST(Report, ScriptHasNoSyntaxError) {
  if (std::system("node --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs node";
  const std::string path =
      testing::TempDir() + "stipple_page_script_" + std::to_string(getpid()) + ".js";
  std::ofstream(path) << PageScript();
  EXPECT_EQ(std::system(("node --check '" + path + "'").c_str()), 0);
  std::remove(path.c_str());
}

TEST(Report, ManyFunctionsAreCutAtThirty) {
  const std::string page = ReportPage(SampleReport(32, true));
  EXPECT_EQ(Count(page, "<td class=\"share\">"), 30U);
  EXPECT_TRUE(Contains(page, "and 1,204 more")) << "the rest is named";
}

}  // namespace
}  // namespace stipple
