// SPDX-License-Identifier: MIT
// Each state's pieces do not overlap the others': drawn over one another, lower colours would shine
// through at anti-aliased edges.
#include "analysis/views/state_runs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/views/palette.h"

namespace stipple {
namespace {

constexpr int kLeastSteps = 4;
constexpr std::size_t kLeastColumns = 12;

StateRun RunOf(const StateShares& shares, int steps) {
  StateRun run;
  double sum = 0;
  for (std::size_t s = 0; s < kStateCount; ++s) {
    sum += std::clamp(static_cast<double>(shares[s]), 0.0, 1.0);
    run.top[s] = static_cast<int>(std::lround(std::min(sum, 1.0) * steps));
  }
  const auto idle = static_cast<std::size_t>(State::kIdle);
  run.top[idle] = sum >= 0.5 ? steps : 0;  // there or not there; rows have no ragged tops
  for (std::size_t s = 0; s < idle; ++s) run.top[s] = std::min(run.top[s], run.top[idle]);
  return run;
}

std::vector<StateRun> MergeRuns(std::span<const StateShares> columns, int steps) {
  std::vector<StateRun> runs;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    StateRun run = RunOf(columns[i], steps);
    if (!runs.empty() && runs.back().top == run.top) {
      runs.back().end = i + 1;
      continue;
    }
    run.begin = i;
    run.end = i + 1;
    runs.push_back(run);
  }
  return runs;
}

int Bottom(const StateRun& run, std::size_t state) {
  if (state == static_cast<std::size_t>(State::kIdle)) return 0;  // behind all others
  return state == 0 ? 0 : run.top[state - 1];
}

bool Shows(const StateRun& run, std::size_t state) { return run.top[state] > Bottom(run, state); }

std::size_t CountQuads(const std::vector<std::vector<StateRun>>& rows) {
  std::size_t quads = 0;
  constexpr auto kIdle = static_cast<std::size_t>(State::kIdle);
  for (const std::vector<StateRun>& runs : rows) {
    int idle = 0;  // the background runs through; only its ends count
    for (const StateRun& run : runs) {
      for (std::size_t s = 0; s < kIdle; ++s) quads += Shows(run, s) ? 1 : 0;
      if (run.top[kIdle] > idle) ++quads;
      idle = run.top[kIdle];
    }
  }
  return quads;
}

StateRuns TryRuns(const Timeline& timeline, const RowGrid& grid, std::size_t columns, int steps) {
  StateRuns runs{columns, steps, {}, 0};
  const std::span<const TimelineRow> rows(timeline.rows);
  for (const GridRow& row : grid.rows)
    runs.rows.push_back(
        MergeRuns(AverageColumns(rows.subspan(row.first, row.count), columns), steps));
  runs.quads = CountQuads(runs.rows);
  return runs;
}

double XOfColumn(const TimeAxis& axis, std::size_t column, std::size_t columns) {
  const double x =
      axis.left + axis.width() * static_cast<double>(column) / static_cast<double>(columns);
  return std::round(x * 10) / 10;
}

/// The outline of one piece: along the tops to the right, back along the bottoms.
struct Outline {
  std::vector<Point> tops, bottoms;

  void Extend(double left, double right, double top, double bottom) {
    Step(tops, left, right, top);
    Step(bottoms, left, right, bottom);
  }
  static void Step(std::vector<Point>& edge, double left, double right, double y) {
    if (!edge.empty() && edge.back().y == y) {
      edge.back().x = right;
      return;
    }
    edge.push_back({left, y});
    edge.push_back({right, y});
  }
  void Flush(Layer& layer, Colour fill) {
    if (tops.empty()) return;
    tops.insert(tops.end(), bottoms.rbegin(), bottoms.rend());
    layer.shapes.emplace_back(PolygonShape{std::move(tops), fill});
    tops.clear();
    bottoms.clear();
  }
};

void AddState(Layer& layer, const StateRuns& runs, const RowGrid& grid, const TimeAxis& axis,
              State state) {
  const auto s = static_cast<std::size_t>(state);
  for (std::size_t r = 0; r < grid.rows.size(); ++r) {
    const GridRow& row = grid.rows[r];
    const auto y_of = [&](int step) {
      return row.y + row.height - std::round(row.height * 2 * step / runs.steps) / 2;
    };
    Outline outline;
    for (const StateRun& run : runs.rows[r]) {
      if (!Shows(run, s)) {
        outline.Flush(layer, ColourOf(state));
        continue;
      }
      outline.Extend(XOfColumn(axis, run.begin, runs.columns),
                     XOfColumn(axis, run.end, runs.columns), y_of(run.top[s]),
                     y_of(Bottom(run, s)));
    }
    outline.Flush(layer, ColourOf(state));
  }
}

}  // namespace

std::vector<StateShares> AverageColumns(std::span<const TimelineRow> rows, std::size_t columns) {
  std::vector<StateShares> averaged(columns, StateShares{});
  if (rows.empty() || columns == 0) return averaged;
  for (const TimelineRow& row : rows) {
    const std::size_t count = row.columns.size();
    if (count == 0) continue;
    const double scale = static_cast<double>(count) / static_cast<double>(columns);
    for (std::size_t i = 0; i < columns; ++i) {
      const double begin = static_cast<double>(i) * scale, end = begin + scale;
      for (auto k = static_cast<std::size_t>(begin); k < count && static_cast<double>(k) < end;
           ++k) {
        const double low = std::max(begin, static_cast<double>(k));
        const double part = (std::min(end, static_cast<double>(k) + 1) - low) / scale;
        for (std::size_t s = 0; s < kStateCount; ++s)
          averaged[i][s] += static_cast<float>(part * static_cast<double>(row.columns[k][s]) /
                                               static_cast<double>(rows.size()));
      }
    }
  }
  return averaged;
}

StateRuns MakeStateRuns(const Timeline& timeline, const RowGrid& grid, double width_pixels,
                        std::size_t budget) {
  std::size_t most = 1;
  for (const TimelineRow& row : timeline.rows) most = std::max(most, row.columns.size());
  std::size_t columns = std::min(most, static_cast<std::size_t>(std::max(1.0, width_pixels)));
  const double height = grid.rows.empty() ? 1 : grid.rows.front().height;
  const int finest = std::clamp(static_cast<int>(height), kLeastSteps, 28);
  const int coarsest = std::clamp(finest / 2, kLeastSteps, 8);
  for (;;) {
    StateRuns runs;
    for (int steps = finest; steps >= coarsest;
         steps = steps > coarsest ? std::max(coarsest, steps / 2) : 0) {
      runs = TryRuns(timeline, grid, columns, steps);
      if (runs.quads <= budget) return runs;
    }
    if (columns <= kLeastColumns) return runs;
    columns = std::max(kLeastColumns, columns * 3 / 4);
  }
}

Layer StateLayer(const StateRuns& runs, const RowGrid& grid, const TimeAxis& axis) {
  Layer layer{"states", {}};
  for (const State state : {State::kIdle, State::kUser, State::kSystem, State::kMessage})
    AddState(layer, runs, grid, axis, state);
  return layer;
}

}  // namespace stipple
