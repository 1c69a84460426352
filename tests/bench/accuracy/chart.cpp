// SPDX-License-Identifier: MIT
// bench_accuracy_chart FIGURES.csv CHART.svg: draws what `./run bench accuracy` measured, lines
// "clock,shape,percent,ns_per_event,median_error,worst_error"; one point for each clock, the
// medians over all shapes, and a small one for each shape.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "analysis/views/svg.h"
#include "analysis/views/xy_view.h"

namespace {

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  return (values[values.size() / 2] + values[(values.size() - 1) / 2]) / 2;
}

struct Figures {
  std::vector<double> percent, error;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream in(argv[1]);
  std::map<std::string, Figures> clocks;
  stipple::XyChart chart{.name = "speed-accuracy",
                         .title = "Speed against accuracy of the clock's modes"};
  chart.x = {"CPU time added to the program, %", -1, 2};
  chart.y = {"error of exclusive times, %: median over functions", -1, 2};
  chart.series = {{true, {}}, {false, {}}};
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string clock, shape, percent, ns, error;
    std::getline(fields, clock, ',');
    std::getline(fields, shape, ',');
    std::getline(fields, percent, ',');
    std::getline(fields, ns, ',');
    std::getline(fields, error, ',');
    if (error.empty() || shape == "shape") continue;
    clocks[clock].percent.push_back(std::stod(percent));
    clocks[clock].error.push_back(100 * std::stod(error));
    chart.series[0].points.push_back(
        {clocks[clock].percent.back(), clocks[clock].error.back(), "", false});
  }
  for (const auto& [clock, figures] : clocks) {
    const bool recommended = clock == "budget:5";
    chart.series[1].points.push_back({Median(figures.percent), Median(figures.error),
                                      clock + (recommended ? " (default)" : ""), recommended});
  }
  std::ofstream out(argv[2]);
  out << stipple::DrawSvg(stipple::XyView(chart), {.standalone = true});
  return out.good() ? 0 : 1;
}
