// SPDX-License-Identifier: MIT
#include "raytracer/partition/object_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace stipple::raytracer {
namespace {

double Component(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double& Component(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Of the part of the objects' common box that lies in the cell.
int LongestAxis(std::span<const Bounds> boxes, const std::vector<std::uint32_t>& numbers,
                const Bounds& cell) {
  Bounds all;
  for (const std::uint32_t number : numbers) all.Include(boxes[number]);
  const Vec3 size = Min(all.high, cell.high) - Max(all.low, cell.low);
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

/// Where `share` of the objects' middles lie below, as far as they lie in the cell.
double MedianPlane(std::span<const Bounds> boxes, const std::vector<std::uint32_t>& numbers,
                   const Bounds& cell, int axis, double share) {
  const double low = Component(cell.low, axis), high = Component(cell.high, axis);
  if (numbers.empty()) return low * 0.5 + high * 0.5;
  std::vector<double> middles;
  middles.reserve(numbers.size());
  for (const std::uint32_t number : numbers) {
    const double from = std::max(low, Component(boxes[number].low, axis));
    const double to = std::min(high, Component(boxes[number].high, axis));
    middles.push_back(from * 0.5 + to * 0.5);
  }
  const auto position = std::min(
      static_cast<std::size_t>(share * static_cast<double>(middles.size())), middles.size() - 1);
  const auto nth = middles.begin() + static_cast<std::ptrdiff_t>(position);
  std::nth_element(middles.begin(), nth, middles.end());
  if (position == 0) return *nth;
  // Between two middles: a plane through one would cut its object.
  return *nth * 0.5 + *std::max_element(middles.begin(), nth) * 0.5;
}

}  // namespace

ObjectTree::ObjectTree(std::span<const Bounds> boxes, std::uint32_t leaves, const Bounds& scene)
    : scene_(scene) {
  for (const Bounds& box : boxes) scene_.Include(box);
  std::vector<std::uint32_t> all(boxes.size());
  std::iota(all.begin(), all.end(), 0U);
  root_ = Split(boxes, std::move(all), scene_, leaves);
}

std::int32_t ObjectTree::Split(std::span<const Bounds> boxes, std::vector<std::uint32_t> numbers,
                               const Bounds& cell, std::uint32_t leaves) {
  if (leaves == 1) {
    cells_.push_back(cell);
    return ~static_cast<std::int32_t>(cells_.size() - 1);
  }
  const std::uint32_t leaves_below = leaves / 2;
  const int axis = LongestAxis(boxes, numbers, cell);
  const double at =
      MedianPlane(boxes, numbers, cell, axis, static_cast<double>(leaves_below) / leaves);
  std::vector<std::uint32_t> below, above;
  for (const std::uint32_t number : numbers) {
    if (Component(boxes[number].low, axis) <= at) below.push_back(number);
    if (Component(boxes[number].high, axis) > at) above.push_back(number);
  }
  numbers = {};
  const auto plane = static_cast<std::int32_t>(planes_.size());
  planes_.push_back({axis, at, 0, 0});
  Bounds cell_below = cell, cell_above = cell;
  Component(cell_below.high, axis) = Component(cell_above.low, axis) = at;
  const std::int32_t to_below = Split(boxes, std::move(below), cell_below, leaves_below);
  const std::int32_t to_above = Split(boxes, std::move(above), cell_above, leaves - leaves_below);
  planes_[static_cast<std::size_t>(plane)].below = to_below;
  planes_[static_cast<std::size_t>(plane)].above = to_above;
  return plane;
}

void ObjectTree::LeavesOf(const Bounds& box, std::vector<std::uint32_t>& leaves) const {
  leaves.clear();
  std::int32_t above[kMostPlanesAbove];
  int count = 0;
  for (std::int32_t link = root_;;) {
    if (link >= 0) {
      const Plane& plane = planes_[static_cast<std::size_t>(link)];
      link = plane.above;
      if (!(Component(box.low, plane.axis) <= plane.at)) continue;
      if (Component(box.high, plane.axis) > plane.at) above[count++] = plane.above;
      link = plane.below;
      continue;
    }
    leaves.push_back(static_cast<std::uint32_t>(~link));
    if (count == 0) return;
    link = above[--count];
  }
}

/// At a plane `now` becomes the first side that the ray is on. True if it is on the other as well,
/// which `later` then describes.
inline bool LeafWay::Cross(const ObjectTree::Plane& plane, Part& now, Part& later) const {
  const double distance = plane.at - Component(ray_.origin, plane.axis);
  const double direction = Component(ray_.direction, plane.axis);
  const bool from_below = direction > 0 || (direction == 0 && distance > 0);
  const std::int32_t near = from_below ? plane.below : plane.above;
  const std::int32_t far = from_below ? plane.above : plane.below;
  double crosses = now.from, around = std::numeric_limits<double>::infinity();
  if (std::abs(direction) > margin_) {
    crosses = distance / direction;
    around = slack_ / std::abs(direction) + margin_ * std::abs(crosses);
  } else if (std::abs(distance) > 4 * slack_) {  // along the plane
    now.link = distance > 0 ? plane.below : plane.above;
    return false;
  }
  if (crosses + around < now.from) {
    now.link = far;
    return false;
  }
  if (crosses - around > now.to) {
    now.link = near;
    return false;
  }
  const double from = std::max(now.from, crosses - around);
  later = {far, from, now.to, now.after};
  now = {near, now.from, std::min(now.to, crosses + around), std::min(from, now.after)};
  return true;
}

void LeafWay::Begin(const ObjectTree& tree, const Ray<double>& ray, double rounding) {
  tree_ = &tree;
  ray_ = ray;
  leaves_.clear();
  count_ = 0;
  planes_ = 0;
  const Bounds& scene = tree.scene_;
  if (!(scene.low.x <= scene.high.x)) return;
  constexpr double kForever = std::numeric_limits<double>::infinity();
  margin_ = 64 * rounding;
  if (std::isinf(EnterBounds(scene, SlabRay(ray, 1 + margin_), kForever))) return;
  slack_ = margin_ * (MaxNorm(scene.low) + MaxNorm(scene.high) + MaxNorm(ray.origin));
  waiting_[0] = {tree.root_, 0, kForever, kForever};
  count_ = 1;
}

void LeafWay::FindNext() {
  Part now = waiting_[static_cast<std::size_t>(--count_)];
  while (now.link >= 0) {
    ++planes_;
    const ObjectTree::Plane& plane = tree_->planes_[static_cast<std::size_t>(now.link)];
    if (Cross(plane, now, waiting_[static_cast<std::size_t>(count_)])) ++count_;
  }
  // The margins of two neighbours overlap: whoever stops at a leaf has seen all that is nearer.
  const double enter = std::min(now.from, now.after) - slack_;
  leaves_.push_back({static_cast<std::uint32_t>(~now.link), std::max(0.0, enter)});
}

bool LeafWay::Reach(std::size_t count) {
  while (leaves_.size() < count && count_ > 0) FindNext();
  return leaves_.size() >= count;
}

}  // namespace stipple::raytracer
