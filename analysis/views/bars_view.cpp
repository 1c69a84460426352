// SPDX-License-Identifier: MIT
// Bars per rank: the states of the whole run, aligned with the timeline's rows, and who was waited
// for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/text.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr double kBarWidth = 300;  // the percentage stands at its right

/// Mean shares of the ranks in each drawn row.
std::vector<StateShares> SharesOfGrid(const RowGrid& grid, const std::vector<StateShares>& shares) {
  std::vector<StateShares> of_rows;
  for (const GridRow& row : grid.rows) {
    StateShares mean{};
    for (std::size_t i = 0; i < row.count; ++i)
      for (std::size_t s = 0; s < kStateCount; ++s)
        mean[s] += shares[row.first + i][s] / static_cast<float>(row.count);
    of_rows.push_back(mean);
  }
  return of_rows;
}

/// Bars grow from the left: user, system, message; idle is what remains. State by state, so that
/// bars of one colour become one element.
Layer Bars(const RowGrid& grid, const std::vector<StateShares>& of_rows) {
  Layer layer{"bars", {}};
  std::vector<double> ends(of_rows.size(), 0);
  for (std::size_t s = 0; s < kStateCount; ++s)
    for (std::size_t i = 0; i < of_rows.size(); ++i) {
      const double share = std::max(0.0, static_cast<double>(of_rows[i][s]));
      const double begin = ends[i], end = std::min(begin + share * kBarWidth, kBarWidth);
      ends[i] = end;
      if (end - begin < 0.05) continue;
      layer.shapes.emplace_back(
          RectShape{begin, grid.rows[i].y, end - begin, grid.rows[i].height, kStateColours[s], {}});
    }
  return layer;
}

struct Spread {
  double mean = 0, most = 0;
};

Spread ComputingOf(const Timeline& timeline, const std::vector<StateShares>& shares) {
  Spread spread;
  double count = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (timeline.rows[i].is_host) continue;
    const auto user = static_cast<double>(shares[i][0]);
    spread.mean += user;
    spread.most = std::max(spread.most, user);
    ++count;
  }
  if (count > 0) spread.mean /= count;
  return spread;
}

/// The mean as a dotted line with its value below; at the right, how far the busiest is above it.
Layer MeanLine(const ViewInput& input, const RowGrid& grid, const Spread& spread) {
  Layer layer{"mean", {}};
  const double top = grid.rows.front().y, bottom = top + grid.height;
  const double x = std::floor(spread.mean * kBarWidth) + 0.5;
  layer.shapes.emplace_back(LineShape{{{x, top - 4}, {x, bottom + 8}}, kInk, 1, true, 1});
  const std::string mean = "mean " + FormatPercent(spread.mean);
  const double half = TextWidth(mean, 12) / 2, mean_x = std::max(x, half);
  layer.shapes.emplace_back(TextShape{
      mean_x, bottom + 18, mean, {.size = 12, .colour = kInk, .anchor = Anchor::kMiddle}});
  const double ratio = input.finding != nullptr && input.finding->max_over_mean > 1
                           ? input.finding->max_over_mean
                           : spread.most / std::max(spread.mean, 1e-9);
  const bool blame = CulpritOf(input) >= 0 && ratio >= 1.1;
  const std::string text = fmt::format("busiest {:.2f} \u00d7 mean", ratio);
  const bool left = mean_x + half + 12 > kSideWidth - TextWidth(text, 12, blame);
  const TextStyle style{.size = 12,
                        .colour = blame ? kAccent : kSecondary,
                        .bold = blame,
                        .anchor = left ? Anchor::kStart : Anchor::kEnd};
  layer.shapes.emplace_back(TextShape{left ? 0 : kSideWidth, bottom + 18, text, style});
  return layer;
}

constexpr double kWaitRow = 46;
constexpr std::size_t kMostWaits = 6;  // the last one may be "others"

std::vector<WaitedFor> LargestWaits(const Finding& finding) {
  std::vector<WaitedFor> waits = finding.waited_for;
  if (waits.empty()) return waits;
  // What would be written as 0 is left out.
  const double least = waits.front().seconds / 1000;
  std::erase_if(waits, [&](const WaitedFor& wait) { return wait.seconds < least; });
  if (waits.size() <= kMostWaits) return waits;
  WaitedFor others{-1, "others", 0, {}};
  for (std::size_t i = kMostWaits - 1; i < waits.size(); ++i) others.seconds += waits[i].seconds;
  waits.resize(kMostWaits - 1);
  waits.push_back(others);
  return waits;
}

std::string WaitedForLabel(const WaitedFor& wait, std::string_view noun) {
  const bool number =
      !wait.name.empty() && wait.name.find_first_not_of("0123456789") == wait.name.npos;
  return number ? fmt::format("{} {}", noun, wait.name) : CleanUtf8(wait.name);
}

/// One culprit: name, bar and time; below the bar the region it was in.
struct WaitRow {
  double bar_left, scale, unit, y;
  int decimals;
  bool culprit;

  void Add(Layer& labels, Layer& bars, const WaitedFor& wait, const std::string& label) const {
    const double middle = y + 12, width = std::max(1.0, wait.seconds * scale);
    labels.shapes.emplace_back(
        TextShape{bar_left - 10,
                  middle,
                  label,
                  {.size = 13, .colour = kInk, .bold = culprit, .anchor = Anchor::kEnd}});
    bars.shapes.emplace_back(
        RectShape{bar_left, middle - 9, width, 18, culprit ? kAccent : kQuietBar, {}});
    const std::string value = fmt::format("{:.{}f}", wait.seconds / unit, decimals);
    labels.shapes.emplace_back(
        TextShape{kSideWidth,
                  middle,
                  value,
                  {.size = 13, .colour = kInk, .bold = true, .anchor = Anchor::kEnd}});
    const std::string region = ShortenEnd(wait.region, kSideWidth - bar_left, 11);
    if (!region.empty())
      labels.shapes.emplace_back(
          TextShape{bar_left, middle + 18, region, {.size = 11, .colour = kSecondary}});
  }
};

}  // namespace

Scene StateBarsView(const ViewInput& input) {
  Scene scene{.name = "bars", .width = kSideWidth};
  const std::vector<StateShares> shares = RunShares(input);
  if (shares.empty()) return scene;
  const RowGrid grid = MainGrid(input);
  scene.height = std::ceil(grid.rows.front().y + grid.height + 6 + kAxisHeight);
  scene.title = fmt::format("States of the whole run by {}", NounFor(*input.timeline));
  scene.description =
      "One bar per rank: shares of user computation, system, message and idle time.";
  scene.note = "share computing";
  Layer values{"labels", {}};
  const std::vector<StateShares> of_rows = SharesOfGrid(grid, shares);
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    if (grid.rows[i].label.empty()) continue;
    const TextStyle style{.size = grid.label_size,
                          .colour = kInk,
                          .bold = grid.rows[i].emphasised,
                          .anchor = Anchor::kEnd};
    values.shapes.emplace_back(
        TextShape{kSideWidth, grid.middle(i), FormatPercent(of_rows[i][0]), style});
  }
  scene.layers = {Bars(grid, of_rows), std::move(values)};
  if (shares.size() > 1)
    scene.layers.push_back(MeanLine(input, grid, ComputingOf(*input.timeline, shares)));
  return scene;
}

Scene WaitedForView(const ViewInput& input) {
  Scene scene{.name = "waited-for", .width = kSideWidth};
  if (input.finding == nullptr || input.finding->waited_for.empty() || !HasRows(input.timeline))
    return scene;
  const std::string_view noun = NounFor(*input.timeline);
  const std::vector<WaitedFor> waits = LargestWaits(*input.finding);
  double largest = 0, label_width = 0;
  for (const WaitedFor& wait : waits) {
    largest = std::max(largest, wait.seconds);
    label_width = std::max(label_width, TextWidth(WaitedForLabel(wait, noun), 13, true));
  }
  if (largest <= 0) return scene;
  const Unit unit = TimeUnitFor(largest);
  const double bar_left = std::ceil(std::max(60.0, label_width + 12));
  Layer labels{"labels", {}}, bars{"bars", {}};
  double y = 0;
  for (const WaitedFor& wait : waits) {
    const bool culprit = wait.rank >= 0 && wait.rank == input.finding->culprit;
    const WaitRow row{bar_left, (kSideWidth - 64 - bar_left) / largest, unit.size,
                      y,        DecimalsFor(largest / unit.size),       culprit};
    row.Add(labels, bars, wait, WaitedForLabel(wait, noun));
    y += kWaitRow;
  }
  scene.height = y;
  scene.title = "Who was waited for";
  scene.description =
      fmt::format("Time that others spent waiting for each {}; most: {}, {}.", noun,
                  WaitedForLabel(waits.front(), noun), FormatSeconds(waits.front().seconds));
  scene.note = fmt::format("others' waiting, {}", unit.name);
  scene.layers = {std::move(bars), std::move(labels)};
  return scene;
}

}  // namespace stipple
