// SPDX-License-Identifier: MIT
// stipple check: proves an archive sound.
#include <fmt/format.h>

#include "analysis/report/left_out.h"
#include "analysis/report/text.h"
#include "analysis/stats/analysis.h"
#include "analysis/stats/number.h"
#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/progress.h"
#include "analysis/trace/native_stack.h"

namespace stipple {

int RunCheck(const Arguments& arguments) {
  CommandOptions app("Prove an archive sound. One line per problem; exit 0 only if there is none.",
                     "check");
  std::string archive;
  app.Add({"A", "", "the archive", true}, archive);
  if (!app.Parse(arguments)) return 0;
  ProgressLine progress;
  // All is looked at again: an index would only tell what was there when it was made.
  const Trace trace = Trace::Open(archive, progress.meter(), {.use = false});
  const TraceHealth health = Analysis(trace).health;
  progress.Stop();
  std::string text;
  for (const Problem& p : health.problems()) text += TextOf(p) + "\n";
  if (health.Sound())
    text = fmt::format("{}: sound, {} of {}{}\n", archive, FormatCount(trace.EventCount(), "event"),
                       FormatCount(static_cast<std::uint64_t>(trace.RankCount()), "rank"),
                       RunningText(trace));
  // A crash is the program's defect, not the archive's.
  for (const std::string& crash : CrashTexts(trace)) text += crash + "\n";
  if (trace.kept()) text += LeftOutTexts(trace).front() + "\n";
  WriteOut(text);
  return health.Sound() ? 0 : 1;
}

}  // namespace stipple
