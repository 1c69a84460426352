// SPDX-License-Identifier: MIT
#include "analysis/trace/jump_points.h"

#include "analysis/trace/scan.h"

namespace stipple {

std::optional<StackPlace> JumpPoints::After(const EventWord* record, std::size_t depth) {
  StackPlace place;
  switch (KindOf(*record)) {
    case RecordKind::kJumpPoint:
      points_[RecordAt<JumpPoint>(record).stack] = {context_, depth};
      return std::nullopt;
    case RecordKind::kUnwound:
      place = Unwind(RecordAt<Unwound>(record).stack);
      break;
    case RecordKind::kStackSwitch:
      place = Switch(RecordAt<StackSwitch>(record), depth);
      break;
    case RecordKind::kThreadEnd:
      place = {context_, 0};
      break;
    default:
      return std::nullopt;
  }
  context_ = place.context;
  return place;
}

StackPlace JumpPoints::Unwind(std::uint64_t stack) const {
  const auto point = points_.find(stack);
  return point == points_.end() ? StackPlace{context_, 0} : point->second;
}

StackPlace JumpPoints::Switch(const StackSwitch& r, std::size_t depth) {
  points_[r.from] = {context_, depth};
  const auto point = points_.find(r.to);
  return point == points_.end() ? StackPlace{++last_context_, 0} : point->second;
}

}  // namespace stipple
