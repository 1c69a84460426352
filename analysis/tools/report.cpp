// SPDX-License-Identifier: MIT
// stipple report: computes what a report shows; the library that draws it is opened only here.
#include <filesystem>

#include "analysis/report/report_input.h"
#include "analysis/stats/analysis.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/views_library.h"

namespace stipple {
namespace {

constexpr std::size_t kColumns = 1000;

}  // namespace

int RunReport(const Arguments& arguments) {
  CommandOptions app("A self-contained HTML page; no display needed.", "report");
  std::string archive;
  std::string output;
  bool mono = false;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"-o", "F.html", "the page to write (default: NAME.html)"}, output);
  app.Add({"--mono", "", "patterns instead of colours"}, mono);
  if (!app.Parse(arguments)) return 0;
  while (archive.size() > 1 && archive.back() == '/') archive.pop_back();
  if (output.empty()) output = std::filesystem::path(archive).stem().string() + ".html";
  const Drawer<ReportInput> draw("stipple report", "stipple_draw_report");
  ProgressLine progress;
  const Trace trace = Trace::Open(archive, progress.meter());
  const Analysis analysis(trace);
  ReportInput input = ReportInputOf(analysis, kColumns);
  input.mono = mono;
  trace.BeginPhase("drawing the page", 0);
  draw(input, output);
  progress.Stop();
  std::string text = input.finding.sentence + "\n";
  if (!input.finding.detail.empty()) text += input.finding.detail + "\n";
  WriteOut(text + output + "\n");
  WarnOfProblems(trace, analysis.health);
  return 0;
}

}  // namespace stipple
