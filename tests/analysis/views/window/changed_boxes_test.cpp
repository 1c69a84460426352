// SPDX-License-Identifier: MIT
// What is painted anew covers each triangle that changed, and no pixel twice.
#include "analysis/views/window/changed_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace stipple {
namespace {

bool Covers(const PixelBox& outer, const PixelBox& inner) {
  return outer.left <= inner.left && outer.top <= inner.top && outer.right >= inner.right &&
         outer.bottom >= inner.bottom;
}

void ExpectApart(const std::vector<PixelBox>& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_FALSE(boxes[i].empty());
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(boxes[i].Meets(boxes[k])) << i << ' ' << k;
  }
}

void ExpectCovered(const std::vector<PixelBox>& boxes, std::span<const Corner> triangle) {
  const PixelBox box = BoxOf(triangle);
  EXPECT_TRUE(box.empty() ||
              std::ranges::any_of(boxes, [&](const PixelBox& b) { return Covers(b, box); }));
}

class ChangedBoxes : public ::testing::Test {
 protected:
  int UpTo(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  void AppendTriangle(std::vector<Corner>& corners) {
    const int x = UpTo(400), y = UpTo(300), size = 1 + UpTo(30);
    for (int i = 0; i < 3; ++i) {
      Corner corner;
      corner.x = static_cast<float>(x) + static_cast<float>(UpTo(size * 4)) / 4;
      corner.y = static_cast<float>(y) + static_cast<float>(UpTo(size * 4)) / 4;
      corner.red = static_cast<std::uint8_t>(UpTo(3));
      corners.push_back(corner);
    }
  }
  std::vector<Corner> Triangles(int count) {
    std::vector<Corner> corners;
    for (int i = 0; i < count; ++i) AppendTriangle(corners);
    return corners;
  }

  std::mt19937 random_{7};
};

TEST_F(ChangedBoxes, ThatMeetBecomeOne) {
  for (int round = 0; round < 200; ++round) {
    std::vector<PixelBox> added, boxes;
    for (int i = UpTo(40); i > 0; --i) {
      const int left = UpTo(300), top = UpTo(300);
      added.push_back({left, top, left + UpTo(40), top + UpTo(40)});
      AddBox(boxes, added.back());
    }
    ExpectApart(boxes);
    for (const PixelBox& box : added)
      EXPECT_TRUE(box.empty() ||
                  std::ranges::any_of(boxes, [&](const PixelBox& b) { return Covers(b, box); }));
  }
}

TEST_F(ChangedBoxes, CoverEachTriangleThatIsNew) {
  for (int round = 0; round < 400; ++round) {
    const std::vector<Corner> before = Triangles(UpTo(60));
    std::vector<Corner> after = before;
    const auto at = [&] { return after.begin() + 3 * UpTo(static_cast<int>(after.size() / 3)); };
    for (int i = UpTo(4); i > 0; --i) {
      const auto place = at();
      if (UpTo(1) == 0 && place != after.end()) {
        after.erase(place, place + 3);
      } else {
        const std::vector<Corner> more = Triangles(1 + UpTo(3));
        after.insert(place, more.begin(), more.end());
      }
    }
    std::vector<PixelBox> boxes;
    AddChange(boxes, before, after);
    ExpectApart(boxes);
    const auto expect_rest = [&](std::span<const Corner> of, std::span<const Corner> other) {
      for (std::size_t i = 0; i < of.size(); i += 3) {
        const auto triangle = of.subspan(i, 3);
        const auto same = std::search(other.begin(), other.end(), triangle.begin(), triangle.end());
        if (same == other.end()) ExpectCovered(boxes, of.subspan(i, 3));
      }
    };
    expect_rest(before, after);
    expect_rest(after, before);
  }
}

TEST_F(ChangedBoxes, AreNoneWhereNothingChanged) {
  const std::vector<Corner> corners = Triangles(100);
  std::vector<PixelBox> boxes;
  AddChange(boxes, corners, corners);
  EXPECT_TRUE(boxes.empty());
}

TEST_F(ChangedBoxes, OfFewTrianglesFarApartStaySmall) {
  std::vector<Corner> before(6), after(6);
  for (int i = 0; i < 6; ++i) {
    const auto corner = static_cast<std::size_t>(i);
    before[corner].x = static_cast<float>(i % 3) + static_cast<float>(i < 3 ? 0 : 900);
    before[corner].y = static_cast<float>(i % 2 * 100);
    after[corner] = before[corner];
    after[corner].x += 5;
  }
  std::vector<PixelBox> boxes;
  AddChange(boxes, before, after);
  ExpectApart(boxes);
  for (const PixelBox& box : boxes) EXPECT_LE(box.right - box.left, 20);
}

}  // namespace
}  // namespace stipple
