// SPDX-License-Identifier: MIT
// Any table as values by rank: what dials, LEDs, Kiviat diagrams and bars show. Of a series the
// values that hold at a moment, of a matrix what each rank sent.
#ifndef STIPPLE_ANALYSIS_VIEWS_RANK_TABLE_H
#define STIPPLE_ANALYSIS_VIEWS_RANK_TABLE_H

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/timeline.h"
#include "analysis/views/quantity.h"
#include "analysis/views/value_axis.h"
#include "analysis/views/view_list.h"

namespace stipple {

struct RankColumn {
  std::string column{};  // its name in the table
  std::string label{};   // in words; with the table's name if another table has the same column
  Quantity quantity = Quantity::kCount;
  std::vector<double> values{};         // by rank; not a number: not recorded
  std::vector<double> least{}, most{};  // of the ranks in each group; empty: not grouped
  double largest = 0;                   // of the columns that count the same, and at all times
};

struct RankTable {
  std::vector<TimelineRow> ranks;  // names only; the host is last
  std::vector<RankColumn> columns;
  std::optional<double> time_s;       // of the values, where they change over time
  std::vector<std::string> tables;    // their names
  std::vector<std::string> left_out;  // columns that count something else, or are too many
  bool has_host() const;
};

/// Whether a table has a value for each rank (or a matrix has rows).
bool FitsRanks(const Table& table);

/// `most_columns` at most; those asked for in `input.columns`, else alike ones of each table.
RankTable RankTableOf(const ViewInput& input, std::size_t most_columns);

/// Neighbouring ranks as one, with their mean, until at most `most` are left; the host stays alone.
RankTable Grouped(const RankTable& table, std::size_t most, std::size_t& ranks_per_group);

/// Of a row that is no rank, or whose number is not known; -1 is "no culprit".
inline constexpr int kNoRank = -2;

/// A rank's name as rows are labelled: by the timeline's rows, where there is one.
TimelineRow RankNamed(const ViewInput& input, const std::string& cell);

/// Order of ranks: by number, the host last.
bool RankBefore(const TimelineRow& a, const TimelineRow& b);

/// " at 4.20 s", or nothing.
std::string MomentText(const RankTable& table);

/// One axis for all columns that count what this one counts.
ValueAxis AxisOfColumn(const RankTable& table, const RankColumn& column, double ticks = 4);

/// An axis for the largest sum over all columns of a rank.
ValueAxis StackAxis(const RankTable& table, double ticks = 4);

/// "Utilisation", "States": the tables' names as a heading.
std::string HeadingOf(const RankTable& table);
/// "window and since start".
std::string LabelsOf(const RankTable& table);

/// Says in the note what is not shown, and the scales of columns that count something else than the
/// first.
void AddScaleNotes(Scene& scene, const RankTable& table);

}  // namespace stipple

#endif
