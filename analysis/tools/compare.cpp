// SPDX-License-Identifier: MIT
// stipple compare: two runs on one scale, what changed and by how much.
#include "analysis/report/compare_input.h"
#include "analysis/stats/analysis.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/tools/selection_options.h"
#include "analysis/tools/views_library.h"

namespace stipple {
namespace {

constexpr std::size_t kColumns = 1024;

}  // namespace

int RunCompare(const Arguments& arguments) {
  CommandOptions app("Two runs on one scale: what changed and by how much. Needs no display.",
                     "compare");
  std::string first;
  std::string second;
  std::string output;
  bool mono = false;
  SelectionOptions selected;
  app.Add({"A", "", "the archive to compare with", true}, first);
  app.Add({"B", "", "the archive that changed", true}, second);
  app.Add({"-o", "F.html", "the page to write (default: compare.html)"}, output);
  app.Add({"--mono", "", "patterns instead of colours"}, mono);
  selected.AddTo(app);
  if (!app.Parse(arguments)) return 0;
  if (output.empty()) output = "compare.html";
  const Drawer<CompareInput> draw("stipple compare", "stipple_draw_compare");
  ProgressLine progress;
  const Trace trace_a = Trace::Open(first, progress.meter());
  const Trace trace_b = Trace::Open(second, progress.meter());
  const Selection of_a = selected.For(trace_a);
  const Selection of_b = selected.For(trace_b);
  const Analysis a(trace_a);
  const Analysis b(trace_b);
  CompareInput input = CompareInputOf(a, b, of_a, of_b, kColumns);
  input.mono = mono;
  trace_b.BeginPhase("drawing the page", 0);
  draw(input, output);
  progress.Stop();
  std::string text = input.headline + "\n";
  for (const std::string& note : input.notes) text += note + "\n";
  WriteOut(text + output + "\n");
  WarnOfProblems(trace_a, a.health);
  WarnOfProblems(trace_b, b.health);
  return 0;
}

}  // namespace stipple
