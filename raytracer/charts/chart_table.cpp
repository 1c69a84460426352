// SPDX-License-Identifier: MIT
#include "raytracer/charts/chart_table.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

std::string Figure(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string Seconds(double value) { return std::isnan(value) ? "" : fmt::format("{:.4g}", value); }

void AddAxis(std::string& text, std::string_view name, const ChartAxis& axis) {
  if (!axis.column.empty()) text += fmt::format("# {}: {}, {}\n", name, axis.column, axis.title);
}

}  // namespace

std::string CsvOf(const ChartTable& table) {
  std::string text = fmt::format("# title: {}\n# sentence: {}\n# effort: {}\n# kind: {}\n",
                                 table.title, table.sentence, table.effort, table.kind);
  if (!table.quiet.empty()) text += fmt::format("# quiet: {}\n", table.quiet);
  AddAxis(text, "x", table.x);
  AddAxis(text, "y", table.y);
  AddAxis(text, "value", table.value);
  text += "panel,series,label,cpu_s,error,recommended";
  for (const std::string_view column : table.more_columns) text += fmt::format(",{}", column);
  text += '\n';
  for (const ChartPoint& point : table.points) {
    text += fmt::format("{},{},{},{},{},{}", point.panel, point.series, point.label,
                        Seconds(point.cpu_s), Figure(point.error), point.recommended ? 1 : 0);
    for (const double figure : point.more) text += ',' + Figure(figure);
    text += '\n';
  }
  return text;
}

void WriteCsv(const ChartTable& table, const std::string& folder) {
  const std::string path = folder + '/' + table.name + ".csv";
  std::ofstream file(path, std::ios::binary);
  file << CsvOf(table);
  file.close();
  if (!file) throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace stipple::raytracer
