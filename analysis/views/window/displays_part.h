// SPDX-License-Identifier: MIT
// The dynamic displays of a window: dials, LEDs, Kiviat, status and the like of one statistic at
// the moment of the cursor, several side by side. Each is the view of that name, fitted into its
// place.
#ifndef STIPPLE_ANALYSIS_VIEWS_WINDOW_DISPLAYS_PART_H
#define STIPPLE_ANALYSIS_VIEWS_WINDOW_DISPLAYS_PART_H

#include <map>
#include <string>
#include <string_view>

#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"
#include "analysis/stats/window_source.h"
#include "analysis/views/scene.h"
#include "analysis/views/window/window_layout.h"

namespace stipple {

std::string_view NameOf(Panel panel);
std::string_view NameOf(Statistic statistic);

/// Tables of the whole run that the displays show; filled while the window is open already.
struct DisplayTables {
  std::map<std::string, Table> by_name;
  bool ready = false;
  const Table* Find(const std::string& name) const;
};
/// Asks for all of them.
DisplayTables AskTables(const WindowSource& source);

/// Rows of a series over time that hold at `time_s`: of each rank the last one that is not later.
/// `value`: the one column kept beside rank; empty: all.
Table MomentOf(const Table& series, double time_s, std::string_view value);
/// The series without the columns that are not shown.
Table ColumnOf(const Table& series, std::string_view value);

/// What a display shows at `time_s`; without layers where it has nothing to show.
Scene DisplayScene(Panel panel, Statistic statistic, const DisplayTables& tables,
                   const WindowSource& source, const Timeline& whole, double time_s);

/// The scene's shapes, smaller if need be, in the middle of the area; texts too small to be read
/// are left out.
Layer Fitted(const Scene& scene, const Area& area);

}  // namespace stipple

#endif
