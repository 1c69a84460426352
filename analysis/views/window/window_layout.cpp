// SPDX-License-Identifier: MIT
#include "analysis/views/window/window_layout.h"

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

constexpr double kHeaderHeight = 58;
constexpr double kOverviewHeight = 30;
constexpr double kOverviewAxis = 26;
constexpr double kSideWidth = 264;
constexpr double kLeastWidthWithSide = 760;
constexpr double kCurveHeight = 60;
constexpr double kLeastTimeline = 150;
constexpr double kLeastDisplayWidth = 150;
constexpr double kGap = 10;

double DisplayHeight(double height) { return std::clamp(std::floor(height * 0.21), 140.0, 260.0); }

std::vector<Panel> ShownOf(const ViewState& state, bool curves) {
  std::vector<Panel> shown;
  for (std::size_t i = 0; i < kPanelCount; ++i) {
    const auto panel = static_cast<Panel>(i);
    const bool is_curve = panel == Panel::kUtilisation || panel == Panel::kLoad;
    if (is_curve == curves && state.Shows(panel)) shown.push_back(panel);
  }
  return shown;
}

}  // namespace

WindowLayout LayOut(double width, double height, const ViewState& state) {
  WindowLayout layout;
  layout.width = std::max(width, kLeastWindowWidth);
  layout.height = std::max(height, kLeastWindowHeight);
  const double left = kWindowMargin;
  double right = layout.width - kWindowMargin;
  layout.header = {left, 0, right - left, kHeaderHeight};
  if (layout.width >= kLeastWidthWithSide) {
    layout.side = {right - kSideWidth, kHeaderHeight, kSideWidth,
                   layout.height - kHeaderHeight - kWindowMargin};
    right = layout.side.left - kWindowMargin - 6;
  }
  const double wide = right - left;
  layout.overview = {left, kHeaderHeight, wide, kOverviewHeight};
  const double top = layout.overview.bottom() + kOverviewAxis + kTitleHeight;
  double room = layout.height - kWindowMargin / 2 - top - kLeastTimeline;
  double bottom = layout.height - kWindowMargin / 2;
  std::vector<Panel> curves = ShownOf(state, true);
  while (!curves.empty() &&
         static_cast<double>(curves.size()) * (kCurveHeight + kTitleHeight) > room)
    curves.pop_back();
  room -= static_cast<double>(curves.size()) * (kCurveHeight + kTitleHeight);
  std::vector<Panel> displays = ShownOf(state, false);
  const double tall = DisplayHeight(layout.height);
  const auto fit = static_cast<std::size_t>((wide + kGap) / (kLeastDisplayWidth + kGap));
  if (displays.size() > fit) displays.resize(fit);
  if (!displays.empty() && tall + kTitleHeight + kGap <= room) {
    bottom -= tall;
    const auto count = static_cast<double>(displays.size());
    const double each = (wide - (count - 1) * kGap) / count;
    for (std::size_t i = 0; i < displays.size(); ++i)
      layout.displays.push_back(
          {displays[i], {left + static_cast<double>(i) * (each + kGap), bottom, each, tall}});
    bottom -= kTitleHeight;
  }
  for (auto panel = curves.rbegin(); panel != curves.rend(); ++panel) {
    bottom -= kCurveHeight;
    layout.curves.insert(layout.curves.begin(), {*panel, {left, bottom, wide, kCurveHeight}});
    bottom -= kTitleHeight;
  }
  layout.timeline = {left, top, wide, std::max(40.0, bottom - kGap / 2 - top)};
  return layout;
}

}  // namespace stipple
