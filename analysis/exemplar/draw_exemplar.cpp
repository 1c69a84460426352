// SPDX-License-Identifier: MIT
#include "analysis/exemplar/chart_scene.h"
#include "analysis/exemplar/exemplar_page.h"
#include "analysis/exemplar/figure_scene.h"
#include "analysis/exemplar/verdict_page.h"
#include "analysis/report/library_door.h"
#include "analysis/views/sheet.h"
#include "analysis/views/svg.h"

extern "C" [[gnu::visibility("default")]] int stipple_draw_exemplar(
    const stipple::ExemplarInput* input, const char* folder, char* error, std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes, [&] {
    const std::string base = std::string(folder) + "/";
    for (const stipple::MeasuredChart& chart : input->charts)
      stipple::WriteWhole(stipple::DrawSvg(stipple::SceneOf(chart), {.standalone = true}),
                          base + chart.name + ".svg");
    stipple::WriteWhole(stipple::ExemplarPage(*input), base + "index.html");
  });
}

extern "C" [[gnu::visibility("default")]] int stipple_draw_verdicts(
    const stipple::VerdictInput* input, const char* folder, char* error, std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes, [&] {
    const std::string base = std::string(folder) + "/";
    for (const stipple::PaperResult& result : input->results)
      for (const stipple::Figure& figure : result.account.figures)
        stipple::WriteWhole(
            stipple::DrawSvg(stipple::OnSheet(stipple::SceneOf(figure)), {.standalone = true}),
            base + figure.name + ".svg");
    stipple::WriteWhole(stipple::VerdictPage(*input), base + "index.html");
  });
}
