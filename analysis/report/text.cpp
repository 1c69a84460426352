// SPDX-License-Identifier: MIT
#include "analysis/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

template <class... Cases>
struct Match : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Match(Cases...) -> Match<Cases...>;  // clang 14 does not find it by itself

std::string CellText(const Cell& cell) {
  return std::visit(Match{[](std::monostate) { return std::string("-"); },
                          [](std::int64_t v) { return fmt::format("{}", v); },
                          [](double v) { return fmt::format("{:.6f}", v); },
                          [](const std::string& v) { return v; }},
                    cell);
}

std::string CellCsv(const Cell& cell) {
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
  return std::visit(Match{[](std::monostate) { return std::string(); },
                          [](std::int64_t v) { return fmt::format("{}", v); },
                          [](double v) { return fmt::format("{:.9f}", v); }, quoted},
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

}  // namespace

std::string TableText(const Table& table) {
  std::vector<std::size_t> widths;
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& c : table.columns) lines.front().push_back(c.name);
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) {
      // Full names, with all parameters, are for programs: CSV and JSON have them.
      const std::string text = CellText(row[c]);
      lines.back().push_back(table.columns[c].name == "region" ? ShortName(text) : text);
    }
  }
  for (const auto& line : lines) {
    widths.resize(line.size());
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
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
  for (std::size_t c = 0; c < table.columns.size(); ++c) add(c, CellCsv(table.columns[c].name));
  out += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) add(c, CellCsv(row[c]));
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

std::string CountText(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

std::string CountText(std::uint64_t count, std::string_view noun) {
  return fmt::format("{} {}{}", CountText(count), noun, count == 1 ? "" : "s");
}

std::string LossText(const TraceHealth& health) {
  const std::uint64_t lost = health.LostEvents();
  if (!health.LostUncounted())
    return lost == 0 ? "no event lost" : CountText(lost, "event") + " lost";
  return lost == 0 ? "an unknown number of events lost"
                   : "at least " + CountText(lost, "event") + " lost";
}

std::string BytesText(std::uint64_t bytes) {
  constexpr std::array kUnits = {"B", "kB", "MB", "GB", "TB"};
  if (bytes < 1000) return fmt::format("{} B", bytes);
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  return fmt::format("{:.{}f} {}", value, value < 99.5 ? 1 : 0, kUnits[unit]);
}

std::string SecondsText(double seconds) {
  const double size = std::abs(seconds);
  if (size == 0) return "0 s";
  if (size < 1e-6) return fmt::format("{:.0f} ns", seconds * 1e9);
  if (size < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (size < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.{}f} s", seconds, size < 10 ? 3 : size < 100 ? 2 : 1);
}

}  // namespace stipple
