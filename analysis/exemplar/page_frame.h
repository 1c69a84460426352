// SPDX-License-Identifier: MIT
// What the exemplar's pages have in common: one self-contained HTML file.
#ifndef STIPPLE_ANALYSIS_EXEMPLAR_PAGE_FRAME_H
#define STIPPLE_ANALYSIS_EXEMPLAR_PAGE_FRAME_H

#include <string>
#include <string_view>

namespace stipple {

/// `title` and `lead` are plain text; `style` is CSS after that of all pages, `sections` markup.
std::string PageOf(std::string_view title, std::string_view lead, std::string_view style,
                   std::string_view sections);

}  // namespace stipple

#endif
