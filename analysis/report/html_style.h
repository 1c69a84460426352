// SPDX-License-Identifier: MIT
// Style sheet and script of the report page; their texts stand in page/.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_STYLE_H
#define STIPPLE_ANALYSIS_REPORT_HTML_STYLE_H

#include <string>
#include <string_view>

namespace stipple {

/// Page layout, and the views' colours in the dark and, with `mono`, as patterns.
std::string PageStyle(bool mono);

/// Patterns that the monochrome style refers to.
std::string_view MonoPatterns();

/// What the page can do beyond being read: pages, zoom, a range that drives the panels, values
/// under the pointer, tables sorted by a column.
std::string_view PageScript();

}  // namespace stipple

#endif
