// SPDX-License-Identifier: MIT
#include "raytracer/scene/view.h"

#include <numbers>

#include "raytracer/geometry/convert.h"

namespace stipple::raytracer {

template <class Real>
Camera<Real>::Camera(const View& view, ImageSize raster) : from_(Converted<Real>(view.from)) {
  const Vec<Wide> forward = Normalized(Converted<Wide>(view.at) - Converted<Wide>(view.from));
  const Vec<Wide> right = Normalized(Cross(forward, Converted<Wide>(view.up)));
  const Vec<Wide> down = Cross(forward, right);
  const Wide half_height =
      std::tan(static_cast<Wide>(view.angle_deg) * std::numbers::pi_v<Wide> / 360);
  const Wide pitch =
      raster.height > 1 ? 2 * half_height / static_cast<Wide>(raster.height - 1) : 2 * half_height;
  const Vec<Wide> column = right * pitch, row = down * pitch;
  right_ = Rounded(column);
  down_ = Rounded(row);
  corner_ = Rounded(forward - column * (static_cast<Wide>(raster.width - 1) / 2) -
                    row * (static_cast<Wide>(raster.height - 1) / 2));
}

template <class Real>
Ray<Real> Camera<Real>::RayThrough(Real x, Real y) const {
  return {from_, Normalized(corner_ + right_ * x + down_ * y)};
}

template class Camera<float>;
template class Camera<double>;
template class Camera<long double>;

}  // namespace stipple::raytracer
