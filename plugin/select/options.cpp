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

bool SetThreshold(Options& options, std::string_view value) {
  const char* end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, options.instruction_threshold);
  return error == std::errc{} && stop == end;
}

bool SetPosition(Options& options, std::string_view value) {
  if (value == "after-inlining") options.position = Position::kAfterInlining;
  if (value == "source") options.position = Position::kSource;
  return value == "after-inlining" || value == "source";
}

struct OptionSpec {
  std::string_view name;
  bool (*set)(Options&, std::string_view);  // false: a bad value
  std::string_view values;
};
constexpr OptionSpec kOptions[] = {
    {"exclude-function-list", SetList<&Options::exclude_functions>, "NAME,NAME,..."},
    {"exclude-file-list", SetList<&Options::exclude_files>, "NAME,NAME,..."},
    {"include-function-list", SetList<&Options::include_functions>, "NAME,NAME,..."},
    {"instruction-threshold", SetThreshold, "a number of instructions"},
    {"instrument", SetPosition, "after-inlining or source"},
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

}  // namespace stipple::plugin
