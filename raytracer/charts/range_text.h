// SPDX-License-Identifier: MIT
// Figures of several scenes as the charts' sentences say them.
#ifndef STIPPLE_RAYTRACER_CHARTS_RANGE_TEXT_H
#define STIPPLE_RAYTRACER_CHARTS_RANGE_TEXT_H

#include <span>
#include <string>

namespace stipple::raytracer {

/// Two digits: "0.29", "3.1", "41".
std::string ShortNumber(double value);

/// "0.29 to 0.33", or one number where both read the same.
std::string RangeText(std::span<const double> values);

struct CostAndError {
  double cpu_s, error;
};

/// The time at which a curve comes down to `error`: on straight lines between its points, in
/// logarithms, and beyond its ends along the first or last of them. The curve has two points or
/// more, in the order of their cost.
double CostAtError(std::span<const CostAndError> curve, double error);

}  // namespace stipple::raytracer

#endif
