// SPDX-License-Identifier: MIT
// Parts of a run: what is read, searched or summed for one is what reading all of it would give, at
// a cost that follows the part.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/stats/visits.h"
#include "analysis/trace/read_meter.h"
#include "tests/analysis/archive_writer.h"
#include "tests/analysis/ring.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;
using testing::WriteRing;

constexpr IndexPolicy kNever{false, 0};

/// The part of [begin, end) in the column.
double Overlap(double begin, double end, double from, double to) {
  return std::max(0.0, std::min(end, to) - std::max(begin, from));
}

/// Shares of a rank in one column, from its calls one by one.
StateShares DirectShares(const Analysis& a, const Location& l, double from, double to) {
  double user = Overlap(static_cast<double>(l.begin_ns), static_cast<double>(l.end_ns), from, to);
  double system = 0;
  double message = 0;
  double idle = 0;
  for (std::size_t c = 0; c < a.mpi.calls.size(); ++c) {
    const MpiCall& call = a.mpi.calls[c];
    if (call.location != l.index) continue;
    const double begin = static_cast<double>(call.begin_ns);
    const double arrival = begin + static_cast<double>(a.waits[c].idle_ns);
    const double end = static_cast<double>(call.end_ns);
    user -= Overlap(begin, end, from, to);
    idle += Overlap(begin, arrival, from, to);
    message += Overlap(arrival, end, from, to);
  }
  for (const CallSpan& s : a.kernel[l.index]) {
    const double time =
        Overlap(static_cast<double>(s.begin_ns), static_cast<double>(s.end_ns), from, to);
    user -= time;
    system += time;
  }
  StateShares shares{};
  const double width = to - from;
  shares[static_cast<std::size_t>(State::kUser)] = static_cast<float>(user / width);
  shares[static_cast<std::size_t>(State::kSystem)] = static_cast<float>(system / width);
  shares[static_cast<std::size_t>(State::kMessage)] = static_cast<float>(message / width);
  shares[static_cast<std::size_t>(State::kIdle)] = static_cast<float>(idle / width);
  return shares;
}

/// Messages under way in [begin, end], in the order of mpi.sends.
std::vector<std::pair<double, double>> DirectMessages(const Analysis& a, double begin_ns,
                                                      double end_ns) {
  std::vector<std::pair<double, double>> found;
  for (const SendEvent& s : a.mpi.sends) {
    if (s.receive == kNoIndex) continue;
    const std::int64_t done = std::max(s.enter_ns, a.mpi.receives[s.receive].complete_ns);
    if (static_cast<double>(s.enter_ns) <= end_ns && static_cast<double>(done) >= begin_ns)
      found.emplace_back(static_cast<double>(s.enter_ns), static_cast<double>(done));
  }
  return found;
}

void ExpectAsDirect(const Analysis& a, double begin_ns, double end_ns, std::size_t columns) {
  const Timeline t = TimelineOf(a, begin_ns * 1e-9, end_ns * 1e-9, columns);
  const double width = (end_ns - begin_ns) / static_cast<double>(columns);
  double worst = 0;
  for (const TimelineRow& row : t.rows) {
    ASSERT_EQ(row.columns.size(), columns);
    for (std::size_t c = 0; c < columns; ++c) {
      const double from = begin_ns + width * static_cast<double>(c);
      const StateShares direct = DirectShares(a, *a.trace.MainOf(row.rank), from, from + width);
      for (std::size_t s = 0; s < kStateCount; ++s)
        worst = std::max(worst, std::abs(static_cast<double>(row.columns[c][s] - direct[s])));
    }
  }
  EXPECT_LT(worst, 1e-3) << begin_ns << " to " << end_ns;
  const auto messages = DirectMessages(a, begin_ns, end_ns);
  EXPECT_EQ(t.message_count, messages.size());
  if (messages.size() > kDrawnMessages) {
    EXPECT_TRUE(t.messages.empty());
  } else {
    ASSERT_EQ(t.messages.size(), messages.size());
    for (std::size_t i = 0; i < messages.size(); ++i)
      EXPECT_NEAR(t.messages[i].send_s * 1e9, messages[i].first, 1e-3);
  }
  double sent = 0;
  for (const double bytes : t.sent_bytes) sent += bytes;
  double direct_sent = 0;
  for (const SendEvent& s : a.mpi.sends)
    if (s.receive != kNoIndex && static_cast<double>(s.enter_ns) >= begin_ns &&
        static_cast<double>(s.enter_ns) <= end_ns)
      direct_sent += static_cast<double>(s.bytes);
  EXPECT_DOUBLE_EQ(sent, direct_sent);
}

TEST(TimelineOfASpan, IsAtAnyZoomWhatTheCallsSay) {
  std::mt19937_64 random(1);
  for (const std::int32_t size : {1, 2, 7}) {
    TemporaryArchive archive;
    WriteRing(archive, size, 300, 4);
    const Trace trace = Trace::Open(archive.path(), nullptr, kNever);
    const Analysis a(trace);
    const double span = static_cast<double>(trace.SpanNs());
    ExpectAsDirect(a, 0, span, 100);
    ExpectAsDirect(a, -span, 2 * span, 30);
    for (int i = 0; i < 40; ++i) {
      const double zoom = std::pow(2.0, static_cast<double>(random() % 14));
      const double begin = std::floor(static_cast<double>(random() % 1000) / 1000 * span);
      ExpectAsDirect(a, begin, begin + std::ceil(span / zoom), 1 + random() % 50);
    }
  }
}

TEST(TimelineOfASpan, OfNothingIsEmpty) {
  TemporaryArchive archive;
  const Trace trace = Trace::Open(archive.path());
  const Analysis a(trace);
  const Timeline t = TimelineOf(a, 0, 0, 10);
  EXPECT_TRUE(t.rows.empty());
  EXPECT_EQ(t.sent_bytes.size(), 10U);
  EXPECT_EQ(t.message_count, 0U);
}

/// A thread that calls at random, long enough for several anchors.
StreamWriter LongThread(std::uint64_t events, std::uint64_t seed) {
  StreamWriter s(1);
  for (std::uint32_t r = 1; r <= 20; ++r) s.Region(r, "function" + std::to_string(r));
  std::mt19937_64 random(seed);
  std::vector<std::uint32_t> stack;
  std::uint64_t now = 1000;
  s.NewChunk(now);
  for (std::uint64_t i = 0; i < events; ++i) {
    now += random() % 20;
    const bool leave = !stack.empty() && (stack.size() >= 20 || random() % 2 == 0);
    if (leave) {
      s.Leave(stack.back(), now);
      stack.pop_back();
    } else {
      stack.push_back(static_cast<std::uint32_t>(1 + random() % 20));
      s.Enter(stack.back(), now);
    }
  }
  s.End(now);
  return s;
}

auto KeyOf(const VisitSpan& v) { return std::tuple(v.begin_ns, v.end_ns, v.region, v.depth); }

void ExpectSameVisits(const VisitsOfSpan& a, const VisitsOfSpan& b) {
  EXPECT_EQ(a.events, b.events);
  ASSERT_EQ(a.visits.size(), b.visits.size());
  for (std::size_t i = 0; i < a.visits.size(); ++i)
    ASSERT_EQ(KeyOf(a.visits[i]), KeyOf(b.visits[i])) << i;
}

TEST(Span, IsTheSameFromAnAnchorAndFromTheBegin) {
  constexpr std::uint64_t kEvents = 500'000;
  TemporaryArchive archive;
  archive.Add(LongThread(kEvents, 1));
  const Trace plain = Trace::Open(archive.path(), nullptr, kNever);
  ReadMeter meter;
  const Trace trace = Trace::Open(archive.path(), &meter, kNever);
  const Analysis analysis(trace);
  const Location& l = trace.locations().front();
  EXPECT_GE(trace.AnchorsOf(l).places.size(), 5U);
  EXPECT_TRUE(plain.AnchorsOf(plain.locations().front()).places.empty());
  std::mt19937_64 random(2);
  for (int i = 0; i < 30; ++i) {
    const auto begin = static_cast<std::int64_t>(random()) % trace.SpanNs();
    const std::int64_t from = std::abs(begin);
    const std::int64_t to = from + static_cast<std::int64_t>(random() % 3000);
    meter.Begin("test", 0);
    const VisitsOfSpan near = VisitsIn(trace, l, from, to, 100'000);
    EXPECT_LT(meter.Now().done_bytes, 2 * Anchors::kWordsBetween * sizeof(EventWord));
    ExpectSameVisits(near, VisitsIn(plain, plain.locations().front(), from, to, 100'000));
    Selection selection;
    selection.begin_ns = from;
    selection.end_ns = to;
    const LocationProfile part = ProfileOf(trace, l, selection);
    const LocationProfile whole = ProfileOf(plain, plain.locations().front(), selection);
    ASSERT_EQ(part.size(), whole.size());
    for (std::size_t r = 0; r < part.size(); ++r) {
      EXPECT_EQ(part[r].region, whole[r].region);
      EXPECT_EQ(part[r].calls, whole[r].calls);
      EXPECT_EQ(part[r].inclusive_ns, whole[r].inclusive_ns);
      EXPECT_EQ(part[r].exclusive_ns, whole[r].exclusive_ns);
    }
  }
}

TEST(Span, VisitsAreThoseThatLieInIt) {
  StreamWriter s(1);
  for (std::uint32_t r = 1; r <= 3; ++r) s.Region(r, "f" + std::to_string(r));
  s.NewChunk(1000);
  s.Enter(1, 1000);
  s.Enter(2, 1100);
  s.Leave(2, 1200);
  s.Enter(3, 1300);
  s.Leave(3, 1400);
  s.Enter(2, 1500);
  s.Leave(2, 1600);
  s.Leave(1, 2000);
  s.End(2000);
  TemporaryArchive archive;
  archive.Add(s);
  const Trace trace = Trace::Open(archive.path());
  const Location& l = trace.locations().front();
  const VisitsOfSpan in = VisitsIn(trace, l, 250, 550, 10);
  ASSERT_EQ(in.visits.size(), 3U);
  EXPECT_EQ(KeyOf(in.visits[0]), std::tuple(0, 1000, 1U, 0U));  // its own ends
  EXPECT_EQ(KeyOf(in.visits[1]), std::tuple(300, 400, 3U, 1U));
  EXPECT_EQ(KeyOf(in.visits[2]), std::tuple(500, 600, 2U, 1U));
  EXPECT_EQ(in.events, 3U);
  EXPECT_TRUE(in.complete);
  const VisitsOfSpan many = VisitsIn(trace, l, 0, 1000, 2);
  EXPECT_FALSE(many.complete);
  EXPECT_TRUE(many.visits.empty());
  EXPECT_TRUE(VisitsIn(trace, l, 5000, 6000, 10).visits.empty());
}

}  // namespace
}  // namespace stipple
