// SPDX-License-Identifier: MIT
#include "plugin/select/options.h"

#include <charconv>

namespace stipple::plugin {
namespace {

template <NameList Options::*list>
bool SetList(Options& options, std::string_view value) {
  for (std::string& part : SplitList(value)) (options.*list).push_back(std::move(part));
  return true;
}

bool SetFile(Options& options, std::string_view value) {
  options.filter_file = value;
  return !value.empty();
}

bool SetThreshold(Options& options, std::string_view value) {
  const char* end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, options.instruction_threshold);
  return error == std::errc{} && stop == end;
}

template <bool Options::*choice>
bool SetSwitch(Options& options, std::string_view value) {
  options.*choice = value == "on";
  return value == "on" || value == "off";
}

bool SetIgnoreLoops(Options& options, std::string_view value) {
  return SetSwitch<&Options::ignore_loops>(options, value.empty() ? "on" : value);
}

bool SetTailCalls(Options& options, std::string_view value) {
  options.tail_calls_preserved = value == "preserve";
  return value == "preserve" || value == "exit-after";
}

bool SetPosition(Options& options, std::string_view value) {
  options.position = value == "source" ? Position::kSource : Position::kAfterInlining;
  return value == "after-inlining" || value == "source";
}

struct OptionSpec {
  std::string_view name;
  bool (*set)(Options&, std::string_view);  // false: a bad value
  std::string_view values;
  std::string_view initial;
  std::string_view meaning;
};
constexpr OptionSpec kOptions[] = {
    {"exclude-function-list", SetList<&Options::exclude_functions>, "NAME,NAME,...", "",
     "leave out functions whose demangled or linkage name contains one of these; `\\,` is a comma"},
    {"exclude-file-list", SetList<&Options::exclude_files>, "NAME,NAME,...", "",
     "leave out functions of files whose path contains one of these"},
    {"include-function-list", SetList<&Options::include_functions>, "NAME,NAME,...", "",
     "take these even if they are short or of a system header or an excluded file"},
    {"filter-file", SetFile, "FILE", "", "rules in Score-P's syntax, see below"},
    {"instruction-threshold", SetThreshold, "a number of instructions", "20",
     "leave out functions shorter than this that have neither loop nor call"},
    {"ignore-loops", SetIgnoreLoops, "on or off, or no value for on", "off",
     "a loop does not save a short function from being left out"},
    {"system-headers", SetSwitch<&Options::system_headers>, "on or off", "off",
     "take functions of system headers and of namespace std like any other"},
    {"exceptions", SetSwitch<&Options::exceptions>, "on or off", "on",
     "record the leave of a function that an exception leaves; off saves its landing pad"},
    {"tail-calls", SetTailCalls, "preserve or exit-after", "preserve",
     "preserve: a tail call stays a jump, the leave comes before it; exit-after: it becomes a "
     "call, "
     "the leave comes after it"},
    {"instrument", SetPosition, "after-inlining or source", "after-inlining",
     "events for functions as they are after inlining, or for each as it is written"},
};

std::string KnownNames() {
  std::string names;
  for (const OptionSpec& option : kOptions) {
    if (!names.empty()) names += ", ";
    names += option.name;
  }
  return names;
}

}  // namespace

NameList SplitList(std::string_view text) {
  NameList parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',') {
      parts.back() += ',';
      ++i;
    } else if (text[i] == ',') {
      parts.emplace_back();
    } else {
      parts.back() += text[i];
    }
  }
  std::erase(parts, std::string());
  return parts;
}

std::optional<std::string> SetOption(Options& options, std::string_view name,
                                     std::string_view value) {
  for (const OptionSpec& option : kOptions) {
    if (option.name != name) continue;
    if (option.set(options, value)) return std::nullopt;
    return "stipple: option " + std::string(name) + " cannot be '" + std::string(value) +
           "'; it takes " + std::string(option.values);
  }
  return "stipple: unknown option '" + std::string(name) + "'; known are " + KnownNames();
}

std::string OptionTable() {
  std::string table = "| option | values | default | meaning |\n|---|---|---|---|\n";
  for (const OptionSpec& option : kOptions) {
    table += "| `" + std::string(option.name) + "` | " + std::string(option.values) + " | " +
             std::string(option.initial.empty() ? "none" : option.initial) + " | " +
             std::string(option.meaning) + " |\n";
  }
  return table;
}

}  // namespace stipple::plugin
