// SPDX-License-Identifier: MIT
#include "analysis/views/window/changed_boxes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace stipple {

PixelBox BoxOf(std::span<const Corner> corners) {
  if (corners.empty()) return {};
  const auto [left, right] = std::ranges::minmax(corners, {}, &Corner::x);
  const auto [top, bottom] = std::ranges::minmax(corners, {}, &Corner::y);
  return {static_cast<int>(std::floor(left.x)), static_cast<int>(std::floor(top.y)),
          static_cast<int>(std::ceil(right.x)), static_cast<int>(std::ceil(bottom.y))};
}

void AddBox(std::vector<PixelBox>& boxes, PixelBox box) {
  if (box.empty()) return;
  // A box that grows may meet others that it did not meet before.
  for (;;) {
    const auto met = std::ranges::find_if(boxes, [&](const PixelBox& b) { return b.Meets(box); });
    if (met == boxes.end()) break;
    box = {std::min(box.left, met->left), std::min(box.top, met->top),
           std::max(box.right, met->right), std::max(box.bottom, met->bottom)};
    boxes.erase(met);
  }
  boxes.push_back(box);
}

void AddChange(std::vector<PixelBox>& boxes, std::span<const Corner> before,
               std::span<const Corner> after) {
  const auto whole_triangles = [](std::ptrdiff_t corners) {
    return static_cast<std::size_t>(corners / 3 * 3);
  };
  const auto differs = std::ranges::mismatch(before, after);
  const std::size_t same = whole_triangles(differs.in1 - before.begin());
  before = before.subspan(same);
  after = after.subspan(same);
  const auto ends = std::mismatch(before.rbegin(), before.rend(), after.rbegin(), after.rend());
  const std::size_t same_end = whole_triangles(ends.first - before.rbegin());
  AddBox(boxes, BoxOf(before.first(before.size() - same_end)));
  AddBox(boxes, BoxOf(after.first(after.size() - same_end)));
}

}  // namespace stipple
