// SPDX-License-Identifier: MIT
// Style sheet, script and hover data of the report page.
#ifndef STIPPLE_ANALYSIS_REPORT_HTML_STYLE_H
#define STIPPLE_ANALYSIS_REPORT_HTML_STYLE_H

#include <string>
#include <string_view>

#include "analysis/views/view_list.h"

namespace stipple {

/// Page layout, and the views' colours in the dark and, with `mono`, as patterns.
std::string PageStyle(bool mono);

/// Patterns that the monochrome style refers to.
std::string_view MonoPatterns();

/// What the page can do beyond being read: values under the pointer, tables sorted by a column.
std::string_view PageScript();

/// Shares per row and column for the pointer, as JSON; at most about 60 kB.
std::string HoverData(const ViewInput& input);

}  // namespace stipple

#endif
