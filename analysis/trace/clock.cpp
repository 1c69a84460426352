// SPDX-License-Identifier: MIT
#include "analysis/trace/clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace stipple {
namespace {

// A pair is read to within about 50 ns: below this baseline the processor's own statement is
// better.
constexpr double kShortBaselineNs = 1e8;
// Readings this close make no slope.
constexpr double kShortSyncNs = 1e8;
constexpr double kLeastHz = 1e6;
constexpr double kMostHz = 2e10;

double Signed(std::uint64_t to, std::uint64_t from) {
  return static_cast<double>(static_cast<std::int64_t>(to - from));
}

/// Streams that share a counter.
struct Group {
  std::vector<std::size_t> streams;
  bool is_virtual = false;
  std::uint64_t origin_ticks = 0;
  double ns_per_tick = 1;
  std::optional<ClockMap> map;
};

/// Median of the rates that the streams' own longest baselines give, and the longest baseline's.
double RateOf(const Group& group, std::span<const std::unique_ptr<Stream>> streams,
              TraceHealth& health) {
  if (group.is_virtual) return 1;
  ClockPair first{std::numeric_limits<std::uint64_t>::max(), 0};
  ClockPair last{};
  double stated_hz = 0;
  for (const std::size_t s : group.streams) {
    if (streams[s]->header.tsc_hz != 0) stated_hz = static_cast<double>(streams[s]->header.tsc_hz);
    for (const ClockPair& p : streams[s]->clock_pairs) {
      if (p.ticks == 0 || p.raw_ns == 0) continue;
      if (p.ticks < first.ticks) first = p;
      if (p.ticks > last.ticks) last = p;
    }
  }
  const double baseline_ns = last.ticks > first.ticks ? Signed(last.raw_ns, first.raw_ns) : 0;
  const double hz = baseline_ns > 0 ? Signed(last.ticks, first.ticks) / baseline_ns * 1e9 : 0;
  const bool measured = hz >= kLeastHz && hz <= kMostHz;
  const bool stated = stated_hz >= kLeastHz && stated_hz <= kMostHz;
  if (measured && (baseline_ns >= kShortBaselineNs || !stated)) return 1e9 / hz;
  if (stated) return 1e9 / stated_hz;
  health.Add(Defect::kClockUnknown, streams[group.streams.front()]->host_name);
  return 1;
}

std::vector<Group> GroupsOf(std::span<const std::unique_ptr<Stream>> streams,
                            std::vector<std::size_t>& group_of_stream) {
  std::map<std::string, std::size_t> known;
  std::vector<Group> groups;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    const bool is_virtual = streams[s]->header.clock == ClockKind::kVirtual;
    const auto [it, is_new] =
        known.try_emplace(is_virtual ? "virtual" : streams[s]->boot_id, groups.size());
    if (is_new) {
      groups.emplace_back();
      groups.back().is_virtual = is_virtual;
      groups.back().origin_ticks = is_virtual ? 0 : streams[s]->header.start_ticks;
    }
    groups[it->second].streams.push_back(s);
    group_of_stream.push_back(it->second);
  }
  return groups;
}

struct Reading {
  std::uint64_t ticks;
  double ns;
  double round_trip_ns;
};

/// Readings that tie `group` to groups whose map is known, by time. Of those that are close
/// together the one with the shortest round trip stands.
std::vector<Reading> ReadingsOf(const Group& group,
                                std::span<const std::unique_ptr<Stream>> streams,
                                const std::map<std::int32_t, const Group*>& group_of_rank) {
  std::vector<Reading> all;
  for (const std::size_t s : group.streams) {
    for (const ClockSync& sync : streams[s]->syncs) {
      const auto it = group_of_rank.find(sync.remote_world_rank);
      if (it == group_of_rank.end() || it->second == &group || !it->second->map) continue;
      all.push_back({sync.local_ticks, it->second->map->Ns(sync.remote_ticks),
                     static_cast<double>(sync.round_trip_ticks) * group.ns_per_tick});
    }
  }
  std::ranges::sort(all, {}, &Reading::ticks);
  std::vector<Reading> kept;
  for (const Reading& r : all) {
    if (!kept.empty() && Signed(r.ticks, kept.back().ticks) * group.ns_per_tick < kShortSyncNs) {
      if (r.round_trip_ns < kept.back().round_trip_ns) kept.back() = r;
    } else {
      kept.push_back(r);
    }
  }
  return kept;
}

/// Ties one group to those known; false when nothing ties it.
bool TieGroup(Group& group, std::span<const std::unique_ptr<Stream>> streams,
              const std::map<std::int32_t, const Group*>& group_of_rank, ClockReport& report) {
  const std::vector<Reading> readings = ReadingsOf(group, streams, group_of_rank);
  if (readings.empty()) return false;
  std::vector<ClockMap::Point> points;
  for (const Reading& r : readings) {
    if (!points.empty() && r.ns <= points.back().ns) continue;  // damage: time does not go back
    points.push_back({r.ticks, r.ns});
    report.residual_ns = std::max(report.residual_ns, r.round_trip_ns / 2);
  }
  group.map.emplace(std::move(points), group.ns_per_tick);
  return true;
}

void TieByWallClock(Group& group, const Group& reference,
                    std::span<const std::unique_ptr<Stream>> streams) {
  const FileHeader& here = streams[group.streams.front()]->header;
  const FileHeader& there = streams[reference.streams.front()]->header;
  const double ns = reference.map->Ns(there.start_ticks) +
                    Signed(here.start_realtime_ns, there.start_realtime_ns);
  group.map.emplace(std::vector<ClockMap::Point>{{here.start_ticks, ns}}, group.ns_per_tick);
}

void TieGroups(std::vector<Group>& groups, std::span<const std::unique_ptr<Stream>> streams,
               ClockReport& report, TraceHealth& health) {
  std::map<std::int32_t, const Group*> group_of_rank;
  std::int32_t least_rank = std::numeric_limits<std::int32_t>::max();
  Group* reference = &groups.front();
  for (Group& group : groups) {
    for (const std::size_t s : group.streams) {
      if (!streams[s]->world) continue;
      group_of_rank.try_emplace(streams[s]->world->world_rank, &group);
      if (streams[s]->world->world_rank < least_rank) {
        least_rank = streams[s]->world->world_rank;
        reference = &group;
      }
    }
  }
  reference->map.emplace(std::vector<ClockMap::Point>{{reference->origin_ticks, 0}},
                         reference->ns_per_tick);
  // Readings may form a tree: a group may be tied to one that is itself tied.
  for (bool progress = true; progress;) {
    progress = false;
    for (Group& group : groups)
      if (!group.map && TieGroup(group, streams, group_of_rank, report)) progress = true;
  }
  for (Group& group : groups) {
    if (group.map) continue;
    TieByWallClock(group, *reference, streams);
    report.synchronised = false;
    health.Add(Defect::kClockUnsynchronised, streams[group.streams.front()]->host_name);
  }
  report.kind = reference->is_virtual ? ClockKind::kVirtual : ClockKind::kTsc;
  report.hz = 1e9 / reference->ns_per_tick;
}

}  // namespace

ClockMap::ClockMap(std::vector<Point> points, double outer_slope) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    double slope = segments_.empty() ? outer_slope : segments_.back().slope;
    if (i + 1 < points.size()) {
      const double ticks = Signed(points[i + 1].ticks, points[i].ticks);
      slope = ticks > 0 ? (points[i + 1].ns - points[i].ns) / ticks : outer_slope;
    }
    segments_.push_back({points[i], slope});
  }
}

double ClockMap::Ns(std::uint64_t ticks) const {
  std::size_t i = segments_.size() - 1;
  while (i > 0 && Signed(ticks, segments_[i].begin.ticks) < 0) --i;
  return segments_[i].begin.ns + Signed(ticks, segments_[i].begin.ticks) * segments_[i].slope;
}

std::uint64_t ClockMap::Ticks(double ns) const {
  std::size_t i = segments_.size() - 1;
  while (i > 0 && ns < segments_[i].begin.ns) --i;
  const double ticks = (ns - segments_[i].begin.ns) / segments_[i].slope;
  const double origin = static_cast<double>(segments_[i].begin.ticks);
  if (!(origin + ticks > 0)) return 0;
  if (origin + ticks >= 1.8e19) return std::numeric_limits<std::uint64_t>::max();
  return segments_[i].begin.ticks + static_cast<std::uint64_t>(std::llround(ticks));
}

double ClockMap::MeanSlope() const {
  const Segment& first = segments_.front();
  const Segment& last = segments_.back();
  const double ticks = Signed(last.begin.ticks, first.begin.ticks);
  return ticks > 0 ? (last.begin.ns - first.begin.ns) / ticks : first.slope;
}

Clocks CorrectClocks(std::span<const std::unique_ptr<Stream>> streams, TraceHealth& health) {
  Clocks clocks;
  if (streams.empty()) return clocks;
  std::vector<std::size_t> group_of_stream;
  std::vector<Group> groups = GroupsOf(streams, group_of_stream);
  for (Group& group : groups) group.ns_per_tick = RateOf(group, streams, health);
  TieGroups(groups, streams, clocks.report, health);
  clocks.report.computers = groups.size();
  for (const std::size_t g : group_of_stream) clocks.maps.push_back(*groups[g].map);
  return clocks;
}

}  // namespace stipple
