// SPDX-License-Identifier: MIT
#include "analysis/stats/near_names.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <set>
#include <utility>

namespace stipple {
namespace {

constexpr std::size_t kMost = 5;
constexpr std::size_t kLongest = 256;  // of names of templates the begin says enough

std::string Lower(std::string_view text) {
  std::string lower(text.substr(0, kLongest));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// Letters to change, to add or to leave out, to make one of the other (Levenshtein).
std::size_t Distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> NearNames(const std::vector<std::string>& names,
                                   std::string_view written) {
  std::string wanted = Lower(written);
  std::erase(wanted, '*');
  std::set<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::string lower = Lower(name);
    const bool holds = !wanted.empty() && lower.find(wanted) != std::string::npos;
    const std::string last = Lower(WithoutScope(name));
    const std::size_t distance =
        holds ? 0 : std::min(Distance(lower, wanted), Distance(last, wanted));
    if (distance <= std::max<std::size_t>(2, wanted.size() / 3)) near.emplace(distance, name);
  }
  std::vector<std::string> nearest;
  for (const auto& [distance, name] : near)
    if (nearest.size() < kMost) nearest.push_back(name);
  return nearest;
}

}  // namespace stipple
