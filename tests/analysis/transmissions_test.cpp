// SPDX-License-Identifier: MIT
// Messages in a simulated network: each is joined with its send, and how many are there at a time
// is what can be computed on paper.
#include "analysis/stats/transmissions.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <variant>
#include <vector>

#include "analysis/stats/message_load.h"
#include "tests/analysis/mpi_ranks.h"

namespace stipple {
namespace {

using testing::Rank;
using testing::Ranks;
using testing::Written;

Transmission InNetwork(std::uint64_t told, std::uint64_t begin, std::uint64_t end,
                       std::uint64_t bytes, std::int32_t receiver) {
  return {0, told, begin, end, bytes, receiver, 0};
}

/// A broadcast whose message leaves when the next call begins, then two messages, the second of
/// them of another tag; 0 is the begin of the run, 1000 ticks.
Written Example() {
  std::vector<Rank> ranks = Ranks(2);
  ranks[0].Collective(testing::kBcast, 0, 2000, 2100);
  ranks[0].Send(1, 7, 2100, 2200, 84);
  ranks[0].stream.Append(InNetwork(2200, 2100, 2150, 24, 1));
  ranks[0].Send(1, 5, 2200, 2300, 40);
  ranks[0].stream.Append(InNetwork(3000, 2200, 2600, 100, 1));
  ranks[0].stream.Append(InNetwork(3000, 2300, 2800, 56, 1));
  ranks[0].End(4000);
  ranks[1].Collective(testing::kBcast, 0, 1500, 2250);
  ranks[1].Receive(0, 7, 2300, 2700, 84);
  ranks[1].Receive(0, 5, 2800, 3000, 40);
  ranks[1].End(4000);
  return Written(ranks);
}

using Row = std::vector<Cell>;
Row RowOfMessage(std::int64_t tag, std::int64_t bytes, double sent_s, double begin_s, double end_s,
                 double received_s) {
  return RowOf(std::int64_t{0}, std::int64_t{1}, tag, bytes, bytes + 16, sent_s, begin_s, end_s,
               received_s);
}

TEST(Transmissions, AreJoinedWithTheirMessages) {
  const Written written = Example();
  const Analysis analysis(written.trace);
  const TableAnswer answer = TransmissionsAnswer(analysis, {}, {});
  ASSERT_EQ(answer.table.rows.size(), 3U);
  const Row none = RowOf(std::int64_t{0}, std::int64_t{1}, std::monostate(), std::monostate(),
                         std::int64_t{24}, std::monostate(), 1.1e-6, 1.15e-6, std::monostate());
  EXPECT_EQ(answer.table.rows[0], none);
  EXPECT_EQ(answer.table.rows[1], RowOfMessage(7, 84, 1.1e-6, 1.2e-6, 1.6e-6, 1.7e-6));
  EXPECT_EQ(answer.table.rows[2], RowOfMessage(5, 40, 1.2e-6, 1.3e-6, 1.8e-6, 2e-6));
  EXPECT_EQ(answer.headline,
            "3 messages in the network; from send to receipt a message took 700 ns on the mean: "
            "100 ns to start, 450 ns in the network, 150 ns until it was taken.");
  Selection large;
  large.least_bytes = 50;
  EXPECT_EQ(TransmissionsAnswer(analysis, large, {}).table.rows.size(), 1U);
}

TEST(Transmissions, AreTheLoadOfTheNetwork) {
  const Written written = Example();
  const Analysis analysis(written.trace);
  const Table load = LoadTable(analysis, {}, {.window_ns = 1000});
  ASSERT_EQ(load.columns.back().name, "in_network");
  // Windows end at 250, 500, ... ns of the run.
  const auto at = [&load](std::size_t row) { return std::get<double>(load.rows[row].back()); };
  EXPECT_DOUBLE_EQ(at(3), 0);                   // until 2000 ticks
  EXPECT_DOUBLE_EQ(at(4), (50 + 50) / 1000.0);  // 2250: the broadcast's, and the first's begin
  EXPECT_DOUBLE_EQ(at(7), (50 + 400 + 500) / 1000.0);  // 3000: all of them
  EXPECT_DOUBLE_EQ(at(11), 0);
}

TEST(Transmissions, AreNullWhereNoMachineTold) {
  std::vector<Rank> ranks = Ranks(2);
  ranks[0].Send(1, 7, 2000, 2100);
  ranks[0].End(4000);
  ranks[1].Receive(0, 7, 1500, 2200);
  ranks[1].End(4000);
  const Written written(ranks);
  const Analysis analysis(written.trace);
  EXPECT_TRUE(TransmissionsAnswer(analysis, {}, {}).table.rows.empty());
  const Table load = LoadTable(analysis, {}, {.window_ns = 1000});
  for (const Row& row : load.rows) EXPECT_TRUE(std::holds_alternative<std::monostate>(row.back()));
}

}  // namespace
}  // namespace stipple
