// SPDX-License-Identifier: MIT
// The `stipple` program: finds the subcommand. Errors of use and of input end here.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "analysis/tools/command.h"
#include "analysis/trace/input_error.h"

namespace stipple {

namespace {

constexpr Command kCommands[] = {
    {"flags", RunFlags, "print the flags that make a compiler trace"},
    {"run", RunRun, "run a command and record it"},
    {"info", RunInfo, "what an archive holds"},
    {"check", RunCheck, "prove an archive sound; one line per problem"},
    {"print", RunPrint, "events as text"},
    {"stats", RunStats, "a table: profile, states, messages, volume, waits"},
    {"plot", RunPlot, "a display of any statistic: SVG, PDF or PNG"},
    {"report", RunReport, "a self-contained HTML page"},
    {"view", RunView, "an interactive window on a run"},
    {"watch", RunWatch, "a run that is still going, page after page"},
    {"compact", RunCompact, "make an archive smaller"},
    {"compare", RunCompare, "two runs on one scale: what changed"},
    {"simulate", RunSimulate,
     "the ray tracer on a machine of another time, or of a thousand nodes"},
    {"exemplar", RunExemplar, "the ray tracer's experiments: charts on a page"},
};

std::string Help() {
  std::string text = "Usage: stipple COMMAND ...\n\nCommands (stipple COMMAND --help says more):\n";
  for (const Command& c : kCommands) text += fmt::format("  {:<9}{}\n", c.name, c.description);
  return text;
}

int Run(const Arguments& arguments) {
  if (arguments.empty()) {
    fmt::print(stderr, "{}", Help());
    return kUsageExit;
  }
  const std::string& name = arguments.front();
  if (name == "--help" || name == "-h" || name == "help") {
    WriteOut(Help());
    return 0;
  }
  if (name == "--version") {
    WriteOut("stipple " STIPPLE_VERSION "\n");
    return 0;
  }
  const Command* command = std::ranges::find(kCommands, name, &Command::name);
  if (command == std::end(kCommands)) {
    std::string known;
    for (const Command& c : kCommands) known.append(" ").append(c.name);
    throw InputError("stipple", "unknown command '" + name + "'; known:" + known);
  }
  return command->run({arguments.begin() + 1, arguments.end()});
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
  try {
    return stipple::Run({argv + 1, argv + argc});
  } catch (const stipple::InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return stipple::kUsageExit;
  } catch (const std::exception& e) {
    fmt::print(stderr, "stipple: {}\n", e.what());
    return 1;
  }
}
