// SPDX-License-Identifier: MIT
// Where labels of points find room: beside their point, not over discs, lines or other labels.
#ifndef STIPPLE_ANALYSIS_VIEWS_LABEL_ROOM_H
#define STIPPLE_ANALYSIS_VIEWS_LABEL_ROOM_H

#include <optional>
#include <string_view>
#include <vector>

#include "analysis/views/scene.h"

namespace stipple {

struct Box {
  double left, top, right, bottom;
  bool Meets(const Box& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

/// The box of a line of text that begins at `at`.
Box BoxOfText(Point at, std::string_view text, const TextStyle& style);

class LabelRoom {
 public:
  /// Labels stay inside `area`.
  explicit LabelRoom(Box area) : area_(area) {}

  void TakeDisc(Point centre, double radius);
  void TakeLine(Point from, Point to);

  /// Labels may lie over lines, or not; never over discs and other labels.
  enum class Lines { kAvoided, kCrossed };

  /// Where a label of this text may begin, next to `point` or up to `rings` times as far away; it
  /// is taken then. None: there is no room.
  std::optional<Point> Take(Point point, std::string_view text, const TextStyle& style, Lines lines,
                            int rings = 1);

 private:
  bool IsFree(const Box& box, bool over_lines) const;

  Box area_;
  std::vector<Box> taken_;
  std::vector<Box> lines_;
};

/// The box of a text wherever it is anchored and however it is turned.
Box BoxOfText(const TextShape& text);

/// Texts whose places are given: each is taken if it lies inside and over no other.
class TextRoom {
 public:
  explicit TextRoom(Box area) : area_(area) {}
  bool Take(const TextShape& text, double apart = 3);

 private:
  Box area_;
  std::vector<Box> taken_;
};

}  // namespace stipple

#endif
