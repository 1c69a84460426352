// SPDX-License-Identifier: MIT
// What a report shows: everything is computed before anything is drawn, so that the program that
// computes needs no VTK and the library that draws needs no archive.
#ifndef STIPPLE_ANALYSIS_REPORT_REPORT_INPUT_H
#define STIPPLE_ANALYSIS_REPORT_REPORT_INPUT_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/stats/finding.h"
#include "analysis/stats/region_columns.h"
#include "analysis/stats/table.h"
#include "analysis/stats/timeline.h"

namespace stipple {

struct Analysis;

/// Where the run stands between speed and accuracy.
struct RunAccuracy {
  /// The budget changed how a region is recorded.
  struct Step {
    std::string region;
    std::string_view what;
    double time_s = 0;
    std::uint64_t visits = 0;  // until then
    double mean_s = 0;         // of one
  };
  std::string clock;        // its mode
  bool calibrated = false;  // else cost and doubt are not known
  double cost_s = 0;
  double time_s = 0;
  double doubt = 0;      // largest relative one of a region's exclusive time
  std::string doubtful;  // that region
  std::size_t degraded = 0;
  std::size_t computers = 1;
  double residual_s = 0;  // of clocks
  std::vector<Step> steps;
};

/// Messages over time, for any part of the run.
struct MessageSeries {
  struct Dot {
    double time_s = 0;                               // the send was entered
    std::uint32_t sender_row = 0, receiver_row = 0;  // of the timeline
    std::uint64_t bytes = 0;
  };
  std::uint64_t count = 0;
  std::vector<Dot> all;                      // by time; empty: too many
  std::vector<std::uint64_t> counts, bytes;  // sent, by equal columns of the run
};

/// Functions over time: those with most exclusive time, by equal columns of the run.
struct FunctionSeries {
  struct Function {
    std::string region;
    /// The budget left events out: times and calls are spread as those that were recorded.
    bool estimated = false;
    RegionColumns columns{};  // by rank: by row of the timeline; none: too many
  };
  std::vector<Function> functions;      // most first
  std::vector<std::uint64_t> all_ns{};  // exclusive time of all functions
};

/// Messages and waits from rank to rank, by equal columns of the run; what is nothing is left out.
struct PairSeries {
  struct Part {
    std::uint32_t column = 0, row = 0, to = 0;  // cells of the matrices (CellsOf)
    std::uint64_t count = 0, bytes = 0;
    std::uint64_t wait_ns = 0;  // that `row` waited for `to`
  };
  std::size_t columns = 0;
  std::vector<Part> parts;  // by column, row, to
};

/// Time that others waited for one rank, by equal columns of the run.
struct WaitSeries {
  int rank = 0;
  std::string name;
  std::string region;
  std::vector<double> seconds;
};

/// One call that waited.
struct SingleWait {
  std::string_view kind;
  int waiter = 0, partner = -1;  // world ranks; the partner is the last that arrived
  double begin_s = 0, end_s = 0;
  std::string call;  // of MPI
};

/// A function's exclusive time on each rank.
struct FunctionSpread {
  std::string region;
  std::vector<double> seconds;  // by row of the timeline
};

struct ReportInput {
  std::string title;  // the traced program
  Finding finding;
  std::vector<std::string> facts;  // "8 ranks and a host", "2.31 s", "1 204 messages", ...
  Timeline timeline;               // the whole run, with marks
  Timeline detail;                 // its worst period, with messages
  Table states;
  Table messages;
  Table volume;
  Table profile;                          // most exclusive time first
  Table waits;                            // longest first
  std::vector<SingleWait> longest_waits;  // longest first
  std::vector<FunctionSpread> spreads;    // of the functions with most exclusive time
  Table sizes;                            // messages by size
  Table types;                            // messages by tag
  Table mean_size;                        // matrix of bytes per message
  Table wait_matrix;                      // matrix of seconds that the row waited for the column
  Table switches;                         // over time by rank; no rows: none were recorded
  Table callpaths;                        // a tree
  std::string callpaths_note;             // about calls that are not in it; empty: all are
  Table efficiency;                       // one object of fractions
  Table phases;
  Table critical_path;
  std::string efficiency_text, phases_text, critical_path_text;  // a sentence about each
  MessageSeries message_series;
  std::vector<WaitSeries> wait_series;  // most first
  FunctionSeries function_series;
  PairSeries pair_series;
  RunAccuracy accuracy;
  std::vector<std::string> health;  // one line per problem; empty: the archive is sound
  bool mono = false;                // patterns instead of colours
};

/// Computes all of the above. `columns`: of the detail's timeline.
ReportInput ReportInputOf(const Analysis& analysis, std::size_t columns);

}  // namespace stipple

extern "C" {

/// Draws the report as one self-contained HTML file. Exported by libstipple-views.so; returns 0, or
/// 1 with the reason in `error`.
int stipple_draw_report(const stipple::ReportInput* input, const char* path, char* error,
                        std::size_t error_bytes);
}

#endif
