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
  /// Lines are avoided where that is possible, discs and labels always.
  void TakeLine(Point from, Point to);

  /// Where a label of this text may begin, next to `point` or up to `rings` times as far away; it
  /// is taken then. None: there is no room.
  std::optional<Point> Take(Point point, std::string_view text, const TextStyle& style,
                            int rings = 1);

 private:
  bool IsFree(const Box& box, bool over_lines) const;

  Box area_;
  std::vector<Box> taken_;
  std::vector<Box> lines_;
};

}  // namespace stipple

#endif
