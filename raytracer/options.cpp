// SPDX-License-Identifier: MIT
#include "raytracer/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

bool HasCapital(std::string_view word) {
  return std::ranges::any_of(word, [](char c) { return c >= 'A' && c <= 'Z'; });
}

std::vector<std::string_view> Alternatives(const OptionSpec& spec) {
  std::vector<std::string_view> words;
  std::string_view rest = spec.value;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('|'), rest.size());
    words.push_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return words;
}

[[noreturn]] void Reject(const OptionSpec& spec, std::string_view text, std::string_view problem) {
  throw UsageError(fmt::format("--{} {}: {}", spec.name, text, problem));
}

double ToNumber(const OptionSpec& spec, std::string_view text, std::string_view digits) {
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || std::isnan(value))
    Reject(spec, text, fmt::format("should be {}", spec.value));
  if (value < spec.low || value > spec.high)
    Reject(spec, text, fmt::format("should be from {} to {}", spec.low, spec.high));
  return value;
}

std::int64_t ToCount(const OptionSpec& spec, std::string_view text, std::string_view digits) {
  const double value = ToNumber(spec, text, digits);
  if (value != std::floor(value)) Reject(spec, text, "should be a whole number");
  return static_cast<std::int64_t>(value);
}

/// 1500000, 1.5M or 2G: powers of 1000.
std::int64_t ToBytes(const OptionSpec& spec, std::string_view text) {
  constexpr std::string_view kSuffixes = "KMGT";
  const std::size_t power = text.empty() ? std::string_view::npos : kSuffixes.find(text.back());
  if (power == std::string_view::npos) return ToCount(spec, text, text);
  const double bytes = ToNumber(spec, text, text.substr(0, text.size() - 1)) *
                       std::pow(1000.0, static_cast<double>(power + 1));
  if (bytes > spec.high) Reject(spec, text, fmt::format("should be at most {}", spec.high));
  return static_cast<std::int64_t>(bytes);
}

/// Names that are no choice may be files, which have a dot or a slash in their name: so a mistyped
/// choice is noticed. Files with a fixed ending need it.
void CheckText(const OptionSpec& spec, const std::string& text) {
  std::vector<std::string_view> endings;
  bool file = false;
  for (const std::string_view word : Alternatives(spec)) {
    if (word == text) return;
    if (!HasCapital(word)) continue;
    if (word == "N") {
      ToCount(spec, text, text);
      return;
    }
    file = true;
    if (word.starts_with("F.")) endings.push_back(word.substr(1));
  }
  const bool has_ending =
      endings.empty() || std::ranges::any_of(endings, [&](std::string_view ending) {
        return text.ends_with(ending) && text.size() > ending.size();
      });
  if (!endings.empty() && !has_ending) Reject(spec, text, fmt::format("should be {}", spec.value));
  if (!file || (endings.empty() && text.find_first_of("./") == std::string::npos))
    Reject(spec, text, fmt::format("unknown; known are {}", fmt::join(Alternatives(spec), ", ")));
}

/// Sets the member of one option from its words.
class Setter {
 public:
  Setter(Options& options, const OptionSpec& spec, const std::vector<std::string>& words)
      : options_(options), spec_(spec), words_(words), text_(words.front()) {}

  void operator()(std::string Options::*member) const {
    CheckText(spec_, text_);
    options_.*member = text_;
  }
  void operator()(std::int64_t Options::*member) const {
    options_.*member =
        spec_.value == "BYTES" ? ToBytes(spec_, text_) : ToCount(spec_, text_, text_);
  }
  void operator()(double Options::*member) const {
    options_.*member = ToNumber(spec_, text_, text_);
  }
  void operator()(bool Options::*member) const { options_.*member = true; }
  void operator()(ImageSize Options::*member) const {
    const std::size_t cross = std::min(text_.find('x'), text_.size() - 1);
    const std::string_view all = text_;
    options_.*member = {static_cast<int>(ToCount(spec_, text_, all.substr(0, cross))),
                        static_cast<int>(ToCount(spec_, text_, all.substr(cross + 1)))};
  }
  void operator()(Samples Options::*member) const {
    Samples& samples = options_.*member;
    samples.adaptive = text_ == "adaptive";
    const bool named = samples.adaptive || text_ == "corners";
    samples.per_pixel = named ? 0 : static_cast<int>(ToCount(spec_, text_, text_));
  }
  void operator()(std::pair<std::string, std::string> Options::*member) const {
    options_.*member = {words_.at(0), words_.at(1)};
  }

 private:
  Options& options_;
  const OptionSpec& spec_;
  const std::vector<std::string>& words_;
  const std::string& text_;
};

std::string KnownOptions() {
  std::string known;
  for (const OptionSpec& spec : kOptions) known += fmt::format(" --{}", spec.name);
  return known + " --help";
}

std::string DefaultText(const OptionSpec& spec) {
  const Options defaults;
  if (const auto* text = std::get_if<std::string Options::*>(&spec.member))
    return defaults.*(*text) == "default" ? "" : defaults.*(*text);
  if (const auto* count = std::get_if<std::int64_t Options::*>(&spec.member))
    return defaults.*(*count) > 0 ? fmt::format("{}", defaults.*(*count)) : "";
  if (const auto* number = std::get_if<double Options::*>(&spec.member))
    return fmt::format("{}", defaults.*(*number));
  return std::holds_alternative<Samples Options::*>(spec.member) ? "corners" : "";
}

void AddRow(CLI::App& app, const OptionSpec& spec, Options& options) {
  const bool pair =
      std::holds_alternative<std::pair<std::string, std::string> Options::*>(spec.member);
  const bool is_switch = std::holds_alternative<bool Options::*>(spec.member);
  const auto set = [&options, &spec](const std::vector<std::string>& words) {
    std::visit(Setter(options, spec, words), spec.member);
    return true;
  };
  const std::string preset = DefaultText(spec);
  app.add_option(fmt::format("--{}", spec.name), set,
                 fmt::format("{}{}", spec.meaning,
                             preset.empty() ? "" : fmt::format(" (default {})", preset)))
      ->type_name(std::string(spec.value))
      ->type_size(is_switch ? 0
                  : pair    ? 2
                            : 1)
      ->multi_option_policy(pair ? CLI::MultiOptionPolicy::Throw
                                 : CLI::MultiOptionPolicy::TakeLast);
}

void Fill(CLI::App& app, Options& options) {
  app.name("raytracer");
  app.allow_extras();
  app.set_help_flag();
  app.add_flag("--help", options.help, "print this text and stop");
  for (const OptionSpec& spec : kOptions) AddRow(app, spec, options);
}

}  // namespace

Options ParseOptions(int argc, const char* const* argv) {
  CLI::App app;
  Options options;
  Fill(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  const std::vector<std::string> unknown = app.remaining();
  if (!unknown.empty())
    throw UsageError(
        fmt::format("{}: unknown option; known are{}", unknown.front(), KnownOptions()));
  options.samples.tolerance = options.tolerance;
  if (options.kernel == "embree" && !options.cost_map.empty())
    throw UsageError("--cost-map with --kernel embree: Embree does not count its tests");
  if (IsDivided(options) && options.samples.adaptive)
    throw UsageError(
        fmt::format("--samples adaptive with --objects {}: what a single ray found is in parts "
                    "there; --samples N takes as many for each pixel",
                    options.objects));
  return options;
}

std::string HelpText() {
  CLI::App app("Whitted's ray tracer on MPI ranks: mpirun -n 5 raytracer --partition bundles ...");
  Options options;
  Fill(app, options);
  app.get_formatter()->column_width(40);
  return app.help();
}

}  // namespace stipple::raytracer
