// SPDX-License-Identifier: MIT
#include "raytracer/scene/view.h"

#include <numbers>

#include "raytracer/geometry/convert.h"

namespace stipple::raytracer {

template <class Real>
Camera<Real>::Camera(const View& view, ImageSize raster) : from_(Converted<Real>(view.from)) {
  const Vec<Real> forward = Normalized(Converted<Real>(view.at) - from_);
  const Vec<Real> right = Normalized(Cross(forward, Converted<Real>(view.up)));
  const Vec<Real> down = Cross(forward, right);
  const Real half_height =
      std::tan(static_cast<Real>(view.angle_deg) * std::numbers::pi_v<Real> / 360);
  const Real pitch =
      raster.height > 1 ? 2 * half_height / static_cast<Real>(raster.height - 1) : 2 * half_height;
  right_ = right * pitch;
  down_ = down * pitch;
  corner_ = forward - right_ * (static_cast<Real>(raster.width - 1) / 2) -
            down_ * (static_cast<Real>(raster.height - 1) / 2);
}

template <class Real>
Ray<Real> Camera<Real>::RayThrough(Real x, Real y) const {
  return {from_, Normalized(corner_ + right_ * x + down_ * y)};
}

template class Camera<float>;
template class Camera<double>;
template class Camera<long double>;

}  // namespace stipple::raytracer
