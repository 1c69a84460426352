// SPDX-License-Identifier: MIT
#include "analysis/tools/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "analysis/report/left_out.h"
#include "analysis/report/text.h"
#include "analysis/trace/input_error.h"
#include "analysis/trace/ranks.h"

namespace stipple {
std::string LibraryDirectory() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return (self.parent_path().parent_path() / "lib" / "stipple").lexically_normal();
}

void WarnOfProblems(const Trace& trace, const TraceHealth& health) {
  const std::vector<Job> jobs = JobsOf(trace.processes());
  for (std::size_t i = 0; jobs.size() > 1 && i < jobs.size(); ++i)
    fmt::print(stderr, "stipple: MPI job {} of {}: {}, ranks {} to {}\n", i + 1, jobs.size(),
               jobs[i].program, jobs[i].first_rank, jobs[i].first_rank + jobs[i].rank_count - 1);
  for (const std::string& text : LeftOutTexts(trace)) fmt::print(stderr, "stipple: {}\n", text);
  if (const std::string running = RunningText(trace); !running.empty())
    fmt::print(stderr, "stipple: {}\n", running.substr(2));
  constexpr std::size_t kMost = 5;
  std::vector<Problem> problems = health.problems();
  std::erase_if(problems, [](const Problem& p) { return p.defect == Defect::kStillRunning; });
  for (std::size_t i = 0; i < std::min(kMost, problems.size()); ++i)
    fmt::print(stderr, "stipple: {}\n", TextOf(problems[i]));
  if (problems.size() > kMost)
    fmt::print(stderr, "stipple: and {} further problems: stipple check {}\n",
               problems.size() - kMost, trace.path());
}

void WriteOut(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    std::_Exit(1);
}

}  // namespace stipple
