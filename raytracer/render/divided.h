// SPDX-License-Identifier: MIT
// Rendering where objects are divided among ranks.
//
// Each rank begins eye rays as the partition of the rays says and follows rays through the leaves
// that it holds. What leaves them is packed by destination and sent when a package is full, or when
// the rank has nothing else to do: else all might wait for rays that nobody sends. Of its rays a
// rank takes the deepest first and begins a new eye ray only when it has no other, so that few are
// under way; and no rank has more than a few packages from another that it has not worked off.
//
// What rays find is added up by point and sent to the assembling rank, in parts; they are sums of
// integers, so that no order of arrival can change the picture.
#ifndef STIPPLE_RAYTRACER_RENDER_DIVIDED_H
#define STIPPLE_RAYTRACER_RENDER_DIVIDED_H

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "raytracer/partition/coupling.h"
#include "raytracer/render/render.h"
#include "raytracer/render/travel.h"

namespace stipple::raytracer {

/// What became of the rays of one rank. It travels in messages as it is.
struct TravelCounts {
  std::uint64_t rays_sent = 0, packages_sent = 0;
  std::uint64_t rays_received = 0;
  std::uint64_t most_held = 0;  // rays at any one time
};

struct DividedRender {
  Rendered rendered;
  TravelCounts travel;
};

/// How rays are divided, and sent.
struct DividedChoice {
  std::string_view partition;
  PartitionChoice points;
  int holders = 1;            // ranks that hold objects and trace: all, or all but the host
  std::size_t package = 128;  // rays in a message, at most

  // Where the host is to prefer bundles that a rank can follow far: the way of one ray of each.
  // Empty: in their order.
  Ways ways{};
  const Holding* holding = nullptr;
};

/// Every rank calls it; the host passes no tracer.
template <class Real>
DividedRender RenderDivided(const World& world, RankTracer<Real>* tracer,
                            const DividedChoice& choice);

}  // namespace stipple::raytracer

#endif
