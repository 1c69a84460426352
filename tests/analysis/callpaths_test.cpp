// SPDX-License-Identifier: MIT
// Call paths of programs that have more of them than anybody can read.
#include "analysis/stats/callpaths.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

/// main calls each of `fan` functions, each of which calls all of them but itself, so there are
/// 1 + fan * fan paths, and as many calls; each call lasts 1 tick longer than what it calls.
struct Fan {
  explicit Fan(std::uint32_t fan) : stream(1) {
    stream.Region(1, "main");
    for (std::uint32_t r = 2; r < 2 + fan; ++r) stream.Region(r, "f" + std::to_string(r));
    std::uint64_t now = 1000;
    stream.NewChunk(now);
    stream.Enter(1, ++now);
    for (std::uint32_t outer = 2; outer < 2 + fan; ++outer) {
      stream.Enter(outer, ++now);
      for (std::uint32_t inner = 2; inner < 2 + fan; ++inner) {
        if (inner == outer) continue;
        stream.Enter(inner, ++now);
        stream.Leave(inner, ++now);
      }
      stream.Leave(outer, ++now);
    }
    stream.Leave(1, ++now);
    stream.End(now);
    archive.Add(stream);
  }
  StreamWriter stream;
  TemporaryArchive archive;
};

struct Sum {
  std::uint64_t calls = 0;
  std::uint64_t folded = 0;
  double exclusive_ns = 0;
};
Sum SumOf(const CallPaths& paths) {
  Sum sum;
  for (const PathTree::Node& n : paths.events.nodes()) {
    sum.calls += n.own.calls;
    sum.folded += n.own.folded;
    sum.exclusive_ns += n.own.exclusive_ns;
  }
  return sum;
}

TEST(CallPaths, NothingIsFoldedAsLongAsThereIsRoom) {
  const Fan program(30);
  const Trace trace = Trace::Open(program.archive.path());
  const Analysis analysis(trace);
  const CallPaths paths = CallPathsOf(analysis, {});
  EXPECT_EQ(paths.events.nodes().size(), 1U + 1 + 30 * 30);  // and the root
  EXPECT_EQ(SumOf(paths).calls, 1U + 30 * 30);
  EXPECT_EQ(paths.folded, 0U);
  EXPECT_EQ(FoldedText(paths), "");
  const TableAnswer answer = CallPathsAnswer(analysis, {}, {});
  EXPECT_EQ(answer.table.columns.back().name, "samples");
  EXPECT_EQ(answer.headline.find("would have led"), std::string::npos);
}

TEST(CallPaths, WhatIsFoldedIsCountedAndItsTimeIsTheCallers) {
  constexpr std::uint32_t kFan = 100;  // 10,001 paths
  const Fan program(kFan);
  const Trace trace = Trace::Open(program.archive.path());
  const Analysis analysis(trace);
  for (const bool whole : {true, false}) {
    Selection selection;
    if (!whole) selection.end_ns = trace.SpanNs() + 1;
    const CallPaths paths = CallPathsOf(analysis, selection);
    EXPECT_EQ(paths.events.nodes().size(), kMostPaths);
    EXPECT_EQ(paths.folded, 1U + kFan * kFan - (kMostPaths - 1));
    const Sum sum = SumOf(paths);
    EXPECT_EQ(sum.calls + sum.folded, 1U + kFan * kFan);
    EXPECT_EQ(sum.folded, paths.folded);
    EXPECT_DOUBLE_EQ(sum.exclusive_ns, static_cast<double>(trace.SpanNs()));
    EXPECT_EQ(paths.events.nodes()[1].name, "main");
    EXPECT_GT(paths.events.nodes()[1].own.folded, 0U);
  }
  const TableAnswer answer = CallPathsAnswer(analysis, {}, {});
  EXPECT_EQ(answer.table.columns.back().name, "folded_calls");
  EXPECT_NE(answer.headline.find("5,002 calls"), std::string::npos) << answer.headline;
  EXPECT_NE(answer.headline.find("5,000 paths of a thread"), std::string::npos) << answer.headline;
  for (const std::vector<Cell>& row : answer.table.rows)
    EXPECT_EQ(row.size(), answer.table.columns.size());
}

}  // namespace
}  // namespace stipple
