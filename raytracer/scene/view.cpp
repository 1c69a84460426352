// SPDX-License-Identifier: MIT
#include "raytracer/scene/view.h"

#include <numbers>

namespace stipple::raytracer {

Camera::Camera(const View& view, ImageSize raster) : from_(view.from) {
  const Vec3 forward = Normalized(view.at - view.from);
  const Vec3 right = Normalized(Cross(forward, view.up));
  const Vec3 down = Cross(forward, right);
  const double half_height = std::tan(view.angle_deg * std::numbers::pi / 360);
  const double pitch = raster.height > 1 ? 2 * half_height / (raster.height - 1) : 2 * half_height;
  right_ = right * pitch;
  down_ = down * pitch;
  corner_ = forward - right_ * (0.5 * (raster.width - 1)) - down_ * (0.5 * (raster.height - 1));
}

Ray Camera::RayThrough(double x, double y) const {
  return {from_, Normalized(corner_ + right_ * x + down_ * y)};
}

}  // namespace stipple::raytracer
