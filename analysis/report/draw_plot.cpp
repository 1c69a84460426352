// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "analysis/report/library_door.h"
#include "analysis/report/plot_input.h"
#include "analysis/views/picture.h"
#include "analysis/views/sheet.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

Scene SceneOf(const PlotInput& plot) {
  const auto view = std::ranges::find(Views(), plot.view, &ViewEntry::name);
  if (view == Views().end()) throw std::runtime_error("no view '" + plot.view + "'");
  ViewInput input;
  input.timeline = &plot.timeline;
  if (plot.zoomed) input.detail = &plot.timeline;
  if (!plot.visits.rows.empty()) input.visits = &plot.visits;
  input.finding = &plot.finding;
  for (const Table& table : plot.tables) input.tables.push_back(&table);
  input.at_s = plot.at_s;
  input.columns = plot.columns;
  input.x = plot.x;
  return view->scene(input);
}

}  // namespace
}  // namespace stipple

extern "C" [[gnu::visibility("default")]] std::size_t stipple_plot_choices(
    const stipple::PlotChoice** first) {
  static const std::vector<stipple::PlotChoice> choices = [] {
    std::vector<stipple::PlotChoice> all;
    for (const stipple::ViewEntry& view : stipple::Views())
      all.push_back({view.name, view.tables, view.by_rank, view.fits, view.description});
    return all;
  }();
  *first = choices.data();
  return choices.size();
}

extern "C" [[gnu::visibility("default")]] int stipple_draw_plot(const stipple::PlotInput* input,
                                                                const char* path, char* error,
                                                                std::size_t error_bytes) {
  return stipple::ThroughDoor(error, error_bytes, [&] {
    const stipple::Scene scene = stipple::OnSheet(stipple::SceneOf(*input));
    stipple::WriteWhole(stipple::PictureOf(scene, path, input->mono), path);
  });
}
