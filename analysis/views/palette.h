// SPDX-License-Identifier: MIT
// The colours of every view. States differ in lightness (47, 74, 28, 93), so they survive grey
// print and colour blindness; the accent is for the culprit and for losses only.
#ifndef STIPPLE_ANALYSIS_VIEWS_PALETTE_H
#define STIPPLE_ANALYSIS_VIEWS_PALETTE_H

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/stats/timeline.h"
#include "analysis/views/scene.h"

namespace stipple {

inline constexpr Colour kInk{0x1f, 0x29, 0x33};
inline constexpr Colour kSecondary{0x66, 0x72, 0x7f};
inline constexpr Colour kGrid{0xe3, 0xe7, 0xeb};
inline constexpr Colour kHairline{0xb8, 0xc1, 0xca};
inline constexpr Colour kAccent{0xb4, 0x23, 0x18};
inline constexpr Colour kQuietBar{0xc2, 0xc9, 0xd3};  // bars of those who are not the culprit
inline constexpr Colour kBand{0xc9, 0xdc, 0xef};      // least to most
inline constexpr Colour kLoadFill{0xfa, 0xe0, 0xb4};  // under the message-load line
inline constexpr Colour kLoadLine{0xb8, 0x77, 0x0a};
inline constexpr Colour kTeal{0x1f, 0x7a, 0x70};      // the fourth series of a chart
inline constexpr Colour kUserText{0x2f, 0x66, 0xa8};  // state colour, dark enough for text
inline constexpr Colour kWhite{0xff, 0xff, 0xff};
inline constexpr Colour kEmptyCell{0xfe, 0xfe, 0xfe};
inline constexpr Colour kOnPale{0x1f, 0x29,
                                0x34};  // number in a pale cell; unlike kInk in dark mode
inline constexpr Colour kOnDeep{0xff, 0xff, 0xfe};  // number in a deep cell

/// Indexed by State.
inline constexpr Colour kStateColours[kStateCount] = {
    {0x36, 0x72, 0xb9}, {0x7a, 0x1f, 0x3d}, {0xf0, 0xa8, 0x30}, {0xe8, 0xeb, 0xef}};
inline constexpr const char* kStateNames[kStateCount] = {"user computation", "system",
                                                         "message transmission", "idle"};

inline constexpr Colour ColourOf(State state) {
  return kStateColours[static_cast<std::size_t>(state)];
}

/// Steps of the matrices' ramp; few enough that a style sheet can name each for dark mode.
inline constexpr int kRampSteps = 24;
/// Cells at or above this step need light numbers.
inline constexpr int kDeepStep = 14;

/// White to deep blue through the user colour; step 1..kRampSteps.
inline Colour RampColour(int step) {
  const auto mix = [](int from, int to, double share) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * share));
  };
  const double place = static_cast<double>(step) / kRampSteps;
  constexpr Colour kStops[] = {
      {0xee, 0xf4, 0xfa}, {0x9d, 0xc1, 0xe2}, {0x36, 0x72, 0xb9}, {0x08, 0x28, 0x56}};
  const double scaled = std::clamp(place, 0.0, 1.0) * 3;
  const int stop = std::min(2, static_cast<int>(scaled));
  const Colour low = kStops[stop], high = kStops[stop + 1];
  const double share = scaled - stop;
  return {mix(low.red, high.red, share), mix(low.green, high.green, share),
          mix(low.blue, high.blue, share)};
}

/// Square-root scale: small values stay distinguishable from none.
inline int RampStep(double value, double largest) {
  if (value <= 0 || largest <= 0) return 0;
  return std::clamp(static_cast<int>(std::lround(std::sqrt(value / largest) * kRampSteps)), 1,
                    kRampSteps);
}

}  // namespace stipple

#endif
