// SPDX-License-Identifier: MIT
#include "analysis/report/tree_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

constexpr double kLeastShare = 0.01;

/// What a line shows of one row, or of several that are too small for lines of their own.
struct Line {
  double inclusive_s = 0;
  double exclusive_s = 0;
  std::array<std::int64_t, 4> counts{};  // of kCounts
  std::array<bool, 4> known{};
};
constexpr std::array<std::string_view, 4> kCounts = {"calls", "messages", "bytes", "samples"};

std::size_t ColumnOf(const Table& table, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(table.columns, name, &Column::name) -
                                  table.columns.begin());
}

class TreeWriter {
 public:
  explicit TreeWriter(const Table& table)
      : table_(table),
        inclusive_(ColumnOf(table, "inclusive_s")),
        exclusive_(ColumnOf(table, "exclusive_s")) {
    for (std::size_t i = 0; i < kCounts.size(); ++i) {
      columns_[i] = ColumnOf(table, kCounts[i]);
      // A column that says nothing in any row is left out.
      shown_[i] = std::ranges::any_of(table.rows, [this, i](const auto& row) {
        const auto* count = std::get_if<std::int64_t>(&row[columns_[i]]);
        return count != nullptr && *count != 0;
      });
    }
    for (const auto& row : table.rows)
      if (Depth(row) == 1 && !IsSamples(row)) whole_ += std::get<double>(row[inclusive_]);
  }

  std::string Text() {
    text_ = fmt::format("{:>7} {:>12} {:>12}", "share", "inclusive_s", "exclusive_s");
    for (std::size_t i = 0; i < kCounts.size(); ++i)
      if (shown_[i]) text_ += fmt::format(" {:>10}", kCounts[i]);
    text_ += "  path\n";
    for (std::size_t at = 0; at < table_.rows.size();) at = Write(at);
    EndRests(0);
    return text_;
  }

 private:
  using Row = std::vector<Cell>;
  struct Rest {
    Line sum;
    std::size_t paths = 0;
  };

  static std::size_t Depth(const Row& row) {
    return std::get<std::vector<std::string>>(row.front()).size();
  }
  /// Beside events samples are a tree of their own.
  static bool IsSamples(const Row& row) { return NameOf(row) == kSamplesPath; }
  static const std::string& NameOf(const Row& row) {
    return std::get<std::vector<std::string>>(row.front()).back();
  }
  Line LineOf(const Row& row) const {
    Line line{std::get<double>(row[inclusive_]), std::get<double>(row[exclusive_]), {}, {}};
    for (std::size_t i = 0; i < kCounts.size(); ++i) {
      const auto* count = std::get_if<std::int64_t>(&row[columns_[i]]);
      line.known[i] = count != nullptr;
      line.counts[i] = count != nullptr ? *count : 0;
    }
    return line;
  }
  bool Matters(double inclusive_s) const {
    return whole_ <= 0 || inclusive_s >= kLeastShare * whole_;
  }

  /// Writes the row, or adds it and all below it to the rest of its parent; returns the next row.
  std::size_t Write(std::size_t at) {
    const Row& row = table_.rows[at];
    const std::size_t depth = Depth(row);
    EndRests(depth);
    if (depth == 1 && IsSamples(row)) whole_ = std::get<double>(row[inclusive_]);
    const Line line = LineOf(row);
    if (Matters(line.inclusive_s)) {
      AddLine(line, depth, ShortName(NameOf(row)));
      return at + 1;
    }
    if (rests_.size() <= depth) rests_.resize(depth + 1);
    Rest& rest = rests_[depth];
    rest.sum.inclusive_s += line.inclusive_s;
    for (; at < table_.rows.size() && (Depth(table_.rows[at]) > depth || &table_.rows[at] == &row);
         ++at) {
      const Line small = LineOf(table_.rows[at]);
      ++rest.paths;
      rest.sum.exclusive_s += small.exclusive_s;
      for (std::size_t i = 0; i < kCounts.size(); ++i) {
        // Samples of a path include those below it.
        if (kCounts[i] == "samples" && &table_.rows[at] != &row) continue;
        rest.sum.counts[i] += small.counts[i];
        rest.sum.known[i] |= small.known[i];
      }
    }
    return at;
  }

  /// Writes what was too small below paths that are deeper than `depth`.
  void EndRests(std::size_t depth) {
    while (rests_.size() > depth + 1 || (depth == 0 && !rests_.empty())) {
      const Rest rest = rests_.back();
      const std::size_t rest_depth = rests_.size() - 1;
      rests_.pop_back();
      if (rest.paths != 0)
        AddLine(rest.sum, rest_depth,
                fmt::format("({}, less than 1 % each)", FormatCount(rest.paths, "path")));
    }
  }

  void AddLine(const Line& line, std::size_t depth, const std::string& name) {
    const double share = whole_ > 0 ? line.inclusive_s / whole_ * 100 : 0;
    text_ +=
        fmt::format("{:>5.1f} % {:>12.6f} {:>12.6f}", share, line.inclusive_s, line.exclusive_s);
    for (std::size_t i = 0; i < kCounts.size(); ++i)
      if (shown_[i])
        text_ += fmt::format(" {:>10}", line.known[i] ? fmt::format("{}", line.counts[i]) : "-");
    text_ += fmt::format("  {:{}}{}\n", "", 2 * (depth - 1), name);
  }

  const Table& table_;
  std::size_t inclusive_;
  std::size_t exclusive_;
  std::array<std::size_t, 4> columns_{};
  std::array<bool, 4> shown_{};
  double whole_ = 0;
  std::vector<Rest> rests_;  // by depth
  std::string text_;
};

}  // namespace

std::string TreeText(const Table& table) { return TreeWriter(table).Text(); }

}  // namespace stipple
