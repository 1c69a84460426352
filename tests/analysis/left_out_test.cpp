// SPDX-License-Identifier: MIT
// What people are told of a run that could not record all of its functions.
#include <gtest/gtest.h>

#include "analysis/report/left_out.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

std::vector<std::string> TextsWhen(std::string_view what, bool available) {
  testing::TemporaryArchive archive;
  testing::StreamWriter stream(1);
  stream.Region(1, "main");
  Availability record{};
  record.available = available ? 1 : 0;
  record.what_bytes = static_cast<std::uint32_t>(what.size());
  stream.Define(record, std::string(what));
  stream.Enter(1, 2000);
  stream.Leave(1, 3000);
  stream.End(4000);
  archive.Add(stream);
  return LeftOutTexts(Trace::Open(archive.path()));
}

TEST(LeftOutTexts, SayThatRegionIdsRanOut) {
  EXPECT_EQ(
      TextsWhen("region ids", false),
      std::vector<std::string>{
          "more than 8,388,351 functions: those that came later have no id and are left out"});
  EXPECT_TRUE(TextsWhen("region ids", true).empty());
  EXPECT_TRUE(TextsWhen("context switches", false).empty());
}

}  // namespace
}  // namespace stipple
