// SPDX-License-Identifier: MIT
// raytracer-charts: measures what the ray tracer's choices cost and what they lose.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "raytracer/charts/chart_list.h"
#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

constexpr int kUnusable = 2;  // exit status after errors of use

struct ChartOptions {
  std::vector<std::string> names{};
  bool quick = false;
  std::string folder{};
};

std::string KnownCharts() {
  std::string text;
  for (const ChartEntry& chart : Charts())
    text += fmt::format("  {:<10} {}\n", chart.name, chart.meaning);
  return text;
}

/// The rows to measure, in the order of the table.
std::vector<const ChartEntry*> ChosenCharts(const std::vector<std::string>& names) {
  const bool all = names.empty() || std::ranges::find(names, "all") != names.end();
  for (const std::string& name : names)
    if (name != "all" && std::ranges::find(Charts(), name, &ChartEntry::name) == Charts().end())
      throw UsageError(fmt::format("no chart '{}'; there are:\n{}", name, KnownCharts()));
  std::vector<const ChartEntry*> chosen;
  for (const ChartEntry& chart : Charts())
    if (all || std::ranges::find(names, chart.name) != names.end()) chosen.push_back(&chart);
  return chosen;
}

void MeasureCharts(const ChartOptions& options) {
  const std::vector<const ChartEntry*> charts = ChosenCharts(options.names);
  std::error_code failed;
  std::filesystem::create_directories(options.folder, failed);
  if (failed) throw InputError(options.folder, 0, "cannot be made: " + failed.message());
  Session session(options.quick);
  for (const ChartEntry* chart : charts) {
    ChartTable table = chart->measure(session);
    table.effort = session.Effort(table.image.value_or(session.image()));
    session.progress.End();
    WriteCsv(table, options.folder);
    fmt::print("{}: {}\n", chart->name, table.sentence);
    std::fflush(stdout);
  }
}

int RunOrReport(int argc, char** argv) {
  CLI::App app("What the ray tracer's choices cost and lose: one CSV file a chart.",
               "raytracer-charts");
  app.footer("Charts:\n" + KnownCharts());
  ChartOptions options;
  app.add_option("NAME", options.names, "charts to measure (all)");
  app.add_flag("--quick", options.quick, "small scenes and pictures, each measured once");
  app.add_option("-o", options.folder, "where NAME.csv are written; made if need be")
      ->type_name("DIR")
      ->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUnusable;
  }
  try {
    MeasureCharts(options);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "raytracer-charts: {}\n", error.what());
    return kUnusable;
  }
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) { return stipple::raytracer::RunOrReport(argc, argv); }
