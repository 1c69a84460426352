// SPDX-License-Identifier: MIT
// Charts are shown in the order below; a file that is not among them comes last, so that a chart
// needs no row here to be drawn.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "analysis/exemplar/experiments.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOrder[] = {"sampling", "depth",   "precision", "patches",
                                       "quadrics", "offsets", "cracks",    "packets",
                                       "rays",     "sums",    "prediction"};

auto PlaceOf(const fs::path& file) {
  return std::distance(std::begin(kOrder), std::ranges::find(kOrder, file.stem().string()));
}

std::vector<fs::path> ChartFiles(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  if (failed) throw InputError(folder, "cannot be read: " + failed.message());
  if (files.empty()) throw InputError(folder, "there are no CSV files of charts");
  std::ranges::sort(files);
  std::ranges::stable_sort(files, {}, PlaceOf);
  return files;
}

}  // namespace

ExemplarInput SpeedAccuracy(const ExperimentSetup& setup) {
  if (setup.from.empty()) {
    std::vector<std::string> command{setup.programs + "/raytracer-charts", "-o", setup.folder};
    if (setup.quick) command.emplace_back("--quick");
    setup.run(command);
  }
  ExemplarInput input{"Speed against accuracy: what the ray tracer takes, and what else there is",
                      "CPU time of one thread \u00b7 each chart says what its truth is \u00b7 a "
                      "ring marks what to take by default",
                      {}};
  for (const fs::path& file : ChartFiles(setup.from.empty() ? setup.folder : setup.from))
    input.charts.push_back(ReadMeasuredChart(file.string()));
  return input;
}

}  // namespace stipple
