// SPDX-License-Identifier: MIT
// What the user can ask of the plugin. One table, so that both compilers know the same names and
// say the same about a wrong one.
#ifndef STIPPLE_PLUGIN_SELECT_OPTIONS_H
#define STIPPLE_PLUGIN_SELECT_OPTIONS_H

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::plugin {

/// Where in the compilation the events go in.
enum class Position { kAfterInlining, kSource };

/// Texts, any of which may occur in a name.
using NameList = std::vector<std::string>;

struct Options {
  NameList exclude_functions;
  NameList exclude_files;
  NameList include_functions;
  std::string filter_file;  // empty: none
  unsigned instruction_threshold = 20;
  bool ignore_loops = false;         // a loop does not save a short function
  bool system_headers = false;       // their functions are like any other
  bool exceptions = true;            // a leave where an exception leaves the function
  bool tail_calls_preserved = true;  // the leave before a tail call; else after what is then a call
  Position position = Position::kAfterInlining;
};

/// Sets the option `name` to `value`. The answer is empty if that went well, else one line that
/// says what is wrong and what would be right.
std::optional<std::string> SetOption(Options& options, std::string_view name,
                                     std::string_view value);

/// The options as rows of a table in Markdown: name, values, default, meaning.
std::string OptionTable();

/// The parts of a comma-separated list; `\,` stands for a comma, empty parts are dropped.
NameList SplitList(std::string_view text);

}  // namespace stipple::plugin

#endif
