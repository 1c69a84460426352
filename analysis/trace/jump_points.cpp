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

void JumpPoints::Begin(const EventWord* open_frames) {
  const auto r = RecordAt<OpenFrames>(open_frames);
  const std::uint64_t left_out = r.depth > r.frames ? r.depth - r.frames : 0;
  const EventWord* point = open_frames + (sizeof r + r.frames * sizeof(OpenFrame)) / 8;
  for (std::uint32_t i = 0; i < r.points; ++i, point += sizeof(OpenPoint) / 8) {
    const auto p = RecordAt<OpenPoint>(point);
    points_[p.stack] = {context_, p.depth > left_out ? p.depth - left_out : 0};
  }
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
