// SPDX-License-Identifier: MIT
// A picture with its heading, the unit from which pages are built.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_PANEL_H
#define STIPPLE_ANALYSIS_REPORT_HTML_PANEL_H

#include <string>
#include <string_view>

#include "analysis/views/scene.h"

namespace stipple {

struct Panel {
  std::string heading;
  std::string style{};      // class of the section
  bool end_note = false;    // the note stands at the right end
  std::string beside{};     // markup between heading and note
  std::string below{};      // markup under the picture
  std::string_view id{};    // of its elements; empty: the scene's name
  std::string_view note{};  // in place of the scene's
};

/// Empty where the view has nothing to show.
std::string PanelText(const Panel& panel, const Scene& scene);

/// The same around any markup; `id` must be given.
std::string PanelAround(const Panel& panel, const std::string& content);

/// A panel that says in one line what was not recorded, and what records it.
std::string PanelWithout(const Panel& panel, std::string_view sentence);

/// Panels side by side; empty when all are.
std::string PanelRow(const std::string& panels, std::string_view style = {});

}  // namespace stipple

#endif
