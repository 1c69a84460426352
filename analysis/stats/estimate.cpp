// SPDX-License-Identifier: MIT
// The problem: with --clock budget:P most visits of short, frequent regions leave no event. Their
// calls are counted; one in a stride is timed, with what is directly inside it. How long were all
// of them, who loses that time, and how sure is that?
//
// A sample i of region Q stands for w_i visits: itself and those since the sample before. Its
// exclusive time x_i is its own time less what was recorded directly inside it, both without what
// recording cost (Calibration). So Q's exclusive time is the sum of w_i x_i. As x excludes what is
// inside, samples of regions that call each other do not count time twice.
//
// Regions whose visits are all timed get the time while they are the innermost timed frame. That
// holds the visits of Q inside them, so the sum of w_i x_i of the samples whose innermost timed
// frame is P is moved from P to Q. Which caller a visit without events had is not known; samples
// fall on callers as visits do, so the sum for each caller is right on average, and its variance is
// that of a sequence which is x_i where the caller is P and 0 elsewhere.
//
// The interval adds up
//   - chance: the variance from successive differences (von Neumann, 1941), w_i^2 (x_i - x_i-1)^2 /
//     2. A slow trend in x, as when a table fills, would inflate the ordinary variance and is no
//     error of a stride. Three sigma; with few samples Student's t at the same confidence;
//   - the prices: they are medians of an empty visit in a loop. Where the processor overlaps a
//     visit with its surroundings they are too high, where it cannot they are too low. That is the
//     same for all visits, so it adds linearly: kSampleDoubt of the inner price for each visit that
//     a sample stands for, kInsideDoubt of the outer price for each one recorded inside of it.
//     Besides, a processor reads the clock when it gets to it, which may be before the work ahead
//     of it is done; what is then left counts for the next region. Samples wait for that work,
//     timed events do not. And full windows are copied away, which no price contains. So each timed
//     visit is doubtful by kReadingsDoubt readings of the clock, for the region and for the one
//     around it. The constants are those that hold on tests/bench/accuracy with caches that other
//     programs use, too: a sample's code is seldom run and often not in the cache;
//   - the rest: visits after the last sample get the mean of all; all of that time is doubtful.
//   - interruptions: a sample that was interrupted by the scheduler is thousands of times longer
//     than the others, and would be multiplied by w. Such samples (very few, very long) count as
//     the median does; what they would have added, and as much more as so few events may be wrong
//     by, stands in the upper bound of Q and the lower of P. A sample that holds the change of a
//     chunk is left out;
//   - what does not fit: samples that add up to more than P has are scaled down to it; what was
//     taken off stays within the upper bound.
// Bounds are never below 0, and never above what the timed frames around have.
//
// A region that calls itself has exclusive time like any other. Its inclusive time counts the
// outermost visits only, which samples do not tell from others: the bounds then are the exclusive
// time and all that the thread has.
//
// Not done: least squares for regions between the events of a sparse run. In a loop each run has
// the same mix of regions, so that the equations are singular just where a better estimate is
// wanted.
#include "analysis/stats/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/trace/whole_scan.h"

namespace stipple {
namespace {

constexpr double kPriceUnit = 256;
constexpr double kSampleDoubt = 1.0 / 3;
constexpr double kInsideDoubt = 1.0 / 4;
constexpr double kReadingsDoubt = 1.5;
// A sample longer than both was interrupted, if there are few of that kind.
constexpr double kInterruptedNs = 20'000;
constexpr double kInterruptedMedians = 64;
constexpr double kDisturbedMedians = 4;

/// Student's t at the confidence of three sigma.
double SigmasFor(std::size_t samples) {
  constexpr std::array kSigmas = {235.8, 19.2, 9.22, 6.62, 5.51, 4.90, 4.53, 4.28, 4.09, 3.96};
  if (samples < 2) return kSigmas[0];
  if (samples - 2 < kSigmas.size()) return kSigmas[samples - 2];
  return 3 + 9.6 / static_cast<double>(samples - 1);
}

/// A part of a region's time, in ticks, and what makes it doubtful.
struct Part {
  double ticks = 0;
  double variance = 0;  // with the sigmas in it
  double linear = 0;    // both ways
  double surplus = 0;   // there may be as much more
  double visits = 0;
  double interrupted = 0;  // samples
};

/// What the samples of one region say.
struct SampleSums {
  std::map<std::uint32_t, Part> around;  // exclusive time, by innermost timed frame
  Part inclusive;
};

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Samples above this were interrupted, by the scheduler or, where something was recorded inside,
/// by the recorder's own rare work.
double InterruptedAbove(const RegionTally& tally, double median, double inside_price,
                        double ns_per_tick) {
  if (std::ranges::any_of(tally.samples, [](const VisitSample& s) { return s.inside > 0; }))
    return kDisturbedMedians * std::max(median, inside_price);
  const double limit = std::max(kInterruptedNs / ns_per_tick, kInterruptedMedians * median);
  const auto above = static_cast<std::size_t>(std::ranges::count_if(
      tally.samples, [limit](const VisitSample& s) { return s.exclusive > limit; }));
  return above <= 3 + tally.samples.size() / 256 ? limit : INFINITY;
}

void AddChance(SampleSums& sums, const VisitSample* before, std::uint32_t around, double visits,
               double exclusive) {
  const double scale = visits * visits / 2;
  if (before != nullptr && before->around == around) {
    sums.around[around].variance += scale * std::pow(exclusive - before->exclusive, 2);
    return;
  }
  sums.around[around].variance += scale * exclusive * exclusive;
  if (before != nullptr)
    sums.around[before->around].variance += scale * before->exclusive * before->exclusive;
}

SampleSums SumsOf(const RegionTally& tally, const EventPrices& prices, double ns_per_tick) {
  SampleSums sums;
  if (tally.samples.empty()) return sums;
  std::vector<double> exclusive;
  for (const VisitSample& s : tally.samples) exclusive.push_back(s.exclusive);
  const double median = Median(std::move(exclusive));
  const double inner = static_cast<double>(prices.sampled_inner) / kPriceUnit * kSampleDoubt;
  const double outer = static_cast<double>(prices.SampledOuter()) / kPriceUnit * kInsideDoubt;
  const double limit = InterruptedAbove(tally, median, outer / kInsideDoubt, ns_per_tick);
  const VisitSample* before = nullptr;
  double last_inclusive = 0;
  std::vector<VisitSample> kept(tally.samples);
  for (VisitSample& s : kept) {
    Part& part = sums.around[s.around];
    const double doubt = inner + s.inside * outer;
    if (s.exclusive > limit) {
      ++part.interrupted;
      part.surplus += (s.exclusive - median) * s.visits;
      s.inclusive -= s.exclusive - median;
      s.exclusive = median;
    }
    part.ticks += s.visits * s.exclusive;
    part.linear += s.visits * doubt;
    part.visits += s.visits;
    AddChance(sums, before, s.around, s.visits, s.exclusive);
    const double inclusive = s.nested ? 0 : s.inclusive;
    sums.inclusive.ticks += s.visits * inclusive;
    sums.inclusive.visits += s.visits;
    sums.inclusive.linear += s.visits * doubt;
    sums.inclusive.variance += std::pow(s.visits * (inclusive - last_inclusive), 2) / 2;
    last_inclusive = inclusive;
    before = &s;
  }
  const double sigmas = SigmasFor(kept.size());
  for (auto& [around, part] : sums.around) {
    part.variance *= sigmas * sigmas;
    // Where few were seen, three sigma of a Poisson distribution are many more.
    if (part.interrupted != 0)
      part.surplus *= 1 + 3 / std::sqrt(part.interrupted) + 4 / part.interrupted;
  }
  sums.inclusive.variance *= sigmas * sigmas;
  return sums;
}

/// Visits after the last sample: the mean of the others.
void AddRest(Part& part, double pending, double all_visits) {
  if (all_visits <= 0 || pending <= 0) return;
  const double rest = part.ticks / all_visits * pending;
  part.ticks += rest;
  part.linear += std::fabs(rest);
}

/// A time and its bounds.
struct Bounded {
  double value = 0;
  double low = 0;
  double high = 0;
  Bounded operator*(double factor) const { return {value * factor, low * factor, high * factor}; }
  Bounds Ends() const { return {low, high}; }
};

/// What a region has, what it is given and what is taken from it; ticks.
struct Account {
  double timed = 0;  // as the innermost timed frame, without what recording cost
  double cost = 0;
  Part in;
  Part out;
  double room = 0;  // of the frames around what came in

  Bounded Exclusive(double timed_doubt) const {
    const double value = std::max(0.0, timed + in.ticks - out.ticks);
    const double doubt =
        std::sqrt(in.variance + out.variance) + in.linear + out.linear + timed_doubt;
    return {value, std::clamp(value - doubt - out.surplus, 0.0, value),
            std::max(value, std::min(value + doubt + in.surplus,
                                     std::max(0.0, timed) + timed_doubt + room))};
  }
};

void Add(Part& to, const Part& part) {
  to.ticks += part.ticks;
  to.variance += part.variance;
  to.linear += part.linear;
  to.surplus += part.surplus;
}

class Estimator {
 public:
  Estimator(const Trace& trace, const Location& location, const Tallies& tallies)
      : tallies_(tallies),
        prices_(tallies.prices),
        ns_per_tick_(trace.NsPerTick(location)),
        accounts_(tallies.regions.size()),
        sums_(tallies.regions.size()) {
    ChargeCosts();
    MoveSamples();
  }

  RegionTime TimeOf(std::size_t r) const {
    const RegionTally& tally = tallies_.regions[r];
    const Bounded inclusive = InclusiveOf(r) * ns_per_tick_;
    const Bounded exclusive = ExclusiveOf(r) * ns_per_tick_;
    return {0,
            tally.Calls() + tally.other_visits,
            inclusive.value,
            exclusive.value,
            inclusive.Ends(),
            exclusive.Ends()};
  }
  RegionOverhead OverheadOf(std::size_t r) const {
    const RegionTally& tally = tallies_.regions[r];
    const Bounded corrected = ExclusiveOf(r);
    const double cost = accounts_[r].cost;
    return {
        0,
        2 * tally.Calls() + tally.other_events,
        tally.other_visits - std::min<std::uint64_t>(tally.other_visits, tally.samples.size()),
        (corrected.value + cost) * ns_per_tick_,
        cost * ns_per_tick_,
        std::max(corrected.high - corrected.value, corrected.value - corrected.low) * ns_per_tick_};
  }

 private:
  /// Of a sparse run, how much of the price of clocked events is paid.
  double SparsePart() const {
    std::uint64_t events = 0;
    for (const RegionTally& t : tallies_.regions) events += 2 * t.Calls();
    const std::uint64_t unclocked = std::min(events, tallies_.unclocked_events);
    if (!tallies_.is_sparse || events == 0 || prices_.timed == 0) return 1;
    const double share = static_cast<double>(unclocked) / static_cast<double>(events);
    return 1 -
           share * (1 - static_cast<double>(prices_.no_clock) / static_cast<double>(prices_.timed));
  }
  /// What recording cost within each region's own time; never more than all of it.
  void ChargeCosts() {
    sparse_ = SparsePart();
    for (std::size_t r = 0; r < accounts_.size(); ++r) {
      const RegionTally& t = tallies_.regions[r];
      const auto timed = static_cast<double>(t.Calls() * prices_.timed_inner +
                                             t.timed_children * prices_.TimedOuter());
      const auto all = static_cast<double>(t.Exclusive());
      const double cost = (timed * sparse_ + static_cast<double>(t.other_cost)) / kPriceUnit;
      accounts_[r].cost = std::min(cost, all);
      accounts_[r].timed = all - accounts_[r].cost;
      total_ += accounts_[r].timed;
    }
  }
  void MoveSamples() {
    std::vector<double> wanted(accounts_.size(), 0);
    for (std::size_t q = 0; q < sums_.size(); ++q) {
      sums_[q] = SumsOf(tallies_.regions[q], prices_, ns_per_tick_);
      const double visits = sums_[q].inclusive.visits;
      const auto pending = static_cast<double>(tallies_.regions[q].pending);
      for (auto& [p, part] : sums_[q].around) {
        AddRest(part, pending, visits);
        part.ticks = std::max(0.0, part.ticks);
        if (p != q) wanted[p] += part.ticks;
      }
      AddRest(sums_[q].inclusive, pending, visits);
    }
    for (std::size_t q = 0; q < sums_.size(); ++q) {
      for (auto& [p, part] : sums_[q].around) {
        if (p == q) continue;
        const double room = std::max(0.0, accounts_[p].timed);
        if (wanted[p] > room) {
          const double fitting = part.ticks * room / wanted[p];
          part.surplus += part.ticks - fitting;
          part.ticks = fitting;
        }
        Add(accounts_[q].in, part);
        Add(accounts_[p].out, part);
        accounts_[q].room += room;
      }
      AddUnsampled(q);
    }
  }
  /// A thread that was too short for a sample: its visits were as long as those that were timed.
  void AddUnsampled(std::size_t q) {
    const RegionTally& t = tallies_.regions[q];
    if (!t.samples.empty() || t.pending == 0 || t.Calls() == 0) return;
    const double mean = static_cast<double>(t.Exclusive()) / static_cast<double>(t.Calls());
    const double ticks = std::min(total_, mean * static_cast<double>(t.pending));
    Add(accounts_[q].in, {ticks, 0, ticks, 0, 0, 0});
    accounts_[q].room += total_;
  }
  double TimedDoubt(std::uint64_t visits) const {
    return static_cast<double>(visits * prices_.clock_read) / kPriceUnit * kReadingsDoubt * sparse_;
  }
  Bounded ExclusiveOf(std::size_t r) const {
    const RegionTally& t = tallies_.regions[r];
    return accounts_[r].Exclusive(TimedDoubt(t.Calls() + t.timed_children));
  }
  Bounded InclusiveOf(std::size_t r) const {
    const RegionTally& t = tallies_.regions[r];
    const Bounded exclusive = ExclusiveOf(r);
    const Part& part = sums_[r].inclusive;
    const double cost = static_cast<double>(t.InclusiveCost()) / kPriceUnit;
    const double timed = std::max(0.0, static_cast<double>(t.Inclusive()) - cost);
    const double value =
        std::clamp(timed + part.ticks, exclusive.value, std::max(exclusive.value, total_));
    const double doubt = std::sqrt(part.variance) + part.linear + TimedDoubt(t.Calls());
    const double most = std::max(value, total_);
    if (t.recursive) return {value, exclusive.low, most};
    return {value, std::clamp(value - doubt, exclusive.low, value),
            std::clamp(value + doubt, value, most)};
  }

  const Tallies& tallies_;
  const EventPrices& prices_;
  double ns_per_tick_;
  double sparse_ = 1;
  double total_ = 0;  // of the thread, without what recording cost
  std::vector<Account> accounts_;
  std::vector<SampleSums> sums_;
};

}  // namespace

bool HasBudget(const Process& process) {
  return process.stream->settings.find("clock=budget") != std::string::npos;
}

bool IsSparse(const Process& process) {
  return process.stream->settings.find("clock=sparse") != std::string::npos;
}

LocationEstimate EstimateFrom(const Trace& trace, const Location& location,
                              const EstimateVisitor& visitor) {
  return EstimateFrom(trace, location,
                      Tallies{visitor.regions(), visitor.steps(), visitor.prices(),
                              visitor.is_sparse(), visitor.unclocked_events()});
}

LocationEstimate EstimateFrom(const Trace& trace, const Location& location,
                              const Tallies& tallies) {
  const Process& process = trace.ProcessOf(location);
  const Estimator estimator(trace, location, tallies);
  LocationEstimate estimate;
  for (std::size_t r = 0; r < process.regions.size(); ++r) {
    const RegionTally& tally = tallies.regions[r];
    if (tally.Calls() == 0 && tally.other_visits == 0 && tally.Inclusive() == 0 &&
        tally.Exclusive() == 0)
      continue;
    estimate.profile.push_back(estimator.TimeOf(r));
    estimate.overhead.push_back(estimator.OverheadOf(r));
    estimate.profile.back().region = estimate.overhead.back().region = process.regions[r];
  }
  for (const ModeStep& step : tallies.steps) {
    const std::uint32_t region =
        step.region < process.regions.size() ? process.regions[step.region] : 0;
    estimate.steps.push_back({trace.TimeNs(location, step.ticks), location.index, region, step.mode,
                              step.visits, step.mean_ticks * trace.NsPerTick(location)});
  }
  return estimate;
}

std::vector<RegionOverhead> OverheadFrom(const Trace& trace, const Location& location,
                                         const LocationProfile& profile,
                                         const LocationPaths& paths) {
  const Process& process = trace.ProcessOf(location);
  const bool has_estimates = paths.unclocked != 0 && !IsSparse(process);
  if (trace.kept() || has_estimates || !process.stream->visit_counts.empty())
    return EstimateOf(trace, location, {}).overhead;
  std::vector<RegionTally> tallies(paths.regions.size() + 1);
  auto time = profile.begin();  // of the regions that were called, in the same order
  for (std::size_t r = 0; r < paths.regions.size(); ++r) {
    if (paths.regions[r].calls == 0 || time == profile.end()) continue;
    // As the visitor would have it, but for inclusive times, which the overhead does not depend on.
    tallies[r].events = 2 * paths.regions[r].calls * VisitSums::kEvent;
    tallies[r].timed_children = paths.regions[r].children;
    tallies[r].ticks[3] =
        static_cast<std::uint64_t>(std::llround(time++->exclusive_ns / trace.NsPerTick(location)));
  }
  return EstimateFrom(
             trace, location,
             Tallies{
                 tallies, {}, EventPrices::Of(*process.stream), IsSparse(process), paths.unclocked})
      .overhead;
}

LocationEstimate EstimateOf(const Trace& trace, const Location& location,
                            const Selection& selection) {
  const bool whole = selection.WholeTime();
  const Process& process = trace.ProcessOf(location);
  EstimateVisitor visitor(
      process.RegionCount(),
      whole ? location.first_ticks : trace.TicksAt(location, selection.begin_ns),
      whole ? kNoTickLimit : trace.TicksAt(location, selection.end_ns),
      EventPrices::Of(*process.stream), IsSparse(process), nullptr);
  ScanWhole(trace, location, visitor);
  visitor.Finish(location.last_ticks,
                 whole ? std::span<const VisitCount>(process.stream->visit_counts)
                       : std::span<const VisitCount>(),
                 location.stream->thread);
  return EstimateFrom(trace, location, visitor);
}

}  // namespace stipple
