// SPDX-License-Identifier: MIT
// Common time. Ticks are never rewritten; each process gets a map from its ticks to nanoseconds.
//
// Processes with one boot id share the time-stamp counter: they form a group with one rate, taken
// from the pairs of ticks and CLOCK_MONOTONIC_RAW that are farthest apart. The group of the lowest
// rank is the reference. Another group is tied to it by the readings of each other's clock that MPI
// processes make at their start and end (Cristian, Distributed Computing 3, 1989): each gives one
// point, the map is linear between points and goes on beyond the outer ones with their slope.
// Without readings the wall clocks at the start must do, and the health record says so.
#ifndef STIPPLE_ANALYSIS_TRACE_CLOCK_H
#define STIPPLE_ANALYSIS_TRACE_CLOCK_H

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/trace/health.h"
#include "analysis/trace/stream.h"

namespace stipple {

/// Ticks to nanoseconds, linear in pieces, rising.
class ClockMap {
 public:
  struct Point {
    std::uint64_t ticks;
    double ns;
  };
  /// Through `points` (at least one, rising); beyond the outer ones with `outer_slope`.
  ClockMap(std::vector<Point> points, double outer_slope);

  double Ns(std::uint64_t ticks) const;
  std::uint64_t Ticks(double ns) const;
  /// Nanoseconds per tick, over the whole map.
  double MeanSlope() const;

 private:
  struct Segment {
    Point begin;
    double slope;
  };
  std::vector<Segment> segments_;  // the first also serves what comes before it
};

struct ClockReport {
  ClockKind kind = ClockKind::kTsc;
  double hz = 0;              // of the reference; 0: unknown
  std::size_t computers = 0;  // groups of processes that share a counter
  double residual_ns = 0;     // bound of the error between groups: half the longest round trip
  bool synchronised = true;   // every group is tied to the reference
};

struct Clocks {
  std::vector<ClockMap> maps;  // by stream
  ClockReport report;
};

/// The maps of all streams.
Clocks CorrectClocks(std::span<const std::unique_ptr<Stream>> streams, TraceHealth& health);

}  // namespace stipple

#endif
