// SPDX-License-Identifier: MIT
#include "analysis/stats/phases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding_words.h"
#include "analysis/stats/kernel_time.h"
#include "analysis/stats/number.h"
#include "analysis/stats/timeline_of.h"

namespace stipple {
namespace {

constexpr std::size_t kColumns = 512;
constexpr std::size_t kFeatures = kStateCount + 1;
// A tenth of the time that moves from one state to another, for 2 % of the run.
constexpr double kLeastPenalty = 2 * 0.1 * 0.1 * 0.02 * kColumns;
constexpr double kNoisePenalty = 4;
// So many phases of the least length would fill the run.
constexpr std::size_t kLeastParts = 50;

/// Sums of a series up to each column: squared distances from the mean of any span at once.
class Distances {
 public:
  explicit Distances(std::span<const std::vector<double>> series) {
    for (const std::vector<double>& feature : series) {
      sums_.push_back({{0}, {0}});
      for (const double value : feature) {
        sums_.back().first.push_back(sums_.back().first.back() + value);
        sums_.back().second.push_back(sums_.back().second.back() + value * value);
      }
    }
  }
  double Of(std::size_t begin, std::size_t end) const {
    double distance = 0;
    for (const auto& [sum, squares] : sums_) {
      const double s = sum[end] - sum[begin];
      distance += squares[end] - squares[begin] - s * s / static_cast<double>(end - begin);
    }
    return std::max(0.0, distance);
  }

 private:
  std::vector<std::pair<std::vector<double>, std::vector<double>>> sums_;
};

/// Half the median squared difference of neighbours: the variance of noise, changes left aside.
double NoiseOf(std::span<const std::vector<double>> series, std::size_t count) {
  std::vector<double> squares(count - 1);
  for (const std::vector<double>& feature : series)
    for (std::size_t i = 0; i + 1 < count; ++i)
      squares[i] += (feature[i + 1] - feature[i]) * (feature[i + 1] - feature[i]);
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / 2;
}

/// Where no phase is shorter than `least_length`. A begin is given up when another one is better
/// even so, which is only known of begins that are as long ago.
std::vector<std::size_t> Optimum(const Distances& distances, std::size_t count, double penalty,
                                 std::size_t least_length) {
  std::vector<double> least(count + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(count + 1);
  std::vector<std::size_t> candidates = {0};  // where the last phase may begin
  least[0] = -penalty;
  for (std::size_t end = least_length; end <= count; ++end) {
    for (const std::size_t begin : candidates) {
      const double cost = least[begin] + distances.Of(begin, end) + penalty;
      if (cost < least[end]) {
        least[end] = cost;
        from[end] = begin;
      }
    }
    const std::size_t next = end + 1 - least_length;  // may be a begin from now on
    if (next < least_length) continue;
    std::erase_if(candidates, [&](std::size_t begin) {
      return least[begin] + distances.Of(begin, next) > least[next];
    });
    candidates.push_back(next);
  }
  std::vector<std::size_t> begins;
  for (std::size_t end = count; end > 0; end = from[end]) begins.push_back(from[end]);
  std::ranges::reverse(begins);
  return begins;
}

/// Rows whose time counts: those of selected ranks, hosts left out unless they are all there are.
std::vector<const TimelineRow*> RowsOf(const Timeline& timeline, const Selection& selection) {
  std::vector<const TimelineRow*> rows;
  for (const TimelineRow& row : timeline.rows)
    if (selection.HasRank(row.rank) && !row.is_host) rows.push_back(&row);
  if (rows.empty())
    for (const TimelineRow& row : timeline.rows)
      if (selection.HasRank(row.rank)) rows.push_back(&row);
  return rows;
}

std::vector<std::vector<double>> FeaturesOf(const std::vector<const TimelineRow*>& rows,
                                            std::size_t columns) {
  std::vector<std::vector<double>> features(kFeatures, std::vector<double>(columns));
  const auto count = static_cast<double>(rows.size());
  for (std::size_t c = 0; c < columns; ++c) {
    double squares = 0;
    for (const TimelineRow* row : rows) {
      for (std::size_t s = 0; s < kStateCount; ++s)
        features[s][c] += static_cast<double>(row->columns[c][s]) / count;
      const auto user =
          static_cast<double>(row->columns[c][static_cast<std::size_t>(State::kUser)]);
      squares += user * user / count;
    }
    const double mean = features[static_cast<std::size_t>(State::kUser)][c];
    features[kStateCount][c] = std::sqrt(std::max(0.0, squares - mean * mean));
  }
  return features;
}

Phase PhaseOf(const std::vector<const TimelineRow*>& rows, std::size_t begin, std::size_t end) {
  Phase phase;
  double most = -1;
  const auto length = static_cast<double>(end - begin);
  for (const TimelineRow* row : rows) {
    std::array<double, kStateCount> sums{};
    for (std::size_t c = begin; c < end; ++c)
      for (std::size_t s = 0; s < kStateCount; ++s)
        sums[s] += static_cast<double>(row->columns[c][s]);
    for (std::size_t s = 0; s < kStateCount; ++s)
      phase.shares[s] += sums[s] / (length * static_cast<double>(rows.size()));
    const double user = sums[static_cast<std::size_t>(State::kUser)] / length;
    if (user > most) {
      most = user;
      phase.busiest_rank = row->rank;
    }
  }
  const double mean = phase.shares[static_cast<std::size_t>(State::kUser)];
  phase.max_over_mean = mean > 0 ? most / mean : 1;
  return phase;
}

}  // namespace

std::vector<std::size_t> ChangePointsOf(std::span<const std::vector<double>> series,
                                        std::size_t most_phases) {
  const std::size_t count = series.empty() ? 0 : series.front().size();
  if (count < 2) return {0};
  const Distances distances(series);
  double penalty =
      kLeastPenalty + kNoisePenalty * NoiseOf(series, count) * std::log(static_cast<double>(count));
  const std::size_t least_length = std::max<std::size_t>(1, count / kLeastParts);
  std::vector<std::size_t> begins = Optimum(distances, count, penalty, least_length);
  while (begins.size() > most_phases)
    begins = Optimum(distances, count, penalty *= 2, least_length);
  return begins;
}

std::vector<Phase> PhasesOf(const Analysis& analysis, const Selection& selection) {
  const std::int64_t begin_ns = std::max<std::int64_t>(0, selection.begin_ns);
  const std::int64_t end_ns = std::min(analysis.trace.SpanNs(), selection.end_ns);
  if (end_ns <= begin_ns) return {};
  const std::int64_t span_ns = end_ns - begin_ns;
  const auto columns = static_cast<std::size_t>(std::min<std::int64_t>(kColumns, span_ns));
  const Timeline timeline = TimelineOf(analysis, static_cast<double>(begin_ns) * 1e-9,
                                       static_cast<double>(end_ns) * 1e-9, columns);
  const std::vector<const TimelineRow*> rows = RowsOf(timeline, selection);
  if (rows.empty()) return {};
  const std::vector<std::size_t> begins = ChangePointsOf(FeaturesOf(rows, columns), kMostPhases);
  const auto time_ns = [&](std::size_t column) {
    return begin_ns +
           static_cast<std::int64_t>(static_cast<double>(span_ns) * static_cast<double>(column) /
                                     static_cast<double>(columns));
  };
  std::vector<Phase> phases;
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : columns;
    phases.push_back(PhaseOf(rows, begins[i], end));
    phases.back().begin_ns = time_ns(begins[i]);
    phases.back().end_ns = time_ns(end);
  }
  return phases;
}

std::string PhasesSentence(const Trace& trace, const std::vector<Phase>& phases) {
  if (phases.empty()) return "The archive holds no time.";
  const Phase* most = &phases.front();  // most computation above the mean, in seconds
  const auto lost_ns = [](const Phase& p) {
    return (p.max_over_mean - 1) * p.shares[static_cast<std::size_t>(State::kUser)] *
           static_cast<double>(p.end_ns - p.begin_ns);
  };
  for (const Phase& p : phases)
    if (lost_ns(p) > lost_ns(*most)) most = &p;
  return "The run has " + FormatCount(phases.size(), "phase") +
         "; most is lost by imbalance between " +
         FormatSeconds(static_cast<double>(most->begin_ns) * 1e-9) + " and " +
         FormatSeconds(static_cast<double>(most->end_ns) * 1e-9) + ", where " +
         RankWords(trace).One(most->busiest_rank) + " computes " +
         FormatThreeDigits(most->max_over_mean) + " times the mean.";
}

Table PhasesTable(const Analysis& analysis, const std::vector<Phase>& phases) {
  Table table{"phases",
              TableShape::kRows,
              {{"begin_s"},
               {"end_s"},
               {"user"},
               {"system"},
               {"message"},
               {"idle"},
               {"max_over_mean"},
               {"busiest_rank"}},
              {}};
  const bool has_system = std::ranges::any_of(analysis.trace.locations(), [&](const Location& l) {
    return l.IsMain() && HasKernelTime(analysis.trace, l);
  });
  const auto share = [](const Phase& p, State s) { return p.shares[static_cast<std::size_t>(s)]; };
  for (const Phase& p : phases)
    table.rows.push_back(RowOf(static_cast<double>(p.begin_ns) * 1e-9,
                               static_cast<double>(p.end_ns) * 1e-9, share(p, State::kUser),
                               has_system ? Cell(share(p, State::kSystem)) : Cell(),
                               share(p, State::kMessage), share(p, State::kIdle), p.max_over_mean,
                               std::int64_t{p.busiest_rank}));
  return table;
}

}  // namespace stipple
