// SPDX-License-Identifier: MIT
// The scan of a thread's events, on streams made at random: taken up again at any place it goes on
// as if it had not stopped.
#include "analysis/trace/scan.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "analysis/stats/profile_visitor.h"
#include "tests/analysis/random_stream.h"

namespace stipple {
namespace {

using testing::RandomStream;

constexpr std::uint64_t kSeeds = 60;
constexpr std::size_t kWords = 20'000;

/// From none to many.
int OddsOf(std::uint64_t seed) { return static_cast<int>(seed % 4 == 0 ? 0 : 3 << (seed % 11)); }

/// Writes down what it sees.
struct Recorder {
  using Seen = std::tuple<std::uint32_t, bool, std::uint64_t, const EventWord*>;
  std::vector<Seen> seen;
  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    seen.emplace_back(region, leave, ticks, nullptr);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    seen.emplace_back(0, false, ticks, record);
  }
};

TEST(Scan, GoesOnFromAnyPlace) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomStream stream(seed, OddsOf(seed), kWords);
    Recorder whole;
    std::vector<std::pair<ScanPlace, std::size_t>> places;
    ScanThread(
        stream.thread, RandomStream::kRegions, whole, [](std::uint64_t) {}, 500,
        [&](const ScanPosition& at) { places.emplace_back(at.Place(), whole.seen.size()); });
    ASSERT_GT(places.size(), kWords / 1000);
    for (std::size_t i = 0; i < places.size(); i += 1 + places.size() / 7) {
      Recorder rest;
      ScanPosition at(places[i].first);
      ScanCounts counts;
      while (ScanSome(stream.thread, RandomStream::kRegions, 777, at, counts, rest)) {
      }
      const auto from = whole.seen.begin() + static_cast<std::ptrdiff_t>(places[i].second);
      ASSERT_EQ(std::vector(from, whole.seen.end()), rest.seen) << "seed " << seed;
    }
  }
}

TEST(Scan, TellsTheOpenStackBetweenParts) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomStream stream(seed, 0, kWords);  // every event is in its place
    Recorder recorder;
    std::vector<std::size_t> seen;
    const auto ignore = [](std::uint64_t) {};
    ScanThread(stream.thread, RandomStream::kRegions, recorder, ignore, 500,
               [&](const ScanPosition&) { seen.push_back(recorder.seen.size()); });
    ProfileVisitor visitor(RandomStream::kRegions, 0, kNoTickLimit, nullptr);
    std::vector<std::uint32_t> open;
    std::size_t part = 0;
    std::size_t event = 0;
    ScanThread(stream.thread, RandomStream::kRegions, visitor, ignore, 500,
               [&](const ScanPosition&) {
                 for (; event < seen[part]; ++event) {
                   const auto& [region, leave, ticks, record] = recorder.seen[event];
                   if (leave)
                     open.pop_back();
                   else
                     open.push_back(region);
                 }
                 ++part;
                 ASSERT_EQ(open, visitor.OpenStack());
                 ASSERT_TRUE(visitor.IsPlain());
               });
    EXPECT_EQ(part, seen.size());
  }
}

}  // namespace
}  // namespace stipple
