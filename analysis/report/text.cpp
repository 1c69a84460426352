// SPDX-License-Identifier: MIT
#include "analysis/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "analysis/stats/number.h"
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
