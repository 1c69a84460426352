// SPDX-License-Identifier: MIT
// The options of a subcommand, one row each; parser, help and the list of known ones derive from
// the rows. The library that parses stays in one source: its header takes longer to compile than a
// command.
#ifndef STIPPLE_ANALYSIS_TOOLS_OPTIONS_H
#define STIPPLE_ANALYSIS_TOOLS_OPTIONS_H

#include <memory>
#include <string>
#include <vector>

namespace stipple {

using Arguments = std::vector<std::string>;

class CommandOptions {
 public:
  /// How an option is shown and what it demands.
  struct Text {
    std::string name;   // "--clock"; without dashes: an argument, taken by position
    std::string value;  // stands for the value in the help: "MODE"; empty for flags and arguments
    std::string help;
    bool required = false;
    std::string needs{};  // another option, without which this one is refused
  };

  CommandOptions(std::string description, std::string command);
  ~CommandOptions();
  CommandOptions(const CommandOptions&) = delete;
  CommandOptions& operator=(const CommandOptions&) = delete;

  /// Given the option, `target` gets its value; a flag becomes true.
  void Add(const Text& text, std::string& target);
  void Add(const Text& text, double& target);
  void Add(const Text& text, unsigned& target);
  void Add(const Text& text, bool& target);
  /// Takes one or more.
  void Add(const Text& text, std::vector<std::string>& target);
  /// What the help ends with.
  void Footer(const std::string& text);

  /// False when help was asked for and printed. Errors: an InputError that names the known options.
  bool Parse(const Arguments& arguments);
  /// Whether it was given; false for an option that is not there.
  bool Has(const std::string& name) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace stipple

#endif
