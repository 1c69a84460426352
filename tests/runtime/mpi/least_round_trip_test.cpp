// SPDX-License-Identifier: MIT
#include "runtime/mpi/least_round_trip.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <random>

namespace stipple::mpi {
namespace {

/// Two clocks that differ by `offset`, and a network with a random delay each way.
struct Network {
  std::uint64_t now = 1'000'000;
  std::int64_t offset = 0;
  int least_delay = 500;
  int most_jitter = 20000;
  std::mt19937 random{7};

  void Travel() {
    // Now and then a message gets through without waiting.
    const bool clear = random() % 8 == 0;
    const auto jitter = static_cast<unsigned>(clear ? 20 : most_jitter);
    now += static_cast<unsigned>(least_delay) + random() % jitter;
  }
};

ClockReading Read(Network& network, std::uint32_t tries) {
  const ClockPeer peer = {&network,
                          [](void* context) { return static_cast<Network*>(context)->now; },
                          [](void* context) {
                            auto& n = *static_cast<Network*>(context);
                            n.Travel();
                            const auto remote = n.now + static_cast<std::uint64_t>(n.offset);
                            n.Travel();
                            return remote;
                          }};
  return LeastRoundTrip(peer, tries);
}

std::int64_t ErrorOf(const Network& network, const ClockReading& reading) {
  return static_cast<std::int64_t>(reading.remote_ticks - reading.local_ticks) - network.offset;
}

TEST(LeastRoundTrip, IsWrongByAtMostHalfTheRoundTrip) {
  for (const std::int64_t offset : {0l, 123456789l, -500000l}) {
    for (const std::uint32_t tries : {1u, 2u, 10u, 100u}) {
      Network network{.offset = offset};
      const ClockReading reading = Read(network, tries);
      EXPECT_LE(std::abs(ErrorOf(network, reading)),
                static_cast<std::int64_t>(reading.round_trip_ticks / 2 + 1));
    }
  }
}

TEST(LeastRoundTrip, ManyTriesFindAClearNetwork) {
  Network network{.offset = 4242};
  EXPECT_LT(std::abs(ErrorOf(network, Read(network, 100))), 50);
}

}  // namespace
}  // namespace stipple::mpi
