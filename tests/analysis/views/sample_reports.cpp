// SPDX-License-Identifier: MIT
// sample_reports FOLDER: writes every sample as a report and its views as SVG files, to be looked
// at.
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

#include "analysis/report/html.h"
#include "analysis/report/html_compare.h"
#include "analysis/views/svg.h"
#include "sample_inputs.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: sample_reports FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = std::string(arguments[1]) + '/';
  for (const stipple::SampleEntry& sample : stipple::Samples()) {
    const stipple::ReportInput report = sample.make();
    const std::string page = stipple::ReportPage(report);
    std::ofstream(folder + std::string(sample.name) + ".html") << page;
    std::printf("%-12s %7zu bytes\n", std::string(sample.name).c_str(), page.size());
    for (const stipple::PanelEntry& view : stipple::Panels()) {
      const stipple::Scene scene = view.scene(stipple::ViewsOfSample(report));
      if (scene.layers.empty()) continue;
      std::ofstream(folder + std::string(sample.name) + '-' + std::string(view.name) + ".svg")
          << stipple::DrawSvg(scene, {.standalone = true});
    }
  }
  for (const auto& [a, b] : {std::pair(8, 8), std::pair(3, 1024)})
    std::ofstream(folder + "compare-" + std::to_string(b) + ".html")
        << stipple::ComparePage(stipple::SampleCompare(a, b));
  return 0;
}
