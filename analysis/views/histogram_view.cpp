// SPDX-License-Identifier: MIT
// Histograms: upright bars over classes of sizes, or over kinds such as message tags; a panel for
// each value.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/views/fits.h"
#include "analysis/views/label_room.h"
#include "analysis/views/layout.h"
#include "analysis/views/palette.h"
#include "analysis/views/table_access.h"
#include "analysis/views/table_reading.h"
#include "analysis/views/text.h"
#include "analysis/views/value_axis.h"
#include "analysis/views/view_list.h"

namespace stipple {
namespace {

constexpr double kWidth = 760, kPanelHeight = 170, kPanelGap = 64, kHeading = 34, kBelow = 24;
constexpr std::size_t kMostBars = 64, kMostPanels = 8;

/// Ends of classes are powers of two mostly: "64 B", "4 KiB".
std::string SizeText(double bytes) {
  constexpr const char* kUnits[] = {"KiB", "MiB", "GiB", "TiB"};
  double size = bytes / 1024;
  for (const char* unit : kUnits) {
    if (size < 1 || size != std::floor(size)) break;
    if (size < 1024) return fmt::format("{:.0f} {}", size, unit);
    size /= 1024;
  }
  return ValueText(Quantity::kBytes, bytes);
}

/// One upright bar: where its class ends, or its name.
struct Bin {
  double low = 0, high = 0;
  std::string name{};
  double value = 0;
};

struct Panel {
  std::string heading{};
  Quantity quantity = Quantity::kCount;
  bool classes = true;  // else kinds
  std::vector<Bin> bins{};
  std::string left_out{};
};

double Sum(double a, double b) { return std::clamp(a + (std::isfinite(b) ? b : 0), -1e300, 1e300); }

/// Rows with the same class or kind are one bin: a table by rank becomes the whole.
std::vector<Bin> BinsOf(const Table& table, const TableColumns& columns, std::size_t value) {
  std::vector<Bin> bins;
  std::map<std::string, std::size_t> place;
  for (const std::vector<Cell>& row : table.rows) {
    Bin bin;
    if (columns.IsHistogram()) {
      bin.low = NumberOr(row[*columns.low]);
      bin.high = NumberOr(row[*columns.high]);
      if (!std::isfinite(bin.low)) continue;
      if (!std::isfinite(bin.high)) bin.high = bin.low;
      bin.name = fmt::format("{}", bin.low);
    } else {
      bin.name = RowName(table, row, columns);
    }
    const auto [found, is_new] = place.try_emplace(bin.name, bins.size());
    if (is_new) bins.push_back(bin);
    bins[found->second].value = Sum(bins[found->second].value, NumberOr(row[value]));
  }
  if (columns.IsHistogram()) std::ranges::stable_sort(bins, {}, &Bin::low);
  return bins;
}

/// Beyond kMostBars: neighbouring classes are one; of kinds only the largest are shown.
void Limit(Panel& panel) {
  if (panel.bins.size() <= kMostBars) return;
  const std::size_t count = panel.bins.size();
  if (!panel.classes) {
    std::ranges::stable_sort(panel.bins, std::ranges::greater{}, &Bin::value);
    panel.bins.resize(kMostBars);
    panel.left_out = fmt::format("the largest {} of {}", kMostBars, count);
    return;
  }
  const std::size_t each = (count + kMostBars - 1) / kMostBars;
  std::vector<Bin> merged;
  for (std::size_t i = 0; i < count; i += each) {
    Bin bin = panel.bins[i];
    for (std::size_t k = i + 1; k < std::min(count, i + each); ++k) {
      bin.value = Sum(bin.value, panel.bins[k].value);
      bin.high = panel.bins[k].high;
    }
    merged.push_back(bin);
  }
  panel.bins = std::move(merged);
}

/// What tells bars apart: "sizes" have one for each size.
std::string AxisWords(const Table& table, const TableColumns& columns) {
  std::string words = WordsFor(columns.IsHistogram() ? table.name : table.columns.front().name);
  if (columns.IsHistogram() && words.ends_with('s')) words.pop_back();
  return words;
}

std::vector<Panel> PanelsOf(const ViewInput& input) {
  std::vector<Panel> panels;
  for (const Table* table : input.tables) {
    if (table == nullptr || !FitsHistogram(*table)) continue;
    const TableColumns columns = ColumnsOf(*table);
    for (const std::size_t value : ChosenValues(*table, columns, input.columns)) {
      if (panels.size() == kMostPanels) return panels;
      const std::string& name = table->columns[value].name;
      Panel panel{WordsFor(name) + " by " + AxisWords(*table, columns),
                  QuantityOf(name),
                  columns.IsHistogram(),
                  BinsOf(*table, columns, value),
                  {}};
      Limit(panel);
      if (!panel.bins.empty()) panels.push_back(std::move(panel));
    }
  }
  return panels;
}

struct PanelPlace {
  ValueAxis axis;
  double left = 0, top = 0, pitch = 0;

  double Bottom() const { return top + kPanelHeight; }
  double YOf(double value) const { return Bottom() - axis.ShareOf(value) * kPanelHeight; }
  double XOf(std::size_t bin) const { return left + static_cast<double>(bin) * pitch; }
};

/// Edges of classes at the edges of their bars, kinds in the middle; thinned.
void AddNames(const PanelPlace& place, const Panel& panel, Layer& layer) {
  TextRoom room({0, 0, kWidth, 1e9});
  const auto add = [&](double x, const std::string& text) {
    const double half = TextWidth(text, 12) / 2;
    TextShape shape{std::clamp(x, half, kWidth - half),
                    place.Bottom() + 14,
                    text,
                    {.size = 12, .colour = kSecondary, .anchor = Anchor::kMiddle}};
    if (room.Take(shape, 6)) layer.shapes.emplace_back(std::move(shape));
  };
  const auto text_of = [&](const Bin& bin) {
    if (panel.classes) return SizeText(bin.low);
    return ShortenEnd(bin.name, std::max(60.0, place.pitch - 8), 12);
  };
  double widest = 0;
  for (const Bin& bin : panel.bins) widest = std::max(widest, TextWidth(text_of(bin), 12) + 14);
  std::size_t step = 1;
  while (static_cast<double>(step) * place.pitch < widest && step < panel.bins.size()) step *= 2;
  for (std::size_t i = 0; i < panel.bins.size(); i += step)
    add(place.XOf(i) + (panel.classes ? 0 : place.pitch / 2), text_of(panel.bins[i]));
  if (panel.classes) add(place.XOf(panel.bins.size()), SizeText(panel.bins.back().high));
}

void AddGrid(const PanelPlace& place, const Panel& panel, Layer& layer) {
  double last = 1e9;
  for (const ValueTick& tick : place.axis.Ticks()) {
    const double y = std::floor(place.YOf(tick.value)) + 0.5;
    layer.shapes.emplace_back(LineShape{
        {{place.left, y}, {kWidth, y}}, tick.value == 0 ? kHairline : kGrid, 1, false, 1});
    if (last - y < 15) continue;
    last = y;
    layer.shapes.emplace_back(
        TextShape{place.left - 10,
                  y,
                  tick.label,
                  {.size = 12, .colour = kSecondary, .anchor = Anchor::kEnd}});
  }
  const std::string heading =
      panel.heading + (panel.left_out.empty() ? "" : " (" + panel.left_out + ")");
  layer.shapes.emplace_back(
      TextShape{place.left, place.top - 24, heading, {.size = 13, .colour = kInk, .bold = true}});
}

/// A number above each bar that has room for it.
void AddBars(const PanelPlace& place, const Panel& panel, std::size_t colour, Layer& bars,
             Layer& numbers) {
  const double gap = place.pitch > 8 ? std::min(6.0, place.pitch * 0.15) : 1;
  for (std::size_t i = 0; i < panel.bins.size(); ++i) {
    const Bin& bin = panel.bins[i];
    const double zero = place.YOf(0), y = place.YOf(bin.value);
    const std::string text = ValueText(panel.quantity, bin.value);
    if (std::fabs(zero - y) >= 0.05)
      bars.shapes.emplace_back(
          RectShape{place.XOf(i) + gap / 2, std::min(y, zero), place.pitch - gap,
                    std::fabs(zero - y), ColoursOf("", colour).area,
                    (panel.classes ? SizeText(bin.low) + "\u2013" + SizeText(bin.high) : bin.name) +
                        ": " + text});
    if (bin.value == 0 || TextWidth(text, 11) + 4 > place.pitch) continue;
    numbers.shapes.emplace_back(TextShape{place.XOf(i) + place.pitch / 2,
                                          std::min(y, zero) - 8,
                                          text,
                                          {.size = 11, .colour = kInk, .anchor = Anchor::kMiddle}});
  }
}

}  // namespace

bool FitsHistogram(const Table& table) {
  if (table.shape != TableShape::kRows) return false;
  const TableColumns columns = ColumnsOf(table);
  const bool kinds = ColumnNamed(table, "tag") == std::size_t{0} && !columns.values.empty();
  return columns.IsHistogram() || kinds;
}

Scene HistogramView(const ViewInput& input) {
  Scene scene{.name = "histogram", .width = kWidth};
  const std::vector<Panel> panels = PanelsOf(input);
  if (panels.empty()) return scene;
  std::vector<ValueAxis> axes;
  double left = 48;
  for (const Panel& panel : panels) {
    ValueRange range;
    for (const Bin& bin : panel.bins) range.Add(bin.value);
    axes.push_back(AxisFor(range, panel.quantity, 4));
    for (const ValueTick& tick : axes.back().Ticks())
      left = std::max(left, std::ceil(TextWidth(tick.label, 12) + 12));
  }
  Layer grid{"grid", {}}, bars{"bars", {}}, numbers{"letters", {}}, names{"labels", {}};
  double top = kHeading;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto count = static_cast<double>(panels[i].bins.size());
    const double room = std::min(kWidth - left, count * 90);
    const PanelPlace place{axes[i], left, top, room / count};
    AddGrid(place, panels[i], grid);
    AddBars(place, panels[i], i, bars, numbers);
    AddNames(place, panels[i], names);
    scene.description += (i == 0 ? "" : "; ") + panels[i].heading;
    top += kPanelHeight + kPanelGap;
  }
  scene.height = std::ceil(top - kPanelGap + kBelow);
  scene.title = "Histogram of " + WordsFor(input.tables.front()->name);
  scene.description = "Histograms: " + scene.description + ".";
  scene.layers = {std::move(grid), std::move(bars), std::move(numbers), std::move(names)};
  return scene;
}

}  // namespace stipple
