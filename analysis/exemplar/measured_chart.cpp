// SPDX-License-Identifier: MIT
#include "analysis/exemplar/measured_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <vector>

#include "analysis/trace/input_error.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

/// What must be there, so that drawing need not ask.
constexpr std::string_view kColumns[] = {"panel", "series", "label", "recommended"};

/// Columns that are text even where it looks like a number.
bool IsText(std::string_view column) {
  return column == "panel" || column == "series" || column == "label";
}

std::vector<std::string> FieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char letter : line)
    if (letter == ',')
      fields.emplace_back();
    else
      fields.back() += letter;
  return fields;
}

std::string Stripped(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == text.npos ? "" : text.substr(begin);
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), in_(path) {
    if (!in_) throw InputError(path, "cannot be read");
    chart_.name = std::filesystem::path(path).stem().string();
  }

  MeasuredChart Read() {
    for (std::string line; std::getline(in_, line);) {
      ++line_;
      if (line.starts_with('#'))
        ReadKey(line);
      else if (chart_.table.columns.empty())
        ReadColumns(line);
      else if (!line.empty())
        ReadRow(line);
    }
    Check();
    return std::move(chart_);
  }

 private:
  [[noreturn]] void Fail(std::string_view problem) const {
    throw InputError(fmt::format("{}:{}", path_, line_), problem);
  }

  /// "# key: value"; unknown keys are for others.
  void ReadKey(const std::string& line) {
    const std::size_t colon = line.find(':');
    if (colon == line.npos) Fail("expected '# key: value'");
    const std::string key = Stripped(line.substr(1, colon - 1));
    const std::string value = Stripped(line.substr(colon + 1));
    if (key == "title") chart_.title = value;
    if (key == "sentence") chart_.sentence = value;
    if (key == "effort") chart_.effort = value;
    if (key == "kind") chart_.kind = value;
    if (key == "quiet") chart_.quiet = value;
    if (key == "x") chart_.x = AxisOf(value);
    if (key == "y") chart_.y = AxisOf(value);
    if (key == "value") chart_.value = AxisOf(value);
  }

  MeasuredAxis AxisOf(const std::string& value) const {
    const std::size_t comma = value.find(',');
    if (comma == value.npos) Fail("expected 'column, title of the axis'");
    return {value.substr(0, comma), Stripped(value.substr(comma + 1))};
  }

  void ReadColumns(const std::string& line) {
    for (const std::string& name : FieldsOf(line)) chart_.table.columns.push_back({name});
    for (const std::string_view name : kColumns)
      if (!ColumnNamed(chart_.table, name)) Fail(fmt::format("there is no column '{}'", name));
  }

  void ReadRow(const std::string& line) {
    const std::vector<std::string> fields = FieldsOf(line);
    const std::vector<Column>& columns = chart_.table.columns;
    if (fields.size() != columns.size())
      Fail(fmt::format("{} fields, but {} columns", fields.size(), columns.size()));
    std::vector<Cell>& row = chart_.table.rows.emplace_back();
    for (std::size_t i = 0; i < fields.size(); ++i)
      row.push_back(CellFrom(columns[i].name, fields[i]));
  }

  Cell CellFrom(const std::string& column, const std::string& field) const {
    if (IsText(column)) return field;
    if (field.empty()) return {};
    double number = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (error != std::errc() || end != field.data() + field.size())
      Fail(fmt::format("column {}: '{}' is no number", column, field));
    return number;
  }

  void Check() const {
    if (chart_.kind != "xy" && chart_.kind != "map")
      Fail(fmt::format("kind '{}' is not known; there are xy and map", chart_.kind));
    if (chart_.table.rows.empty()) Fail("there are no points");
    std::vector<const MeasuredAxis*> axes{&chart_.x, &chart_.y};
    if (chart_.kind == "map") axes.push_back(&chart_.value);
    for (const MeasuredAxis* axis : axes)
      if (!ColumnNamed(chart_.table, axis->column))
        Fail(fmt::format("an axis shows '{}', which is no column", axis->column));
  }

  const std::string& path_;
  std::ifstream in_;
  std::size_t line_ = 0;
  MeasuredChart chart_;
};

}  // namespace

MeasuredChart ReadMeasuredChart(const std::string& path) { return Reader(path).Read(); }

}  // namespace stipple
