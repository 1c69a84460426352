// SPDX-License-Identifier: MIT
// Where a rank that works by letters gets its points from: it knows them, the host gives them, or
// it takes them from a counter.
#ifndef STIPPLE_RAYTRACER_RENDER_POINT_SUPPLY_H
#define STIPPLE_RAYTRACER_RENDER_POINT_SUPPLY_H

#include <memory>
#include <optional>
#include <vector>

#include "raytracer/partition/guided.h"
#include "raytracer/partition/ray_partition.h"
#include "raytracer/render/mail.h"
#include "raytracer/render/work_counter.h"

namespace stipple::raytracer {

class PointSupply {
 public:
  /// Letters with tag `ask` go to the host, empty; those with its answer, the number of a bundle or
  /// kNoBundle, are handed to Given.
  PointSupply(const World& world, Mail& mail, const RayPartitionEntry& partition,
              const PartitionChoice& choice, int ask);

  static constexpr std::uint32_t kNoBundle = 0xffffffff;

  /// The next point, if there is one now. It may be that the host has been asked for more.
  std::optional<RasterPoint> Next();
  /// There will be no more.
  bool ended() const { return ended_; }
  /// How many are there now.
  std::size_t left() const { return points_.size() - next_; }
  void Given(std::uint32_t bundle);

 private:
  void Refill();

  const World& world_;
  Mail& mail_;
  Supply supply_;
  int ask_;
  std::vector<RasterPoint> points_;
  std::size_t next_ = 0;
  bool asked_ = false, ended_ = false;
  std::optional<Bundles> bundles_;  // of the host
  Tiles tiles_;                     // of the counter
  NodeMap nodes_;
  std::optional<GuidedBundles> guided_;
  std::unique_ptr<WorkCounter> counter_;
};

}  // namespace stipple::raytracer

#endif
