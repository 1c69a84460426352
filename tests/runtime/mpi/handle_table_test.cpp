// SPDX-License-Identifier: MIT
#include "runtime/mpi/handle_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>
#include <thread>
#include <vector>

namespace stipple::mpi {

constinit bool threads_may_race = false;

namespace {

// Few keys, many of them with the same low bits, so that runs form, wrap and are cut in the middle.
TEST(HandleTable, KeepsWhatAMapKeeps) {
  HandleTable<int> table;
  std::map<std::uint64_t, int> expected;
  std::mt19937 random(1);
  for (int step = 0; step < 200000; ++step) {
    const std::uint64_t key = 0x10000 + 64 * (random() % 700);
    if (random() % 2 == 0) {
      table.Put(key, step);
      expected[key] = step;
    } else {
      table.RemoveIf(key, [](int) { return true; });
      expected.erase(key);
    }
    const std::uint64_t asked = 0x10000 + 64 * (random() % 700);
    int value = -1;
    ASSERT_EQ(table.Get(asked, &value), expected.contains(asked));
    if (expected.contains(asked)) {
      ASSERT_EQ(value, expected[asked]);
    }
  }
}

TEST(HandleTable, RemovesOnlyTheValueThatIsMeant) {
  HandleTable<int> table;
  table.Put(8, 1);
  table.Put(8, 2);  // the handle was reused before its first owner came to remove it
  table.RemoveIf(8, [](int value) { return value == 1; });
  int value = 0;
  EXPECT_TRUE(table.Get(8, &value));
  EXPECT_EQ(value, 2);
}

TEST(HandleTable, EmptyTableKnowsNothing) {
  HandleTable<int> table;
  int value = 0;
  EXPECT_FALSE(table.Get(8, &value));
  EXPECT_FALSE(table.Update(8, [](int&) {}));
  table.RemoveIf(8, [](int) { return true; });
}

TEST(HandleTable, ThreadsDoNotLoseEachOthersKeys) {
  threads_may_race = true;
  HandleTable<std::uint64_t> table;
  std::vector<std::jthread> threads;
  std::atomic<int> lost{0};
  for (std::uint64_t t = 1; t <= 4; ++t) {
    threads.emplace_back([&table, &lost, t] {
      for (std::uint64_t i = 1; i <= 20000; ++i) {
        const std::uint64_t key = (i << 8) + t;
        table.Put(key, i);
        std::uint64_t value = 0;
        if (!table.Get(key, &value) || value != i) ++lost;
        if (i % 3 != 0) table.RemoveIf(key, [](std::uint64_t) { return true; });
      }
    });
  }
  threads.clear();
  threads_may_race = false;
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace stipple::mpi
