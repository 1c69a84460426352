// SPDX-License-Identifier: MIT
#include "analysis/tools/selection_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

constexpr double kMostSeconds = 9e9;

struct OptionOf {
  const char* name;
  unsigned takes;
};
constexpr OptionOf kOptions[] = {{"--from", kTakesSpan},      {"--to", kTakesSpan},
                                 {"--ranks", kTakesRanks},    {"--regions", kTakesRegions},
                                 {"--sizes", kTakesMessages}, {"--tags", kTakesMessages},
                                 {"--window", kTakesWindow}};

std::int64_t Nanoseconds(double seconds) {
  return std::llround(std::clamp(seconds, 0.0, kMostSeconds) * 1e9);
}

}  // namespace

void SelectionOptions::AddTo(CommandOptions& app, unsigned takes) {
  app_ = &app;
  const auto add = [&](unsigned what, const char* name, auto& value, const char* type,
                       const char* help) {
    if ((takes & what) != 0) app.Add({name, type, help}, value);
  };
  add(kTakesSpan, "--from", from_s_, "T", "begin, in seconds since the first event");
  add(kTakesSpan, "--to", to_s_, "T", "end, in seconds since the first event");
  add(kTakesRanks, "--ranks", ranks_, "R", "only these: 0-3,7,host");
  add(kTakesRegions, "--regions", regions_, "NAMES", "only these functions: main,Solver::*");
  add(kTakesMessages, "--sizes", sizes_, "BYTES", "only messages of this size: 1k-64k, -100, 1M-");
  add(kTakesMessages, "--tags", tags_, "TAGS", "only messages with these tags: 3,7-9");
  add(kTakesWindow, "--window", window_s_, "S", "seconds that a moment of a series looks back on");
}

Selection SelectionOptions::For(const Trace& trace) const {
  const auto given = [this](const char* name) { return app_->Has(name); };
  Selection selection;
  if (std::isnan(from_s_)) throw InputError("--from", "is no time");
  if (std::isnan(to_s_)) throw InputError("--to", "is no time");
  selection.begin_ns = given("--from") ? Nanoseconds(from_s_) : 0;
  // Nothing is behind the end of the run, and its last event belongs to it.
  if (given("--to") && Nanoseconds(to_s_) < std::max<std::int64_t>(1, trace.SpanNs()))
    selection.end_ns = Nanoseconds(to_s_);
  if (given("--to") && to_s_ < from_s_)
    throw InputError("--to", fmt::format("{} s is before --from {} s", to_s_, from_s_));
  if (given("--ranks")) selection.ranks = ParseRanks(trace, ranks_);
  if (given("--regions")) selection.regions = ParseRegions(trace, regions_);
  if (given("--sizes")) std::tie(selection.least_bytes, selection.most_bytes) = ParseSizes(sizes_);
  if (given("--tags")) selection.tags = ParseTags(tags_);
  return selection;
}

std::int64_t SelectionOptions::WindowNs() const {
  if (!app_->Has("--window")) return 0;
  if (!(window_s_ >= 1e-9))
    throw InputError("--window", fmt::format("{} s is no length of time", window_s_));
  return Nanoseconds(window_s_);
}

void SelectionOptions::RefuseFor(const TableEntry& table) const {
  for (const OptionOf& o : kOptions) {
    if ((table.takes & o.takes) != 0 || !app_->Has(o.name)) continue;
    std::string others;
    for (const TableEntry& t : TableEntries())
      if ((t.takes & o.takes) != 0) others.append(" ").append(t.name);
    throw InputError(
        o.name, fmt::format("table '{}' does not know it; those that do:{}", table.name, others));
  }
}

}  // namespace stipple
