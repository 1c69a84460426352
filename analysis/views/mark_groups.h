// SPDX-License-Identifier: MIT
// Sends and receives above a row: a letter where one stands alone, a numeral where letters would
// overlap.
#ifndef STIPPLE_ANALYSIS_VIEWS_MARK_GROUPS_H
#define STIPPLE_ANALYSIS_VIEWS_MARK_GROUPS_H

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace stipple {

inline constexpr double kMarkSize = 11;  // of the letters, which are bold

struct EventMark {
  double x = 0;
  char letter = 's';        // or 'r'
  std::size_t message = 0;  // whose end it is
};

struct MarkGroup {
  std::size_t first = 0, count = 1;  // of the marks
  double x = 0;                      // its middle
  std::string text;
};

/// In the order of the marks, which must be that of x. What a numeral would touch joins it.
std::vector<MarkGroup> GroupMarks(std::span<const EventMark> marks);

}  // namespace stipple

#endif
