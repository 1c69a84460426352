// SPDX-License-Identifier: MIT
// Where rays start that leave a surface: rules for it, over the size of things and their distance
// from the origin. Acne: the ray meets its own surface; a leak: it jumps over a wall before it.
#include <fmt/format.h>

#include <algorithm>

#include "raytracer/charts/chart_list.h"
#include "raytracer/charts/range_text.h"
#include "raytracer/charts/trials/offset_trial.h"

namespace stipple::raytracer {
namespace {

constexpr std::string_view kPrecision = "double", kRule = "relative";  // what is shipped

void AddPanel(const std::vector<OffsetRow>& rows, std::string_view precision, std::string_view rule,
              std::string_view rate, double OffsetRates::*part, ChartTable& table) {
  const std::string series = fmt::format("{} {}", precision, rule);
  for (const OffsetRow& row : rows)
    if (row.precision == precision && row.rule == rule)
      table.points.push_back({fmt::format("{}: {}", series, rate),
                              series,
                              std::string(rate),
                              kNotMeasured,
                              row.rates.*part,
                              precision == kPrecision && rule == kRule,
                              {row.size, row.distance}});
}

double WorstOf(const std::vector<OffsetRow>& rows, std::string_view precision,
               std::string_view rule) {
  double worst = 0;
  for (const OffsetRow& row : rows)
    if (row.precision == precision && row.rule == rule)
      worst = std::max({worst, row.rates.acne, row.rates.leak});
  return worst;
}

/// Larger sizes on top.
std::vector<OffsetRow> Measured(const Session& session) {
  constexpr int kRays = 20000, kQuickRays = 400;
  std::vector<OffsetRow> rows = OffsetMap(session.quick ? kQuickRays : kRays);
  std::ranges::stable_sort(rows, std::greater(), &OffsetRow::size);
  return rows;
}

}  // namespace

ChartTable OffsetsChart(Session& session) {
  ChartTable table{.name = "offsets", .title = "Where rays start that leave a surface"};
  table.kind = "map";
  table.x = {"distance", "distance from the origin, in sizes"};
  table.y = {"size", "size of the thing"};
  table.value = {"error", "share of rays that go wrong, %"};
  table.more_columns = {"size", "distance"};
  const std::vector<OffsetRow> rows = Measured(session);
  for (const std::string_view rule : {"relative", "none", "fixed", "integer"})
    for (const std::string_view precision : {"double", "float"}) {
      AddPanel(rows, precision, rule, "acne", &OffsetRates::acne, table);
      AddPanel(rows, precision, rule, "leak", &OffsetRates::leak, table);
    }
  table.sentence = fmt::format(
      "Take the offset relative to the numbers at hand, in double: at worst {} % of the rays go "
      "wrong; in float {} %, with a fixed offset in double {} %, with none {} %.",
      ShortNumber(100 * WorstOf(rows, "double", "relative")),
      ShortNumber(100 * WorstOf(rows, "float", "relative")),
      ShortNumber(100 * WorstOf(rows, "double", "fixed")),
      ShortNumber(100 * WorstOf(rows, "double", "none")));
  return table;
}

}  // namespace stipple::raytracer
