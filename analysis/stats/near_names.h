// SPDX-License-Identifier: MIT
// Names that somebody may have meant: an error lists them beside the one that is not there.
#ifndef STIPPLE_ANALYSIS_STATS_NEAR_NAMES_H
#define STIPPLE_ANALYSIS_STATS_NEAR_NAMES_H

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// At most five of `names`, the nearest first: those that hold what was written, in any case, then
/// those that few changes make of it (of letters, one added or one left out). Each once.
std::vector<std::string> NearNames(const std::vector<std::string>& names, std::string_view written);

/// "Help" of "Solver::Help".
constexpr std::string_view WithoutScope(std::string_view name) {
  const std::size_t scope = name.rfind("::");
  return scope == std::string_view::npos ? name : name.substr(scope + 2);
}

}  // namespace stipple

#endif
