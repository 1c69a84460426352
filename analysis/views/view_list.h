// SPDX-License-Identifier: MIT
// All views, in one visible table: what `stipple plot` offers and reports are made of.
#ifndef STIPPLE_ANALYSIS_VIEWS_VIEW_LIST_H
#define STIPPLE_ANALYSIS_VIEWS_VIEW_LIST_H

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/stats/finding.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
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
};

using View = Scene (*)(const ViewInput& input);

struct ViewEntry {
  std::string_view name;
  View scene;
  std::string_view description;
};

std::span<const ViewEntry> Views();

Scene TimelineView(const ViewInput& input);
Scene StateBarsView(const ViewInput& input);
Scene WaitedForView(const ViewInput& input);
Scene UtilisationView(const ViewInput& input);
Scene MessageLoadView(const ViewInput& input);
Scene DetailView(const ViewInput& input);
Scene MessageMatrixView(const ViewInput& input);
Scene VolumeMatrixView(const ViewInput& input);

}  // namespace stipple

#endif
