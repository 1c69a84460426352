// SPDX-License-Identifier: MIT
// All tables: spans side by side and ranks one by one sum up to the whole, what cannot be limited
// so is told, and each has its columns in each format, of whatever archive.
#include "analysis/stats/tables.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "analysis/report/text.h"
#include "analysis/stats/message_load.h"
#include "analysis/stats/near_names.h"
#include "analysis/stats/states.h"
#include "analysis/stats/time_steps.h"
#include "analysis/stats/utilisation.h"
#include "analysis/trace/input_error.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

enum : std::uint32_t { kMain = 1, kWork, kHelp, kSend, kReceive, kBarrier };
constexpr std::uint64_t kBegin = 1000;
constexpr std::uint64_t kRound = 20'000;

/// Ranks that compute, send in a ring and meet at a barrier, again and again. All times are even,
/// so that no event lies on an odd one.
class Ring {
 public:
  Ring(int ranks, int rounds, unsigned seed) : size_(ranks), random_(seed) {
    for (int r = 0; r < ranks; ++r) streams_.push_back(Begin(r));
    for (int i = 0; i < rounds; ++i) Round(kBegin + static_cast<std::uint64_t>(i) * kRound);
    const std::uint64_t end = kBegin + static_cast<std::uint64_t>(rounds) * kRound;
    for (StreamWriter& s : streams_) {
      s.Leave(kMain, end);
      s.End(end);
      archive.Add(s);
    }
  }
  TemporaryArchive archive;

 private:
  StreamWriter Begin(int rank) const {
    StreamWriter s(static_cast<std::uint32_t>(rank + 1));
    s.World(rank, size_);
    s.Region(kMain, "main");
    s.Region(kWork, "Work(int, double)");
    s.Region(kHelp, "Solver::Help()");
    s.Region(kSend, "MPI_Send", RegionKind::kMpi);
    s.Region(kReceive, "MPI_Recv", RegionKind::kMpi);
    s.Region(kBarrier, "MPI_Barrier", RegionKind::kMpi);
    if (rank == size_ - 1 && size_ > 2) s.Define(DefineHost{});
    s.NewChunk(kBegin);
    s.Enter(kMain, kBegin);
    return s;
  }
  std::uint64_t Some(std::uint64_t most) { return random_() % (most / 2) * 2; }
  void Round(std::uint64_t base) {
    std::vector<std::uint64_t> sent;
    for (int r = 0; r < size_; ++r) sent.push_back(base + 4000 + Some(6000));
    for (int r = 0; r < size_; ++r) {
      StreamWriter& s = streams_[static_cast<std::size_t>(r)];
      const int to = (r + 1) % size_;
      const int from = (r + size_ - 1) % size_;
      // The k-th message of a rank has a tag and a size of its own, on both sides.
      const auto tag = static_cast<std::int32_t>(base / kRound % 3);
      const std::uint64_t bytes = base / kRound % 5 == 0 ? 0 : base / kRound * 37;
      s.Enter(kWork, base + Some(1000));
      s.Enter(kHelp, base + 1000 + Some(1000));
      s.Leave(kHelp, base + 2000 + Some(1000));
      s.Leave(kWork, base + 3000 + Some(1000));
      const std::uint64_t at = sent[static_cast<std::size_t>(r)];
      s.Enter(kSend, at);
      s.Append(MpiSend{0, at, bytes, 1, to, tag, 0});
      s.Leave(kSend, at + 20);
      const std::uint64_t enter = at + 20 + Some(2000);
      const std::uint64_t got = std::max(enter, sent[static_cast<std::size_t>(from)]) + 50;
      s.Enter(kReceive, enter);
      s.Append(MpiReceive{0, got, bytes, 1, from, tag, 0});
      s.Leave(kReceive, got);
      const std::uint64_t barrier = base + 14'000 + Some(3000);
      s.Enter(kBarrier, barrier);
      s.Append(MpiCollective{0, barrier, 0, 0, 1, -1, kBarrier, 0});
      s.Leave(kBarrier, base + 17'000);
    }
  }

  int size_;
  std::mt19937 random_;
  std::vector<StreamWriter> streams_;
};

const TableEntry& Entry(std::string_view name) {
  const auto found = std::ranges::find(TableEntries(), name, &TableEntry::name);
  EXPECT_NE(found, TableEntries().end()) << name;
  return *found;
}

/// Sums of a table's numbers: of the value columns, by the texts of the key columns.
struct Additive {
  std::string_view table;
  std::vector<std::string> keys;
  std::vector<std::string> values;
  bool by_ranks = true;
};
const std::vector<Additive> kAdditive = {
    {"profile", {"region"}, {"calls", "inclusive_s", "exclusive_s"}},
    {"callpaths", {"path"}, {"calls", "inclusive_s", "exclusive_s", "messages", "bytes"}},
    {"states", {"rank"}, {"user_s", "message_s", "idle_s"}},
    {"sizes", {"low", "high"}, {"messages", "bytes"}},
    {"types", {"tag"}, {"messages", "bytes"}},
    {"load", {}, {"messages", "bytes"}},
    {"waits", {"waiter"}, {"seconds"}},
    {"messages", {"sender"}, {"0", "1", "2", "host"}, false},
    {"volume", {"sender"}, {"0", "1", "2", "host"}, false},
    {"wait", {"waiter"}, {}, false}};
using Sums = std::map<std::string, std::vector<double>>;

std::string KeyText(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return std::to_string(*whole);
  std::string path;
  if (const auto* names = std::get_if<std::vector<std::string>>(&cell))
    for (const std::string& name : *names) path += "/" + name;
  return path;
}
double Number(const Cell& cell) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  return 0;
}

void AddSums(const Additive& what, const Analysis& analysis, const Selection& selection,
             Sums& sums) {
  const Table table = Entry(what.table).make(analysis, selection, {}).table;
  const auto column = [&table](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(table.columns, name, &Column::name) -
                                    table.columns.begin());
  };
  for (const auto& row : table.rows) {
    std::string key;
    for (const std::string& k : what.keys) key += KeyText(row.at(column(k))) + "|";
    std::vector<double>& sum = sums[key];
    sum.resize(what.values.size());
    for (std::size_t v = 0; v < what.values.size(); ++v)
      sum[v] += Number(row.at(column(what.values[v])));
  }
}

void ExpectSame(const Sums& whole, const Sums& parts, std::string_view table) {
  for (const auto& [key, values] : whole) {
    const auto part = parts.find(key);
    for (std::size_t v = 0; v < values.size(); ++v)
      EXPECT_NEAR(part == parts.end() ? 0 : part->second[v], values[v], 3e-8)
          << table << ' ' << key << ' ' << v;
  }
  for (const auto& [key, values] : parts)
    if (!whole.contains(key)) {
      for (const double v : values) EXPECT_EQ(v, 0) << table << ' ' << key;
    }
}

TEST(Tables, SpansSideBySideSumUpToTheWhole) {
  const Ring ring(4, 12, 1);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  const std::vector<std::int64_t> cuts = {0, 7, 33'333, 60'001, 101'113, 180'007};
  for (const Additive& what : kAdditive) {
    Sums whole, parts;
    AddSums(what, analysis, {}, whole);
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      Selection part;
      part.begin_ns = cuts[i];
      if (i + 1 < cuts.size()) part.end_ns = cuts[i + 1];
      AddSums(what, analysis, part, parts);
    }
    EXPECT_FALSE(whole.empty()) << what.table;
    ExpectSame(whole, parts, what.table);
  }
}

TEST(Tables, RanksOneByOneSumUpToTheWhole) {
  const Ring ring(4, 6, 2);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  for (const Additive& what : kAdditive) {
    if (!what.by_ranks) continue;
    Sums whole, parts;
    AddSums(what, analysis, {}, whole);
    for (int rank = 0; rank < 4; ++rank) {
      Selection part;
      part.ranks = {rank};
      AddSums(what, analysis, part, parts);
    }
    ExpectSame(whole, parts, what.table);
  }
}

TEST(Tables, MessagesOfEachSizeAndTagSumUpToAll) {
  const Ring ring(3, 10, 3);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  for (const Additive& what : kAdditive) {
    if ((Entry(what.table).takes & kTakesMessages) == 0 || what.table == "waits" ||
        what.table == "wait")
      continue;
    Sums whole, by_size, by_tag;
    Additive here = what;
    if (what.table == "messages" || what.table == "volume") here.values = {"0", "1", "host"};
    AddSums(here, analysis, {}, whole);
    for (const auto& [least, most] :
         std::vector<std::pair<std::uint64_t, std::uint64_t>>{{0, 0}, {1, 100}, {101, 1'000'000}}) {
      Selection part;
      part.least_bytes = least;
      part.most_bytes = most;
      AddSums(here, analysis, part, by_size);
    }
    for (std::int32_t tag = 0; tag < 3; ++tag) {
      Selection part;
      part.tags = {{tag, tag}};
      AddSums(here, analysis, part, by_tag);
    }
    ExpectSame(whole, by_size, what.table);
    ExpectSame(whole, by_tag, what.table);
  }
}

TEST(Tables, WaitsForMessagesOfEachTagAreAllWaitsForMessages) {
  const Ring ring(4, 12, 12);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  double all = 0, by_tag = 0;
  for (const auto& row : Entry("waits").make(analysis, {}, {}).table.rows)
    if (KeyText(row[0]).starts_with("late-")) all += Number(row[3]);
  for (std::int32_t tag = 0; tag < 3; ++tag) {
    Selection part;
    part.tags = {{tag, tag}};
    for (const auto& row : Entry("waits").make(analysis, part, {}).table.rows)
      by_tag += Number(row[3]);
  }
  EXPECT_GT(all, 0);
  EXPECT_NEAR(by_tag, all, 1e-12);
  Selection none;
  none.tags = {{77, 77}};
  EXPECT_TRUE(Entry("waits").make(analysis, none, {}).table.rows.empty());
}

TEST(Tables, RegionsTakeTheirRowsAndPaths) {
  const Ring ring(2, 4, 4);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  Selection some;
  some.regions = ParseRegions(trace, "Solver::*");
  const Table profile = Entry("profile").make(analysis, some, {}).table;
  ASSERT_EQ(profile.rows.size(), 1U);
  EXPECT_EQ(KeyText(profile.rows[0][0]), "Solver::Help()");
  some.regions = ParseRegions(trace, "Work");
  const Table paths = Entry("callpaths").make(analysis, some, {}).table;
  ASSERT_EQ(paths.rows.size(), 3U);
  EXPECT_EQ(KeyText(paths.rows[0][0]), "/main");
  EXPECT_EQ(Number(paths.rows[0][1]), 0);  // of main only what passes Work counts
  EXPECT_EQ(Number(paths.rows[0][2]), Number(paths.rows[1][2]));
  EXPECT_EQ(KeyText(paths.rows[2][0]), "/main/Work(int, double)/Solver::Help()");
  EXPECT_EQ(Number(paths.rows[2][1]), 8);
}

TEST(Series, UtilisationEndsWithTheSharesOfStates) {
  const Ring ring(4, 9, 5);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  for (const auto& [begin, end] : std::vector<std::pair<std::int64_t, std::int64_t>>{
           {0, Selection::kNoEnd}, {12'345, 99'999}}) {
    for (const std::int64_t window : {std::int64_t{0}, std::int64_t{777}, std::int64_t{50'000}}) {
      Selection part;
      part.begin_ns = begin;
      part.end_ns = end;
      const auto span = static_cast<double>(std::min(end, trace.SpanNs()) - begin);
      double mean = 0;
      for (const RankStates& s : StatesOf(analysis, part))
        if (!trace.IsHost(s.rank)) mean += static_cast<double>(s.user_ns) / span / 3;
      const Table table = UtilisationTable(analysis, part, {false, window});
      ASSERT_FALSE(table.rows.empty());
      EXPECT_LE(table.rows.size(), kMostSteps + 1);
      EXPECT_NEAR(Number(table.rows.back()[2]), mean, 1e-9);
      for (const auto& row : table.rows) {
        EXPECT_LE(Number(row[3]), Number(row[1]) + 1e-12);
        EXPECT_GE(Number(row[4]), Number(row[1]) - 1e-12);
        EXPECT_LE(Number(row[4]), 1);
      }
    }
  }
}

TEST(Series, WindowsAreSumsOfTheirStates) {
  const Ring ring(3, 5, 6);
  const Trace trace = Trace::Open(ring.archive.path());
  const Analysis analysis(trace);
  constexpr std::int64_t kWindow = 9'001;
  const Table table = UtilisationTable(analysis, {}, {true, kWindow});
  for (std::size_t i = 0; i < table.rows.size(); i += 7) {
    const auto& row = table.rows[i];
    const std::int64_t at = std::llround(Number(row[0]) * 1e9);
    Selection window;
    window.begin_ns = std::max<std::int64_t>(0, at - kWindow);
    window.end_ns = at;
    window.ranks = {static_cast<int>(Number(row[1]))};
    const RankStates s = StatesOf(analysis, window).front();
    EXPECT_NEAR(Number(row[2]),
                static_cast<double>(s.user_ns) / static_cast<double>(at - window.begin_ns), 1e-9);
  }
}

TEST(Series, StatusSharesAreOfTheStep) {
  const Ring ring(3, 5, 7);
  const Trace trace = Trace::Open(ring.archive.path());
  const Table table = StatusTable(Analysis(trace), {}, {});
  for (const auto& row : table.rows) {
    EXPECT_TRUE(std::holds_alternative<std::monostate>(row[4]));  // nothing told of system time
    EXPECT_NEAR(Number(row[3]) + Number(row[5]) + Number(row[6]), 1, 1e-9);
    EXPECT_NE(KeyText(row[2]), "");
  }
}

TEST(Series, RoundWindows) {
  EXPECT_EQ(RoundWindowNs(40'000'000'000), 1'000'000'000);
  EXPECT_EQ(RoundWindowNs(1'660'000'000), 50'000'000);
  EXPECT_EQ(RoundWindowNs(0), 1);
  EXPECT_EQ(RoundWindowNs(36'000'000'000'000), 1'000'000'000'000);
}

TEST(Selection, ListsAreUnderstoodOrRefused) {
  EXPECT_EQ(ParseSizes("1k-64k"), (std::pair<std::uint64_t, std::uint64_t>{1024, 65536}));
  EXPECT_EQ(ParseSizes("8"), (std::pair<std::uint64_t, std::uint64_t>{8, 8}));
  EXPECT_EQ(ParseSizes("-100").first, 0U);
  EXPECT_EQ(ParseSizes("1M-").second, std::numeric_limits<std::uint64_t>::max());
  for (const char* wrong : {"", "-", "k", "1x", "64-8", "1k-2k-3k", "9999999999999G", "-1-2"})
    EXPECT_THROW(ParseSizes(wrong), InputError) << wrong;
  EXPECT_EQ(ParseTags("3,7-9").size(), 2U);
  for (const char* wrong : {"", ",", "x", "3-", "9-7", "-1"})
    EXPECT_THROW(ParseTags(wrong), InputError) << wrong;
  const Ring ring(3, 1, 8);
  const Trace trace = Trace::Open(ring.archive.path());
  EXPECT_EQ(ParseRanks(trace, "0-1,host"), (std::vector<int>{0, 1, 2}));
  for (const char* wrong : {"", "3", "0-9", "x", "1-0"})
    EXPECT_THROW(ParseRanks(trace, wrong), InputError) << wrong;
  EXPECT_EQ(ParseRegions(trace, "Work(int, double),main").regions.size(), 2U);
  EXPECT_EQ(ParseRegions(trace, "MPI_*").regions.size(), 3U);
  try {
    ParseRegions(trace, "wrok");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("near it: Work"), std::string::npos) << e.what();
  }
}

/// Columns that scripts rely on; a table that is not here has none that are promised.
const std::map<std::string_view, std::string_view> kPromised = {
    {"profile",
     "region file line calls inclusive_s exclusive_s exclusive_low_s exclusive_high_s "
     "inclusive_low_s inclusive_high_s"},
    {"states", "rank user_s system_s message_s idle_s"},
    {"waits", "kind waiter culprit seconds region"},
    {"imbalance", "max_over_mean idle_share cause sentence"},
    {"sizes", "low high messages bytes"},
    {"types", "tag messages bytes"},
    {"load",
     "time_s messages bytes messages_per_s bytes_per_s since_start_messages_per_s "
     "since_start_bytes_per_s in_network"},
    {"transmissions", "sender receiver tag bytes network_bytes sent_s begin_s end_s received_s"},
    {"utilisation", "time_s window since_start least most"},
    {"status", "time_s rank state user system message idle"}};

std::vector<std::vector<std::string>> CsvCells(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (quoted && c == '"' && i + 1 < csv.size() && csv[i + 1] == '"') {
      row.back() += csv[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      row.emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back(std::move(row));
      row.assign(1, "");
    } else {
      row.back() += c;
    }
  }
  EXPECT_FALSE(quoted);
  return rows;
}

using Json = nlohmann::ordered_json;

void ExpectCell(const Json& json, const std::string& csv, std::string_view table) {
  if (json.is_null()) {
    EXPECT_EQ(csv, "") << table;
  } else if (json.is_number()) {
    EXPECT_NEAR(std::stod(csv), json.get<double>(),
                1e-9 * std::max(1.0, std::abs(json.get<double>())))
        << table;
  } else if (json.is_array()) {
    std::string joined;
    for (const Json& name : json) joined += (joined.empty() ? "" : ";") + name.get<std::string>();
    EXPECT_EQ(csv, joined) << table;
  } else {
    EXPECT_EQ(csv, json.get<std::string>()) << table;
  }
}

/// JSON parses and has the columns; CSV has the same cells; text has a line for each row.
void ExpectFormats(const TableEntry& entry, const Table& table, bool promised) {
  const Json json = Json::parse(TableJson(table));
  const auto csv = CsvCells(TableCsv(table));
  ASSERT_FALSE(csv.empty()) << entry.name;
  std::string columns;
  for (const Column& c : table.columns) columns += (columns.empty() ? "" : " ") + c.name;
  if (promised && kPromised.contains(entry.name)) {
    EXPECT_EQ(columns, kPromised.at(entry.name));
  }
  ASSERT_EQ(csv.front().size(), table.columns.size()) << entry.name;
  ASSERT_EQ(csv.size(), table.rows.size() + 1) << entry.name;
  const std::string text = TableText(table);
  if (table.shape != TableShape::kTree) {
    EXPECT_EQ(std::ranges::count(text, '\n'), static_cast<std::ptrdiff_t>(table.rows.size()) + 1)
        << entry.name;
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    ASSERT_EQ(csv[r + 1].size(), table.columns.size()) << entry.name;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const std::string& name = table.columns[c].name;
      const Json& cell =
          table.shape == TableShape::kMatrix
              ? (c == 0 ? json.at("rows").at(r) : json.at("values").at(r).at(c - 1))
              : (table.shape == TableShape::kObject ? json.at(name) : json.at(r).at(name));
      ExpectCell(cell, csv[r + 1][c], entry.name);
    }
  }
}

void ExpectAllFormats(const std::string& archive) {
  const Trace trace = Trace::Open(archive);
  const Analysis analysis(trace);
  for (const TableEntry& entry : TableEntries()) {
    const TableAnswer answer = entry.make(analysis, {}, {});
    EXPECT_FALSE(answer.headline.empty()) << entry.name;
    ExpectFormats(entry, answer.table, true);
    if (entry.per_rank) ExpectFormats(entry, entry.make(analysis, {}, {true, 0}).table, false);
    if ((entry.takes & kTakesWindow) != 0)
      ExpectFormats(entry, entry.make(analysis, {}, {false, 5'000}).table, false);
    Selection nothing;
    nothing.begin_ns = nothing.end_ns = 1'000'000'000'000;
    ExpectFormats(entry, entry.make(analysis, nothing, {}).table, false);
  }
}

std::string Damaged(std::string bytes, unsigned seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < 40; ++i)
    bytes[kGranuleBytes + random() % (bytes.size() - kGranuleBytes)] ^= static_cast<char>(random());
  bytes.resize(bytes.size() - random() % (bytes.size() / 2));
  return bytes;
}

TEST(Formats, OfARun) { ExpectAllFormats(Ring(4, 8, 9).archive.path()); }
TEST(Formats, OfOneRank) { ExpectAllFormats(Ring(1, 3, 10).archive.path()); }
TEST(Formats, OfNothing) { ExpectAllFormats(TemporaryArchive().path()); }

TEST(Formats, OfOneEvent) {
  TemporaryArchive archive;
  StreamWriter s(1);
  s.Region(kMain, "a \"main\", of\nlines");
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  s.End(1000);
  archive.Add(s);
  ExpectAllFormats(archive.path());
}

TEST(Formats, OfARunWithoutLength) {
  TemporaryArchive archive;
  StreamWriter s(1);
  s.World(0, 1);
  s.Region(kMain, "main");
  s.Region(kSend, "MPI_Send", RegionKind::kMpi);
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  s.Enter(kSend, 1000);
  s.Append(MpiSend{0, 1000, std::uint64_t{1} << 63, 1, 0, 0, 0});
  s.Leave(kSend, 1000);
  s.Leave(kMain, 1000);
  s.End(1000);
  archive.Add(s);
  ExpectAllFormats(archive.path());
}

TEST(Formats, OfDamagedRuns) {
  const Ring ring(3, 6, 11);
  for (unsigned seed = 0; seed < 20; ++seed) {
    TemporaryArchive damaged;
    for (const auto& file : std::filesystem::directory_iterator(ring.archive.path())) {
      std::ifstream in(file.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(in), {}};
      damaged.AddBytes(file.path().filename().string(), Damaged(bytes, seed++));
    }
    ExpectAllFormats(damaged.path());
  }
}

}  // namespace
}  // namespace stipple
