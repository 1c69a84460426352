// SPDX-License-Identifier: MIT
// All views, in two visible tables: displays of any table, which `stipple plot` offers, and the
// panels that reports are made of.
#ifndef STIPPLE_ANALYSIS_VIEWS_VIEW_LIST_H
#define STIPPLE_ANALYSIS_VIEWS_VIEW_LIST_H

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/finding.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
#include "analysis/stats/visit_bars.h"
#include "analysis/views/scene.h"

namespace stipple {

/// What views draw. A view whose part is missing or empty gives a scene without layers.
struct ViewInput {
  const Timeline* timeline = nullptr;  // the whole run
  const Timeline* detail = nullptr;    // a short period, with messages
  const Table* states = nullptr;       // rank, user_s, system_s, message_s, idle_s
  const Table* messages = nullptr;     // matrix of counts
  const Table* volume = nullptr;       // matrix of bytes
  const Finding* finding = nullptr;
  std::vector<const Table*> tables{};  // what views of any table show, several on one scale
  double at_s = std::numeric_limits<double>::infinity();  // the moment that dials, LEDs and the
                                                          // like show; the end if beyond it
  std::vector<std::string> columns{};  // value columns to show; none: as each view finds best
  std::string x{};                     // column along the graph's x axis
  const VisitBars* visits = nullptr;   // function bars below the detail's rows
};

using View = Scene (*)(const ViewInput& input);

/// A display that `stipple plot` offers. Any table that fits can be drawn by it.
struct ViewEntry {
  std::string_view name;
  View scene;
  bool (*fits)(const Table& table);  // none: it draws the timeline itself
  std::string_view tables;           // what it shows unless asked otherwise, with commas between
  bool by_rank;                      // it shows tables by rank that can be given so
  std::string_view description;
};

std::span<const ViewEntry> Views();

Scene BarsView(const ViewInput& input);
Scene ContourView(const ViewInput& input);
Scene DialsView(const ViewInput& input);
Scene FlameView(const ViewInput& input);
Scene GraphView(const ViewInput& input);
Scene HistogramView(const ViewInput& input);
Scene KiviatView(const ViewInput& input);
Scene LedsView(const ViewInput& input);
Scene MatrixView(const ViewInput& input);
Scene StatusView(const ViewInput& input);
Scene StripView(const ViewInput& input);
Scene XyView(const ViewInput& input);
/// The whole run, or its detail with messages and functions where one is given.
Scene TimelineOrDetailView(const ViewInput& input);

/// A panel of the report: what it draws is not a table but a part of ViewInput.
struct PanelEntry {
  std::string_view name;
  View scene;
};
std::span<const PanelEntry> Panels();

Scene TimelineView(const ViewInput& input);
Scene StateBarsView(const ViewInput& input);
Scene WaitedForView(const ViewInput& input);
Scene UtilisationView(const ViewInput& input);
Scene MessageLoadView(const ViewInput& input);
Scene DetailView(const ViewInput& input);
Scene MessageMatrixView(const ViewInput& input);
Scene VolumeMatrixView(const ViewInput& input);
/// Of the first table, which holds phases.
Scene PhaseBarsView(const ViewInput& input);

}  // namespace stipple

#endif
