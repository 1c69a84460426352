// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "analysis/report/progress_text.h"
#include "analysis/report/text.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/message_matrix.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/region_columns.h"
#include "analysis/stats/states.h"
#include "analysis/stats/tables.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/trace/ranks.h"
#include "tests/analysis/archive_writer.h"
#include "tests/analysis/ring.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

enum : std::uint32_t { kMain = 1, kWork, kHelp, kSend, kReceive, kWait, kBarrier, kSendrecv };

/// A rank of an MPI program that lives from `begin` to `end`.
class Rank {
 public:
  Rank(std::int32_t rank, std::int32_t size) : stream(static_cast<std::uint32_t>(rank + 1)) {
    stream.World(rank, size);
    for (const auto& [id, name] :
         std::map<std::uint32_t, std::string>{{kMain, "main"}, {kWork, "work"}, {kHelp, "help"}})
      stream.Region(id, name);
    for (const auto& [id, name] : std::map<std::uint32_t, std::string>{{kSend, "MPI_Send"},
                                                                       {kReceive, "MPI_Recv"},
                                                                       {kWait, "MPI_Waitall"},
                                                                       {kBarrier, "MPI_Barrier"},
                                                                       {kSendrecv, "MPI_Sendrecv"}})
      stream.Region(id, name, RegionKind::kMpi);
    stream.NewChunk(1000);
    stream.Enter(kMain, 1000);
  }
  void End(std::uint64_t ticks) {
    stream.Leave(kMain, ticks);
    stream.End(ticks);
  }
  void Call(std::uint32_t region, std::uint64_t begin, std::uint64_t end,
            const std::function<void()>& inside = {}) {
    stream.Enter(region, begin);
    if (inside) inside();
    stream.Leave(region, end);
  }
  void Send(std::int32_t to, std::int32_t tag, std::uint64_t begin, std::uint64_t end,
            std::uint64_t bytes = 8) {
    Call(kSend, begin, end, [&] { stream.Append(MpiSend{0, begin, bytes, 1, to, tag, 0}); });
  }
  void Post(std::uint32_t request, std::uint64_t ticks) {
    stream.Append(MpiReceivePost{0, ticks, 1, request});
  }
  void Received(std::int32_t from, std::int32_t tag, std::uint64_t ticks, std::uint32_t request = 0,
                std::uint64_t bytes = 8) {
    stream.Append(MpiReceive{0, ticks, bytes, 1, from, tag, request});
  }
  void Receive(std::int32_t from, std::int32_t tag, std::uint64_t begin, std::uint64_t end) {
    Call(kReceive, begin, end, [&] { Received(from, tag, end); });
  }
  void Barrier(std::uint64_t begin, std::uint64_t end) {
    Call(kBarrier, begin, end, [&] {
      stream.Append(MpiCollective{0, begin, 0, 0, 1, -1, kBarrier, 0});
    });
  }
  StreamWriter stream;
};

struct Written {
  explicit Written(const std::vector<Rank>& ranks) {
    for (const Rank& r : ranks) archive.Add(r.stream);
    trace = Trace::Open(archive.path());
  }
  TemporaryArchive archive;
  Trace trace;
};

/// Of the first location, by region.
std::vector<RegionTime> Profile(const Trace& trace, const Selection& selection) {
  std::vector<RegionTime> times(trace.regions().size());
  for (const RegionTime& t : ProfileOf(trace, trace.locations()[0], selection)) times[t.region] = t;
  return times;
}

double Number(const Cell& cell) {
  return std::holds_alternative<double>(cell) ? std::get<double>(cell)
                                              : static_cast<double>(std::get<std::int64_t>(cell));
}

TEST(Profile, ExclusiveTimesSumToTheSpanAndRecursionCountsOnce) {
  StreamWriter s(1);
  for (const std::uint32_t r : {kMain, kWork, kHelp}) s.Region(r, "region" + std::to_string(r));
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  s.Enter(kWork, 1100);
  s.Enter(kWork, 1200);
  s.Enter(kHelp, 1300);  // left by longjmp to main
  s.Enter(kHelp, 1350);
  s.Leave(kWork, 1400);
  s.Leave(kWork, 1700);
  s.Leave(kHelp, 1800);  // not open
  s.Enter(kWork, 1900);  // open at the end
  s.Enter(kHelp, 2000);
  s.End(9000);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  const std::vector<RegionTime> times = Profile(trace, {});
  double exclusive = 0;
  for (const RegionTime& t : times) exclusive += t.exclusive_ns;
  EXPECT_DOUBLE_EQ(exclusive, 1000);
  EXPECT_DOUBLE_EQ(times[1].inclusive_ns, 1000);
  EXPECT_DOUBLE_EQ(times[2].inclusive_ns, 700);
  EXPECT_EQ(times[2].calls, 3U);
  EXPECT_EQ(times[3].calls, 3U);
  EXPECT_DOUBLE_EQ(times[3].inclusive_ns, 100);
}

TEST(Profile, PartsOfTheTimeSumToTheWhole) {
  StreamWriter s(1);
  s.Region(kMain, "main");
  s.Region(kWork, "work");
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  for (std::uint64_t t = 1100; t < 9000; t += 100) {
    s.Enter(kWork, t);
    s.Leave(kWork, t + 37);
  }
  s.Leave(kMain, 9000);
  s.End(9000);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  double parts = 0;
  std::uint64_t calls = 0;
  for (std::int64_t begin = 0; begin < 8000; begin += 1000) {
    Selection part;
    part.begin_ns = begin;
    part.end_ns = begin + 1000 - 1;
    const auto times = Profile(trace, part);
    calls += times[2].calls;
    part.end_ns = begin + 1000;
    const auto exact = Profile(trace, part);
    parts += exact[2].exclusive_ns;
  }
  const auto whole = Profile(trace, {});
  EXPECT_NEAR(parts, whole[2].exclusive_ns, 1e-6);
  EXPECT_EQ(calls, whole[2].calls);
}

TEST(RegionColumns, EachHoldsWhatTheProfileSaysOfItsTime) {
  TemporaryArchive archive;
  WriteRing(archive, 3, 200, 4);
  const Trace trace = Trace::Open(archive.path());
  const Analysis analysis(trace);
  std::vector<std::uint32_t> regions;
  for (std::uint32_t r = 1; r < trace.regions().size(); ++r) regions.push_back(r);
  const std::vector<int> ranks = trace.RanksInOrder();
  constexpr std::size_t kColumns = 16;
  const std::vector<RegionColumns> columns =
      RegionColumnsOf(analysis, {.regions = regions, .ranks = ranks, .columns = kColumns});
  ASSERT_EQ(columns.size(), regions.size() + 1);
  const auto edge = [&](std::size_t c) {
    return std::llround(static_cast<double>(trace.SpanNs()) * static_cast<double>(c) / kColumns);
  };
  for (std::size_t c = 0; c < kColumns; ++c) {
    Selection part;
    part.begin_ns = edge(c);
    part.end_ns = edge(c + 1);
    const std::vector<RegionTime> truth = SumOfMains(analysis, part);
    double all = 0;
    for (const RegionTime& t : truth) all += t.exclusive_ns;
    EXPECT_NEAR(static_cast<double>(columns.back().exclusive_ns[c]), all, 20) << c;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const RegionTime& t = truth[regions[i]];
      EXPECT_NEAR(static_cast<double>(columns[i].exclusive_ns[c]), t.exclusive_ns, 6) << c;
      EXPECT_NEAR(static_cast<double>(columns[i].inclusive_ns[c]), t.inclusive_ns, 6) << c;
      // What is entered at an edge is a call of both sides there.
      EXPECT_NEAR(static_cast<double>(columns[i].calls[c]), static_cast<double>(t.calls), 1) << c;
      std::uint64_t by_rank = 0;
      for (const auto& of_rank : columns[i].exclusive_by_rank) by_rank += of_rank[c];
      EXPECT_EQ(by_rank, columns[i].exclusive_ns[c]);
    }
  }
}

TEST(Messages, MatchInTheOrderOfPostsNotOfCompletions) {
  Rank sender(0, 2);
  sender.Send(1, 5, 1100, 1150, 10);  // first of tag 5
  sender.Send(1, 5, 1200, 1250, 20);  // second of tag 5
  sender.Send(1, 9, 1300, 1350, 30);
  sender.End(5000);
  Rank receiver(1, 2);
  receiver.Post(1, 1010);  // tag 5
  receiver.Post(2, 1020);  // any tag: gets the 9, so it is no rival of the others
  receiver.Post(3, 1030);  // any source, tag 5
  receiver.Call(kWait, 1400, 1500, [&] {
    receiver.Received(0, 5, 1410, 3, 20);  // the later post is complete first
    receiver.Received(0, 9, 1420, 2, 30);
    receiver.Received(0, 5, 1430, 1, 10);
  });
  receiver.End(5000);
  const Written w({sender, receiver});
  const MpiActivity mpi = Analysis(w.trace).mpi;
  EXPECT_EQ(mpi.matched, 3U);
  EXPECT_EQ(mpi.Unmatched(), 0U);
  for (const ReceiveEvent& r : mpi.receives) EXPECT_EQ(mpi.sends[r.send].bytes, r.bytes);
}

TEST(Messages, CancelledSendsAreGoneAndLostReceivesAreCounted) {
  Rank sender(0, 2);
  sender.stream.Append(MpiSend{0, 1100, 10, 1, 1, 5, 77});
  sender.stream.Append(MpiRequestEnd{0, 1200, 77, 2});
  sender.Send(1, 5, 1300, 1350, 20);
  sender.Send(1, 6, 1400, 1450, 30);
  sender.End(5000);
  Rank receiver(1, 2);
  receiver.Receive(0, 5, 1300, 1400);
  receiver.End(5000);
  const Written w({sender, receiver});
  const MpiActivity mpi = Analysis(w.trace).mpi;
  EXPECT_EQ(mpi.matched, 1U);
  EXPECT_EQ(mpi.sends.size(), 2U);
  EXPECT_EQ(mpi.health.CountOf(Defect::kUnmatchedSend), 1U);
  const Table volume = VolumeTable(Analysis(w.trace), {});
  EXPECT_EQ(Number(volume.rows[0][2]), 50);  // unmatched ones count
  EXPECT_EQ(TableJson(MessagesTable(Analysis(w.trace), {})),
            "{\"rows\":[\"0\",\"1\"],\"columns\":[\"0\",\"1\"],\"values\":[[0,2],[0,0]]}\n");
}

/// Rank 0 works until 3000, then sends; rank 1 waits for it since 1100; both meet in a barrier.
std::vector<Rank> LateSender() {
  std::vector<Rank> ranks{Rank(0, 2), Rank(1, 2)};
  ranks[0].Call(kWork, 1050, 2990);
  ranks[0].Send(1, 5, 3000, 3100);
  ranks[0].Barrier(3200, 4100);
  ranks[0].End(5000);
  ranks[1].Receive(0, 5, 1100, 3150);
  ranks[1].Call(kHelp, 3160, 3990);
  ranks[1].Barrier(4000, 4100);
  ranks[1].End(5000);
  return ranks;
}

TEST(States, SumToTheSpanAndIdleEndsWhenThePartnerArrives) {
  const Written w(LateSender());
  const std::vector<RankStates> states = StatesOf(Analysis(w.trace), {});
  ASSERT_EQ(states.size(), 2U);
  for (const RankStates& s : states) {
    EXPECT_EQ(s.SpanNs(), 4000);
    EXPECT_FALSE(s.system_ns.has_value());
  }
  EXPECT_EQ(states[0].idle_ns, 800);
  EXPECT_EQ(states[0].message_ns, 200);
  EXPECT_EQ(states[1].idle_ns, 1900);
  EXPECT_EQ(states[1].message_ns, 250);
  EXPECT_NE(TableJson(StatesTable(states)).find("\"system_s\":null"), std::string::npos);
}

TEST(Waits, NameTheCulpritAndWhereItWas) {
  const Written w(LateSender());
  const Table table = TableEntries()[4].make(Analysis(w.trace), {}, {}).table;
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(std::get<std::string>(table.rows[0][0]), "late-sender");
  EXPECT_EQ(Number(table.rows[0][1]), 1);
  EXPECT_EQ(Number(table.rows[0][2]), 0);
  EXPECT_NEAR(Number(table.rows[0][3]), 1900e-9, 1e-12);
  EXPECT_EQ(std::get<std::string>(table.rows[0][4]), "work");
  EXPECT_EQ(std::get<std::string>(table.rows[1][0]), "wait-at-barrier");
  EXPECT_EQ(std::get<std::string>(table.rows[1][4]), "help");
}

TEST(Waits, ChainLeadsToTheRankThatBeganIt) {
  std::vector<Rank> ranks{Rank(0, 3), Rank(1, 3), Rank(2, 3)};
  ranks[0].Call(kWork, 1010, 2900);
  ranks[0].Send(1, 1, 3000, 3010);
  ranks[0].End(4000);
  ranks[1].Receive(0, 1, 1100, 3020);  // waits for 0
  ranks[1].Send(2, 1, 3100, 3110);
  ranks[1].End(4000);
  ranks[2].Receive(1, 1, 1200, 3120);  // waits for 1, which waits for 0
  ranks[2].End(4000);
  const Written w(ranks);
  const Analysis analysis(w.trace);
  const std::vector<Blame> blames = BlameOf(w.trace, analysis.mpi, analysis.waits, {});
  double for_0 = 0;
  double for_1 = 0;
  for (const Blame& b : blames) {
    if (b.waiter != 2) continue;
    (b.culprit == 0 ? for_0 : for_1) += b.seconds;
  }
  // 1200 to 3000 rank 1 waited for 0. From 3000 to 3100 it was its turn, which without that wait
  // would have been over before anybody waited (decision 0017).
  EXPECT_NEAR(for_0, 1900e-9, 1e-12);
  EXPECT_NEAR(for_1, 0, 1e-12);
  const Finding finding = FindingOf(w.trace);
  EXPECT_EQ(finding.culprit, 0);
  EXPECT_NE(finding.sentence.find("Ranks 1 and 2 spend"), std::string::npos) << finding.sentence;
  EXPECT_NE(finding.detail.find("work"), std::string::npos) << finding.detail;
}

// Rank 0 collects from 1, which is ready at 2000, and then from 2, which is ready at 3000; rank 1
// waits for all in the barrier. Had 1 been earlier it would have gained nothing.
TEST(Waits, OfSeveralThatWereLateTheLastIsCharged) {
  std::vector<Rank> ranks{Rank(0, 3), Rank(1, 3), Rank(2, 3)};
  ranks[0].Receive(1, 1, 1100, 2010);
  ranks[0].Receive(2, 1, 2020, 3010);
  ranks[0].Barrier(3100, 3120);
  ranks[0].End(4000);
  ranks[1].Call(kWork, 1010, 1990);
  ranks[1].Send(0, 1, 2000, 2005);
  ranks[1].Barrier(2100, 3120);
  ranks[1].End(4000);
  ranks[2].Call(kHelp, 1010, 2990);
  ranks[2].Send(0, 1, 3000, 3005);
  ranks[2].Barrier(3050, 3120);
  ranks[2].End(4000);
  const Written w(ranks);
  const Analysis analysis(w.trace);
  std::map<std::pair<int, int>, double> ns;
  for (const Blame& b : BlameOf(w.trace, analysis.mpi, analysis.waits, {}))
    ns[{b.waiter, b.culprit}] += b.seconds * 1e9;
  // 2100 to 3000, and of 3000 to 3100 what rank 0 would have gained had it not waited for 2: it did
  // so from 2020 on.
  EXPECT_NEAR((ns[{1, 2}]), 980, 1e-3);
  EXPECT_NEAR((ns[{1, 0}]), 20, 1e-3);
  EXPECT_EQ((ns[{1, 1}]), 0);
  EXPECT_NEAR((ns[{0, 1}]), 900, 1e-3);
  EXPECT_NEAR((ns[{0, 2}]), 980, 1e-3);
  EXPECT_EQ(FindingOf(w.trace).culprit, 2);
}

TEST(Waits, SendThatReturnedBeforeTheReceiveWasPostedDidNotWait) {
  std::vector<Rank> ranks{Rank(0, 2), Rank(1, 2)};
  ranks[0].Send(1, 1, 1100, 1200);  // buffered
  ranks[0].Send(1, 2, 1300, 2600);  // waits for the receive at 2500
  ranks[0].End(5000);
  ranks[1].Call(kWork, 1100, 2300);
  ranks[1].Receive(0, 1, 2400, 2450);
  ranks[1].Receive(0, 2, 2500, 2700);
  ranks[1].End(5000);
  const Written w(ranks);
  const std::vector<RankStates> states = StatesOf(Analysis(w.trace), {});
  EXPECT_EQ(states[0].idle_ns, 1200);
  EXPECT_EQ(states[1].idle_ns, 0);
}

TEST(Finding, SerialRunIsComputation) {
  StreamWriter s(1);
  s.Region(kMain, "main");
  s.Region(kWork, "work");
  s.NewChunk(1000);
  s.Enter(kMain, 1000);
  s.Enter(kWork, 1100);
  s.Leave(kWork, 1900);
  s.Leave(kMain, 2000);
  s.End(2000);
  TemporaryArchive archive;
  archive.Add(s);
  EXPECT_EQ(FindingOf(Trace::Open(archive.path())).sentence,
            "No rank waits for another: 100% of the time is computation, most of it in work");
}

TEST(Timeline, ColumnsHoldTheStatesExactly) {
  const Written w(LateSender());
  const Analysis analysis(w.trace);
  for (const std::size_t columns : {1U, 7U, 1000U}) {
    const Timeline t = TimelineOf(analysis, 0, 4000e-9, columns);
    ASSERT_EQ(t.rows.size(), 2U);
    double idle = 0;
    for (const StateShares& shares : t.rows[1].columns) {
      idle += static_cast<double>(shares[static_cast<std::size_t>(State::kIdle)]);
      double sum = 0;
      for (const float share : shares) sum += static_cast<double>(share);
      EXPECT_NEAR(sum, 1, 1e-4);
    }
    EXPECT_NEAR(idle * 4000 / static_cast<double>(columns), 1900, 0.5);
    EXPECT_EQ(t.message_count, 1U);
  }
}

// Two runs of an MPI program of two ranks, one after the other, in one archive.
TEST(Jobs, AreKeptApartAndMatchedEach) {
  std::vector<Rank> ranks{Rank(0, 2), Rank(1, 2), Rank(0, 2), Rank(1, 2)};
  for (std::size_t i = 0; i < 4; ++i) {
    ranks[i].stream.header.pid = static_cast<std::uint32_t>(i + 1);
    ranks[i].stream.header.parent_pid = i < 2 ? 100 : 200;
    ranks[i].stream.header.start_realtime_ns = 1'000'000'000 + i * 1000;
  }
  ranks[0].Send(1, 1, 1100, 1110);
  ranks[1].Receive(0, 1, 1100, 1120);
  ranks[2].Send(1, 1, 5000, 5010, 100);
  ranks[3].Receive(0, 1, 2000, 5020);
  ranks[0].Call(kWork, 1200, 1300);
  for (Rank& r : ranks) r.End(6000);
  const Written w(ranks);
  const Analysis analysis(w.trace);
  EXPECT_TRUE(analysis.health.Sound());
  EXPECT_EQ(w.trace.RankCount(), 4);
  EXPECT_EQ(JobsOf(w.trace.processes()).size(), 2U);
  EXPECT_EQ(TableJson(VolumeTable(analysis, {})),
            "{\"rows\":[\"0\",\"1\",\"2\",\"3\"],\"columns\":[\"0\",\"1\",\"2\",\"3\"],"
            "\"values\":[[0,8,0,0],[0,0,0,0],[0,0,0,100],[0,0,0,0]]}\n");
  const Finding f = FindingOf(w.trace);
  EXPECT_EQ(f.culprit, 2);
  EXPECT_EQ(f.cause, "late-sender");
}

TEST(Imbalance, IsOneObjectWithTheCauseOrNone) {
  const Written late(LateSender());
  const TableEntry& entry = *std::ranges::find(TableEntries(), "imbalance", &TableEntry::name);
  const Table table = entry.make(Analysis(late.trace), {}, {}).table;
  EXPECT_EQ(std::get<std::string>(table.rows[0][2]), "late-sender");
  EXPECT_EQ(TableJson(table).substr(0, 17), "{\"max_over_mean\":");
  std::vector<Rank> ranks{Rank(0, 2), Rank(1, 2)};
  for (Rank& r : ranks) r.End(4000);
  const Written even(ranks);
  const Table healthy = entry.make(Analysis(even.trace), {}, {}).table;
  EXPECT_EQ(std::get<std::string>(healthy.rows[0][2]), "none");
  EXPECT_EQ(Number(healthy.rows[0][1]), 0);
}

TEST(Progress, SaysNothingForHalfASecondThenHowLongItWillTake) {
  ReadMeter meter;
  ProgressText progress(100);
  EXPECT_EQ(progress.At(meter.Now(), 101), "");
  meter.Begin("reading", 12'000'000'000);
  ProgressText quick(100);
  EXPECT_EQ(quick.At(meter.Now(), 100.0), "");
  meter.Add(3'000'000'000);
  EXPECT_EQ(quick.At(meter.Now(), 100.4), "");
  EXPECT_EQ(quick.At(meter.Now(), 101), "reading 3.0 of 12.0 GB, 3 s left");
  meter.Add(3'000'000'000);
  EXPECT_EQ(quick.At(meter.Now(), 202), "reading 6.0 of 12.0 GB, 102 s left");
  EXPECT_EQ(quick.At(meter.Now(), 500), "reading 6.0 of 12.0 GB, 7 min left");
  meter.Begin("drawing", 0);
  EXPECT_EQ(quick.At(meter.Now(), 600), "drawing");
}

TEST(Tables, EachNameOccursOnceAndWorksOnAnEmptyArchive) {
  TemporaryArchive archive;
  const Trace trace = Trace::Open(archive.path());
  std::map<std::string_view, int> names;
  for (const TableEntry& entry : TableEntries()) {
    EXPECT_EQ(++names[entry.name], 1);
    const Table table = entry.make(Analysis(trace), {}, {}).table;
    EXPECT_EQ(table.name, entry.name);
    EXPECT_TRUE(table.rows.empty()) << entry.name;
  }
}

}  // namespace
}  // namespace stipple
