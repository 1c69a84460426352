// SPDX-License-Identifier: MIT
#include "raytracer/scene/limit.h"

#include <cmath>
#include <limits>

namespace stipple::raytracer {
namespace {

double SizeForLimit(const Shapes& shapes, const Object& object) {
  if (object.kind != ShapeKind::kSphere) return std::numeric_limits<double>::infinity();
  return std::abs(shapes.spheres[object.index].radius);
}

}  // namespace

void SizesSeen::See(const Shapes& shapes) {
  for (const Object& object : shapes.objects) {
    ++of_size_[SizeForLimit(shapes, object)];
    ++seen_;
  }
  // What is smaller than `limit` others is of no account any more.
  while (!of_size_.empty() && seen_ - of_size_.begin()->second >= limit_) {
    seen_ -= of_size_.begin()->second;
    of_size_.erase(of_size_.begin());
  }
}

LargestOnly SizesSeen::Largest() const {
  if (seen_ < limit_) return {-1, 0};
  const auto& [smallest, of_smallest] = *of_size_.begin();
  return {smallest, limit_ - (seen_ - of_smallest)};
}

bool LargestOnly::Keeps(const Shapes& shapes, const Object& object) {
  const double size = SizeForLimit(shapes, object);
  if (size != smallest) return size > smallest;
  if (of_smallest == 0) return false;
  --of_smallest;
  return true;
}

}  // namespace stipple::raytracer
