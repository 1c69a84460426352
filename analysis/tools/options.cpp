// SPDX-License-Identifier: MIT
#include "analysis/tools/options.h"

#include <CLI/CLI.hpp>
#include <utility>

#include "analysis/tools/command.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

std::string KnownOptions(const CLI::App& app) {
  std::string known;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_positional()) known += (known.empty() ? "" : " ") + option->get_name();
  return known;
}

void Describe(CLI::Option& option, const CommandOptions::Text& text) {
  if (!text.value.empty()) option.type_name(text.value);
  if (text.required) option.required();
  if (!text.needs.empty()) option.needs(text.needs);
}

}  // namespace

struct CommandOptions::Parser {
  CLI::App app;
};

CommandOptions::CommandOptions(std::string description, std::string command)
    : parser_(new Parser{CLI::App(std::move(description), std::move(command))}) {}

CommandOptions::~CommandOptions() = default;

void CommandOptions::Add(const Text& text, std::string& target) {
  Describe(*parser_->app.add_option(text.name, target, text.help), text);
}
void CommandOptions::Add(const Text& text, double& target) {
  Describe(*parser_->app.add_option(text.name, target, text.help), text);
}
void CommandOptions::Add(const Text& text, unsigned& target) {
  Describe(*parser_->app.add_option(text.name, target, text.help), text);
}
void CommandOptions::Add(const Text& text, bool& target) {
  Describe(*parser_->app.add_flag(text.name, target, text.help), text);
}

void CommandOptions::Add(const Text& text, std::vector<std::string>& target) {
  Describe(*parser_->app.add_option(text.name, target, text.help), text);
}

void CommandOptions::Footer(const std::string& text) { parser_->app.footer(text); }

bool CommandOptions::Parse(const Arguments& arguments) {
  CLI::App& app = parser_->app;
  app.set_help_flag("-h,--help", "print this and stop");
  Arguments reversed(arguments.rbegin(), arguments.rend());
  try {
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    WriteOut(app.help());
    return false;
  } catch (const CLI::ExtrasError&) {
    std::string extra;
    for (const std::string& word : app.remaining()) extra += (extra.empty() ? "" : " ") + word;
    throw InputError("stipple " + app.get_name(),
                     "unknown option or argument '" + extra + "'; known: " + KnownOptions(app));
  } catch (const CLI::ParseError& e) {
    throw InputError("stipple " + app.get_name(),
                     std::string(e.what()) + "; known options: " + KnownOptions(app));
  }
  return true;
}

bool CommandOptions::Has(const std::string& name) const {
  const CLI::Option* option = parser_->app.get_option_no_throw(name);
  return option != nullptr && option->count() != 0;
}

}  // namespace stipple
