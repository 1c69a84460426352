// SPDX-License-Identifier: MIT
// Choices are rows in a table; this finds one by name.
#ifndef STIPPLE_RAYTRACER_PARTITION_FIND_ROW_H
#define STIPPLE_RAYTRACER_PARTITION_FIND_ROW_H

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string_view>

namespace stipple::raytracer {

/// The options were checked against the same table, so a name that is not in it is a bug.
template <class Row, std::size_t kRows>
const Row& FindRow(const Row (&rows)[kRows], std::string_view name) {
  const Row* const row = std::ranges::find(rows, name, &Row::name);
  assert(row != std::end(rows));
  return *row;
}

}  // namespace stipple::raytracer

#endif
