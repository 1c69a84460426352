// SPDX-License-Identifier: MIT
#include "analysis/stats/collective_needs.h"

#include <algorithm>
#include <iterator>

namespace stipple {
namespace {

struct CollectiveEntry {
  std::string_view name;  // without "MPI_"; the I-form too
  Needs needs;
};
constexpr CollectiveEntry kCollectives[] = {
    {"Bcast", Needs::kRoot},       {"Scatter", Needs::kRoot},     {"Scatterv", Needs::kRoot},
    {"Reduce", Needs::kAllAtRoot}, {"Gather", Needs::kAllAtRoot}, {"Gatherv", Needs::kAllAtRoot},
    {"Scan", Needs::kLowerRanks},  {"Exscan", Needs::kLowerRanks}};

}  // namespace

std::string PlainCallName(std::string_view region) {
  std::string name(region.substr(0, 4) == "MPI_" ? region.substr(4) : region);
  if (name.size() > 2 && name[0] == 'I' && name[1] >= 'a' && name[1] <= 'z') {
    name.erase(0, 1);
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
  }
  return name;
}

Needs NeedsOf(std::string_view plain_name) {
  if (plain_name.starts_with("Neighbor_")) return Needs::kNeighbours;
  const auto* entry = std::ranges::find(kCollectives, plain_name, &CollectiveEntry::name);
  return entry == std::end(kCollectives) ? Needs::kAll : entry->needs;
}

}  // namespace stipple
