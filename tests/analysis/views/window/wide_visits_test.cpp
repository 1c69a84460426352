// SPDX-License-Identifier: MIT
// A view that is moved shows the visits that the source would name for it.
#include "analysis/views/window/wide_visits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "tests/analysis/views/window/fake_source.h"

namespace stipple {
namespace {

TEST(WideVisits, AreThoseOfTheSource) {
  const testing::FakeSource source;
  WideVisits few, many;
  std::mt19937_64 random(11);
  int complete = 0;
  std::int64_t begin = 2'000'000'000, length = 1'000'000'000;
  for (int i = 0; i < 500; ++i) {
    begin = std::clamp<std::int64_t>(
        begin + static_cast<std::int64_t>(random() % 600'000'000) - 300'000'000, 0, 9'000'000'000);
    if (i % 20 == 0) length = 1 + static_cast<std::int64_t>(random() % 3'000'000'000);
    const std::size_t most = i % 3 == 0 ? 5 : 100;
    const VisitsOfSpan asked = source.VisitsOf(0, begin, begin + length, most);
    const VisitsOfSpan found = (most == 5 ? few : many).Of(source, 0, begin, begin + length, most);
    if (found.complete) ++complete;
    ASSERT_TRUE(asked.complete || !found.complete) << i;
    if (!found.complete) continue;
    ASSERT_EQ(found.visits.size(), asked.visits.size()) << i;
    for (std::size_t k = 0; k < found.visits.size(); ++k) {
      EXPECT_EQ(found.visits[k].begin_ns, asked.visits[k].begin_ns);
      EXPECT_EQ(found.visits[k].region, asked.visits[k].region);
    }
  }
  EXPECT_GT(complete, 250) << "most are few enough";
}

}  // namespace
}  // namespace stipple
