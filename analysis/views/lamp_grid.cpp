// SPDX-License-Identifier: MIT
#include "analysis/views/lamp_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/views/label_room.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostNamed = 40;  // ranks with name and text
constexpr std::size_t kMostTooltips = 1024;
constexpr std::size_t kMostLamps = 16384;  // beyond that there are no more pixels

struct LampLayout {
  double left = 0, pitch_x = 0, pitch_y = 0, side = 0;
  std::size_t across = 1;
  bool named = false;

  Point At(std::size_t i) const {
    return {left + static_cast<double>(i % across) * pitch_x,
            static_cast<double>(i / across) * pitch_y};
  }
};

LampLayout LayoutOf(std::span<const TimelineRow> ranks, double first_names) {
  LampLayout layout;
  const std::size_t count = ranks.size();
  layout.named = count <= kMostNamed;
  if (layout.named) {
    layout.across = std::min<std::size_t>(count, 10);
    layout.pitch_x = 108;
    layout.side = 56;
    layout.pitch_y = layout.side + 50;
    return layout;
  }
  // Rows of powers of two, so that a rank's place can be counted.
  layout.left = std::ceil(first_names) + 12;
  layout.across = count <= 256 ? 32 : 64;
  layout.pitch_x = layout.pitch_y = layout.across == 32 ? 28 : 15;
  if (count > 4096) layout.across = 128, layout.pitch_x = layout.pitch_y = 7;
  layout.side = layout.pitch_x - (layout.pitch_x > 8 ? 3 : 1);
  return layout;
}

void AddNamed(const LampLayout& layout, std::span<const TimelineRow> ranks,
              std::span<const Lamp> lamps, int culprit, Layer& layer) {
  const bool host = HasHost(ranks);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const Point at = layout.At(i);
    const double x = at.x + layout.pitch_x / 2;
    const bool marked = ranks[i].rank >= 0 && ranks[i].rank == culprit;
    layer.shapes.emplace_back(
        TextShape{x,
                  at.y + layout.side + 12,
                  ShortenEnd(RowLabel(ranks[i], host), layout.pitch_x - 6, 13 * 1.12),
                  {.size = 13,
                   .colour = marked ? kAccent : kInk,
                   .bold = marked,
                   .anchor = Anchor::kMiddle}});
    layer.shapes.emplace_back(
        TextShape{x,
                  at.y + layout.side + 29,
                  ShortenEnd(lamps[i].text, layout.pitch_x - 6, 11),
                  {.size = 11, .colour = kSecondary, .anchor = Anchor::kMiddle}});
  }
}

/// The first rank's name at the left of every row that has room for it.
void AddFirstNames(const LampLayout& layout, std::span<const TimelineRow> ranks, Layer& layer) {
  const std::size_t step = layout.pitch_y < 14 ? static_cast<std::size_t>(16 / layout.pitch_y) : 1;
  for (std::size_t i = 0; i < ranks.size(); i += layout.across * step)
    layer.shapes.emplace_back(TextShape{layout.left - 10,
                                        layout.At(i).y + layout.side / 2,
                                        ranks[i].name,
                                        {.size = 12, .colour = kInk, .anchor = Anchor::kEnd}});
}

}  // namespace

void AddLampGrid(Scene& scene, const ViewInput& input, std::span<const TimelineRow> ranks,
                 std::span<const Lamp> lamps) {
  if (ranks.size() > kMostLamps) {
    scene.note = fmt::format("the first {} of {} ranks", kMostLamps, ranks.size());
    ranks = ranks.first(kMostLamps);
  }
  double widest = 0;
  for (const TimelineRow& row : ranks) widest = std::max(widest, TextWidth(row.name, 12));
  const LampLayout layout = LayoutOf(ranks, widest);
  const bool host = HasHost(ranks);
  Layer squares{"bars", {}}, texts{"labels", {}};
  const double inset = layout.named ? (layout.pitch_x - layout.side) / 2 : 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const Point at = layout.At(i);
    RectShape square{at.x + inset, at.y, layout.side, layout.side, lamps[i].colour, {}};
    if (ranks.size() <= kMostTooltips)
      square.tooltip = RowLabel(ranks[i], host) + ": " + lamps[i].text;
    // A thin frame, so that pale squares are squares.
    if (layout.side > 8)
      squares.shapes.emplace_back(
          RectShape{square.x - 1, square.y, square.width + 2, square.height + 1, kHairline, {}});
    squares.shapes.emplace_back(std::move(square));
  }
  if (layout.named)
    AddNamed(layout, ranks, lamps, CulpritOf(input), texts);
  else
    AddFirstNames(layout, ranks, texts);
  const std::size_t down = (ranks.size() + layout.across - 1) / layout.across;
  scene.width = std::ceil(layout.left + static_cast<double>(layout.across) * layout.pitch_x);
  scene.height = std::ceil(static_cast<double>(down) * layout.pitch_y);
  scene.layers = {std::move(squares), std::move(texts)};
}

void AddNamesBelow(Layer& layer, const RankTable& table, double y, int culprit,
                   const std::function<double(std::size_t)>& x_of) {
  TextRoom room({-1e9, -1e9, 1e9, 1e9});
  const std::size_t count = table.ranks.size();
  const auto text_of = [&](std::size_t i) {
    const TimelineRow& row = table.ranks[i];
    const bool marked = row.rank >= 0 && row.rank == culprit;
    return TextShape{
        x_of(i),
        y,
        ShortenEnd(row.name, 90, 12),
        {.size = 12, .colour = marked ? kAccent : kInk, .bold = marked, .anchor = Anchor::kMiddle}};
  };
  const auto add = [&](std::size_t i) {
    TextShape text = text_of(i);
    if (room.Take(text, 5)) layer.shapes.emplace_back(std::move(text));
  };
  const auto important = [&](std::size_t i) {
    return table.ranks[i].is_host || (table.ranks[i].rank >= 0 && table.ranks[i].rank == culprit);
  };
  double widest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (important(i)) add(i);
    widest = std::max(widest, TextWidth(text_of(i).text, 12) + 6);
  }
  std::size_t step = 1;
  while (count > 1 && step < count && static_cast<double>(step) * (x_of(1) - x_of(0)) < widest)
    step *= 2;
  for (std::size_t i = 0; i < count; i += step)
    if (!important(i)) add(i);
}

}  // namespace stipple
