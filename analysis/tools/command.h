// SPDX-License-Identifier: MIT
// A subcommand of `stipple`: one row of the table in stipple.cpp, one file.
#ifndef STIPPLE_ANALYSIS_TOOLS_COMMAND_H
#define STIPPLE_ANALYSIS_TOOLS_COMMAND_H

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/tools/options.h"
#include "analysis/trace/compact.h"
#include "analysis/trace/trace.h"

namespace stipple {

/// Arguments behind the subcommand's name. Returns the exit status; throws InputError.
using CommandFunction = int (*)(const Arguments& arguments);

struct Command {
  std::string_view name;
  CommandFunction run;
  std::string_view description;
};

int RunFlags(const Arguments& arguments);
int RunRun(const Arguments& arguments);
int RunInfo(const Arguments& arguments);
int RunCheck(const Arguments& arguments);
int RunPrint(const Arguments& arguments);
int RunStats(const Arguments& arguments);
int RunPlot(const Arguments& arguments);
int RunReport(const Arguments& arguments);
int RunSimulate(const Arguments& arguments);
int RunCompare(const Arguments& arguments);
int RunWatch(const Arguments& arguments);
int RunCompact(const Arguments& arguments);
int RunView(const Arguments& arguments);
int RunExemplar(const Arguments& arguments);

/// An option was not understood: exit 2.
constexpr int kUsageExit = 2;

/// PREFIX/lib/stipple of the running program.
std::string LibraryDirectory();

/// Loss, and what was left out, are shown on every output: one line each on standard error.
void WarnOfProblems(const Trace& trace, const TraceHealth& health);

/// A line on standard error for what a compaction left as it was.
void SayLeftAlone(const CompactResult& result);

/// Writes all of `text` to standard output; a closed pipe ends the program quietly.
void WriteOut(std::string_view text);

}  // namespace stipple

#endif
