// SPDX-License-Identifier: MIT
#include "raytracer/render/point_supply.h"

namespace stipple::raytracer {

PointSupply::PointSupply(const World& world, Mail& mail, const RayPartitionEntry& partition,
                         const PartitionChoice& choice, int ask)
    : world_(world),
      mail_(mail),
      supply_(world.size > 1 ? partition.supply : Supply::kBeforehand),
      ask_(ask),
      tiles_(choice.raster) {
  switch (supply_) {
    case Supply::kBeforehand:
      points_ = partition.points(choice, world.rank, world.Nodes());
      break;
    case Supply::kHost:
      bundles_.emplace(choice);
      break;
    case Supply::kCounter:
      // Nobody knows what a tile costs: where objects are divided, other ranks pay for it as well.
      nodes_ = MapNodes(world, Node(world.comm));
      guided_.emplace(std::vector<std::uint64_t>(tiles_.count(), 1), nodes_.ranks);
      counter_ = std::make_unique<WorkCounter>(world, nodes_, guided_->Counts());
      break;
  }
}

std::optional<RasterPoint> PointSupply::Next() {
  if (next_ == points_.size() && !ended_ && !asked_) Refill();
  if (next_ == points_.size()) return std::nullopt;
  return points_[next_++];
}

void PointSupply::Refill() {
  points_.clear();
  next_ = 0;
  if (supply_ == Supply::kHost) {
    asked_ = true;
    mail_.Post(world_.size - 1, ask_, std::span<const std::byte>());
    return;
  }
  const std::optional<GuidedBundle> bundle = counter_ ? counter_->Take() : std::nullopt;
  ended_ = !bundle;
  if (ended_) return;
  for (const std::uint32_t tile : guided_->TilesOf(*bundle)) {
    const std::vector<RasterPoint> some = tiles_.Points(tile);
    points_.insert(points_.end(), some.begin(), some.end());
  }
}

void PointSupply::Given(std::uint32_t bundle) {
  asked_ = false;
  ended_ = bundle == kNoBundle;
  if (!ended_) points_ = bundles_->Points(bundle);
}

}  // namespace stipple::raytracer
