// SPDX-License-Identifier: MIT
// sample_displays FOLDER [RANKS]: writes every display of every sample table that fits it, to be
// looked at.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "analysis/views/sheet.h"
#include "analysis/views/svg.h"
#include "analysis/views/view_list.h"
#include "sample_tables.h"

int main(int argument_count, char** arguments) {
  if (argument_count < 2) {
    std::fputs("usage: sample_displays FOLDER [RANKS]\n", stderr);
    return 2;
  }
  const int ranks = argument_count > 2 ? std::atoi(arguments[2]) : 8;
  int number = 0;
  for (const stipple::Table& table :
       stipple::SampleTables(ranks, ranks > 1, stipple::Values::kSound)) {
    ++number;
    for (const stipple::ViewEntry& view : stipple::Views()) {
      if (view.fits == nullptr || !view.fits(table)) continue;
      stipple::ViewInput input;
      input.tables = {&table};
      const stipple::Scene scene = stipple::OnSheet(view.scene(input));
      const std::string path = std::string(arguments[1]) + '/' + std::string(view.name) + '-' +
                               table.name + std::to_string(number) + ".svg";
      std::ofstream(path) << stipple::DrawSvg(scene, {.standalone = true});
      std::printf("%-50s %5.0f x %5.0f\n", path.c_str(), scene.width, scene.height);
    }
  }
  return 0;
}
