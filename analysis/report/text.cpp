// SPDX-License-Identifier: MIT
#include "analysis/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/report/tree_text.h"
#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

/// Doubts below this part of a time are not shown in text.
constexpr double kNegligible = 0.005;

double NumberOf(const Cell& cell) {
  const double* number = std::get_if<double>(&cell);
  return number == nullptr ? 0 : *number;
}
template <class Values>
void EraseAt(Values& values, std::size_t at, std::size_t count) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(at);
  values.erase(first, first + static_cast<std::ptrdiff_t>(count));
}
template <class Values, class Value>
void InsertAt(Values& values, std::size_t at, Value value) {
  values.insert(values.begin() + static_cast<std::ptrdiff_t>(at), std::move(value));
}

template <class... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Match(Cases...) -> Match<Cases...>;  // clang 14 does not find it by itself

/// Bytes of a trace may be no UTF-8: what is none becomes U+FFFD, as in JSON.
std::string Sound(const std::string& text) {
  const auto is_plain = [](char c) { return static_cast<signed char>(c) >= 0; };
  if (std::ranges::all_of(text, is_plain)) return text;
  const std::string json = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(json).get<std::string>();
}

/// One line, and nothing that a terminal would obey.
std::string Shown(const std::string& text) {
  std::string shown = Sound(text);
  for (char& c : shown)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = ' ';
  return shown;
}

/// Characters of UTF-8.
std::size_t WidthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

/// As tools that draw flames write a path.
std::string Joined(const std::vector<std::string>& path) {
  std::string text;
  for (const std::string& name : path) text += (text.empty() ? "" : ";") + name;
  return text;
}

/// Seconds have fixed decimals; of other values nobody knows how large or small they are.
bool IsSeconds(const Column& column) {
  return column.name.ends_with("_s") && !column.name.ends_with("_per_s");
}

std::string CellText(const Cell& cell, const Column& column) {
  return std::visit(Match{[](std::monostate) { return std::string("-"); },
                          [](std::int64_t v) { return fmt::format("{}", v); },
                          [&column](double v) {
                            if (!std::isfinite(v)) return std::string("-");
                            return IsSeconds(column) ? fmt::format("{:.6f}", v)
                                                     : fmt::format("{:.6g}", v);
                          },
                          [](const std::string& v) { return Shown(v); },
                          [](const std::vector<std::string>& v) { return Shown(Joined(v)); }},
                    cell);
}

std::string CellCsv(const Cell& cell, const Column& column) {
  const auto quoted = [](const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"') out += '"';
      out += c;
    }
    out += '"';
    return out;
  };
  return std::visit(
      Match{[](std::monostate) { return std::string(); },
            [](std::int64_t v) { return fmt::format("{}", v); },
            [&column](double v) {
              if (!std::isfinite(v)) return std::string();
              return IsSeconds(column) ? fmt::format("{:.9f}", v) : fmt::format("{}", v);
            },
            [&quoted](const std::string& v) { return quoted(Sound(v)); },
            [&quoted](const std::vector<std::string>& v) { return quoted(Sound(Joined(v))); }},
      cell);
}

Json CellJson(const Cell& cell) {
  return std::visit(Match{[](std::monostate) { return Json(nullptr); },
                          [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); },
                          [](const auto& v) { return Json(v); }},
                    cell);
}

/// Bytes of a trace may be no UTF-8.
std::string Dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json MatrixJson(const Table& table) {
  Json rows = Json::array();
  Json columns = Json::array();
  Json values = Json::array();
  for (std::size_t c = 1; c < table.columns.size(); ++c) columns.push_back(table.columns[c].name);
  for (const auto& row : table.rows) {
    rows.push_back(CellJson(row.front()));
    Json line = Json::array();
    for (std::size_t c = 1; c < row.size(); ++c) line.push_back(CellJson(row[c]));
    values.push_back(std::move(line));
  }
  return {{"rows", rows}, {"columns", columns}, {"values", values}};
}

/// What is doubtful about a time in text: nothing where it is negligible.
std::string DoubtText(double value, double low, double high, double total) {
  const double doubt = std::max(high - value, value - low);
  if (!(doubt > kNegligible * value) || !(doubt > kNegligible / 10 * total)) return {};
  return fmt::format("+-{:.6f}", doubt);
}

/// People read a doubt behind a time, and only where it matters: columns X_low_s and X_high_s
/// become one behind X_s, or none.
Table WithDoubts(Table table) {
  const auto column = [&table](const std::string& name) {
    const auto found = std::ranges::find(table.columns, name, &Column::name);
    return static_cast<std::size_t>(found - table.columns.begin());
  };
  for (const std::string time : {"exclusive", "inclusive"}) {
    const std::size_t value = column(time + "_s");
    const std::size_t low = column(time + "_low_s");
    if (low + 1 >= table.columns.size()) continue;
    double total = 0;
    for (const auto& row : table.rows) total += NumberOf(row[value]);
    bool any = false;
    std::vector<std::string> doubts;
    for (auto& row : table.rows) {
      doubts.push_back(
          std::holds_alternative<std::monostate>(row[low])
              ? std::string()
              : DoubtText(NumberOf(row[value]), NumberOf(row[low]), NumberOf(row[low + 1]), total));
      any = any || !doubts.back().empty();
      EraseAt(row, low, 2);
    }
    EraseAt(table.columns, low, 2);
    if (!any) continue;
    InsertAt(table.columns, value + 1, Column{""});
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      InsertAt(table.rows[r], value + 1, Cell(doubts[r]));
  }
  return table;
}

}  // namespace

std::string TableText(const Table& full) {
  if (full.shape == TableShape::kTree) return TreeText(full);
  const Table table = WithDoubts(full);
  std::vector<std::size_t> widths;
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& c : table.columns) lines.front().push_back(c.name);
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) {
      // Full names, with all parameters, are for programs: CSV and JSON have them.
      const std::string text = CellText(row[c], table.columns[c]);
      lines.back().push_back(table.columns[c].name == "region" ? ShortName(text) : text);
    }
  }
  for (const auto& line : lines) {
    widths.resize(line.size());
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], WidthOf(line[c]));
  }
  std::string out;
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const bool is_text =
          !table.rows.empty() && std::holds_alternative<std::string>(table.rows.front()[c]);
      text += is_text ? fmt::format("{:<{}}  ", line[c], widths[c])
                      : fmt::format("{:>{}}  ", line[c], widths[c]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + "\n";
  }
  return out;
}

std::string TableCsv(const Table& table) {
  std::string out;
  const auto add = [&out](std::size_t column, const std::string& field) {
    if (column != 0) out += ',';
    out += field;
  };
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    add(c, CellCsv(table.columns[c].name, table.columns[c]));
  out += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) add(c, CellCsv(row[c], table.columns[c]));
    out += '\n';
  }
  return out;
}

std::string TableJson(const Table& table) {
  if (table.shape == TableShape::kMatrix) return Dumped(MatrixJson(table));
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t c = 0; c < row.size(); ++c) object[table.columns[c].name] = CellJson(row[c]);
    rows.push_back(std::move(object));
  }
  if (table.shape == TableShape::kObject) return Dumped(rows.empty() ? Json::object() : rows[0]);
  return Dumped(rows);
}

std::string LossText(const TraceHealth& health) {
  const std::uint64_t lost = health.LostEvents();
  if (!health.LostUncounted())
    return lost == 0 ? "no event lost" : FormatCount(lost, "event") + " lost";
  return lost == 0 ? "an unknown number of events lost"
                   : "at least " + FormatCount(lost, "event") + " lost";
}

std::string RunningText(const Trace& trace) {
  if (!trace.header_health().Running()) return "";
  return ", still running: recorded until " +
         FormatSeconds(static_cast<double>(trace.SpanNs()) * 1e-9);
}

}  // namespace stipple
