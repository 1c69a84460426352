// SPDX-License-Identifier: MIT
// Colours for numbers: brighter is more, for every kind of eyes and in print.
#ifndef STIPPLE_RAYTRACER_IMAGE_RAMP_H
#define STIPPLE_RAYTRACER_IMAGE_RAMP_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace stipple::raytracer {

using Rgb = std::array<std::uint8_t, 3>;

/// Viridis and the upper part of inferno, at equal steps. Source: S. van der Walt, N. Smith,
/// matplotlib, 2015.
inline constexpr Rgb kViridis[] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                   {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                   {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
inline constexpr Rgb kGlow[] = {{120, 28, 109}, {165, 44, 96}, {207, 68, 70},
                                {237, 105, 37}, {251, 155, 6}, {252, 255, 164}};

/// The colour at `t` from 0 to 1; what lies beyond counts as the end.
inline Rgb ColorAt(std::span<const Rgb> ramp, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
  const auto step = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
  const double share = place - static_cast<double>(step);
  Rgb color;
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = static_cast<std::uint8_t>(
        std::lround(ramp[step][i] * (1 - share) + ramp[step + 1][i] * share));
  return color;
}

}  // namespace stipple::raytracer

#endif
