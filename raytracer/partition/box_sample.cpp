// SPDX-License-Identifier: MIT
#include "raytracer/partition/box_sample.h"

#include <algorithm>

namespace stipple::raytracer {
namespace {

/// Numbers that are near each other have bits that have nothing to do with each other (SplitMix64).
std::uint64_t Mixed(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15;
  number = (number ^ number >> 30) * 0xbf58476d1ce4e5b9;
  number = (number ^ number >> 27) * 0x94d049bb133111eb;
  return number ^ number >> 31;
}

}  // namespace

std::size_t BoxSample::MostFor(std::uint32_t leaves) {
  constexpr std::size_t kLeast = 4096, kForEachLeaf = 1024;
  return std::max(kLeast, kForEachLeaf * leaves);
}

std::uint64_t BoxSample::BytesFor(std::uint32_t leaves, std::uint64_t objects) {
  // The tree's numbers twice, and the middles that a plane is found from.
  constexpr std::uint64_t kEach = sizeof(Bounds) + 3 * sizeof(std::uint32_t) + sizeof(double);
  return kEach * std::min<std::uint64_t>(objects, MostFor(leaves));
}

bool BoxSample::Takes(std::uint32_t number) const {
  return (Mixed(number) & ((std::uint64_t{1} << halvings_) - 1)) == 0;
}

void BoxSample::See(const Bounds& box, std::uint32_t number) {
  scene_.Include(box);
  if (!Takes(number)) return;
  if (boxes_.capacity() < most_) boxes_.reserve(most_), numbers_.reserve(most_);
  while (boxes_.size() == most_) {
    ++halvings_;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!Takes(numbers_[i])) continue;
      boxes_[kept] = boxes_[i];
      numbers_[kept++] = numbers_[i];
    }
    boxes_.resize(kept);
    numbers_.resize(kept);
  }
  if (!Takes(number)) return;
  boxes_.push_back(box);
  numbers_.push_back(number);
}

}  // namespace stipple::raytracer
