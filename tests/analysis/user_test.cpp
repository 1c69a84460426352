// SPDX-License-Identifier: MIT
// What programs tell about themselves (user.h), read back: messages between threads and counters.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

#include "analysis/report/event_text.h"
#include "analysis/report/text.h"
#include "analysis/stats/channels.h"
#include "analysis/stats/counters.h"
#include "analysis/trace/thread_messages.h"
#include "tests/analysis/archive_writer.h"

namespace stipple {
namespace {

using testing::StreamWriter;
using testing::TemporaryArchive;

/// Ends of `sends` and `receives`, each its times, on one channel with one key.
std::vector<ThreadMessageEnd> Ends(const std::vector<std::int64_t>& sends,
                                   const std::vector<std::int64_t>& receives) {
  std::vector<ThreadMessageEnd> ends;
  for (const std::int64_t t : receives) ends.push_back({1, 7, true, t, 8, 1, {}});
  for (const std::int64_t t : sends) ends.push_back({1, 7, false, t, 8, 0, {}});
  return ends;
}

TEST(ThreadMessages, WhatWasNotRecordedShiftsNothing) {
  // Recording began after a send; another one was never received.
  ThreadMessages messages;
  MatchThreadMessages(Ends({20, 40, 60}, {10, 30, 50}), messages);
  ASSERT_EQ(messages.matched.size(), 2U);
  EXPECT_EQ(messages.matched[0].send.time_ns, 20);
  EXPECT_EQ(messages.matched[0].receive.time_ns, 30);
  EXPECT_EQ(messages.matched[1].send.time_ns, 40);
  ASSERT_EQ(messages.unmatched.size(), 2U);
  EXPECT_EQ(messages.unmatched[0].time_ns, 10);
  EXPECT_EQ(messages.unmatched[1].time_ns, 60);
}

TEST(ThreadMessages, OfOneMomentTheSendIsTheEarlier) {
  ThreadMessages messages;
  MatchThreadMessages(Ends({20}, {20}), messages);
  EXPECT_EQ(messages.matched.size(), 1U);
}

/// However ends are mixed: each is in one place, a pair has one channel and key, no receive is
/// before its send, and neither sends nor receives of a channel and key overtake each other.
TEST(ThreadMessages, MatchInOrderPerChannelAndKey) {
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    std::vector<ThreadMessageEnd> ends(random() % 200);
    for (ThreadMessageEnd& e : ends) {
      e.channel = 1 + static_cast<std::uint32_t>(random() % 2);
      e.key = random() % 3;
      e.is_receive = random() % 2 == 0;
      e.time_ns = static_cast<std::int64_t>(random() % 100);
    }
    const std::size_t count = ends.size();
    ThreadMessages messages;
    MatchThreadMessages(std::move(ends), messages);
    EXPECT_EQ(2 * messages.matched.size() + messages.unmatched.size(), count);
    std::map<std::pair<std::uint32_t, std::uint64_t>, const ThreadMessage*> last;
    for (const ThreadMessage& m : messages.matched) {
      EXPECT_FALSE(m.send.is_receive);
      EXPECT_TRUE(m.receive.is_receive);
      EXPECT_EQ(std::pair(m.send.channel, m.send.key), std::pair(m.receive.channel, m.receive.key));
      EXPECT_LE(m.send.time_ns, m.receive.time_ns);
      const ThreadMessage*& before = last[{m.send.channel, m.send.key}];
      if (before != nullptr) {
        EXPECT_LE(before->send.time_ns, m.send.time_ns);
        EXPECT_LE(before->receive.time_ns, m.receive.time_ns);
      }
      before = &m;
    }
  }
}

/// One process of two threads; a tick is a nanosecond, the first event is at 1000.
StreamWriter TwoThreads() {
  StreamWriter s(1);
  s.Name(1, "queue", "items");
  s.Define(DefineChannel{0, 1, 4}, "jobs");
  s.Append(Mark{0, 1000, 1, 0});
  return s;
}

Trace Opened(TemporaryArchive& archive, const StreamWriter& stream) {
  archive.Add(stream);
  return Trace::Open(archive.path());
}

TEST(Channels, TellWhoWaitedForWhom) {
  StreamWriter s = TwoThreads();
  s.Append(ThreadSend{0, 1'000'001'000, 8, 1, 1, 0});
  s.Append(ThreadSend{0, 5'000'001'000, 8, 2, 1, 0});
  s.Append(ThreadSend{0, 6'000'001'000, 8, 3, 1, 0});
  s.Append(ThreadSend{0, 7'000'001'000, 8, 4, 1, 0});  // never received
  s.NewThread();
  s.Append(ThreadReceive{0, 1'500'001'000, 8, 1, 500'001'000, 1, 0});    // sender late by 0.5 s
  s.Append(ThreadReceive{0, 5'500'001'000, 8, 2, 5'250'001'000, 1, 0});  // it lay for 0.25 s
  s.Append(ThreadReceive{0, 6'125'001'000, 8, 3, 0, 1, 0});              // at most 0.125 s
  s.End(8'000'001'000);
  TemporaryArchive archive;
  const Trace trace = Opened(archive, s);
  const Analysis analysis(trace);
  EXPECT_EQ(TableCsv(ChannelsTable(analysis, {})),
            "rank,channel,messages,bytes,unmatched,late_sender_s,late_receiver_s\n"
            "0,jobs,3,24,1,0.500000000,0.375000000\n");
  EXPECT_TRUE(analysis.health.Sound());
  EventCursor cursor(trace, trace.locations()[1]);
  const Event event = *cursor.Next();
  EXPECT_EQ(CanonicalText(trace, trace.locations()[1], event), "receive 8 through jobs key 1");
  EXPECT_EQ(EventText(trace, trace.locations()[1], event),
            "receive 8 through jobs key 1, waited 1.00 s");
}

TEST(Channels, ReceiversThatDoNotTellWhenTheyBeganAreNoZeros) {
  StreamWriter s = TwoThreads();
  s.Append(ThreadSend{0, 2000, 8, 1, 1, 0});
  s.Append(ThreadReceive{0, 3000, 8, 1, 0, 1, 0});
  s.End(4000);
  TemporaryArchive archive;
  const Trace trace = Opened(archive, s);
  EXPECT_NE(TableJson(ChannelsTable(Analysis(trace), {})).find("\"late_sender_s\":null"),
            std::string::npos);
}

/// The threads of a process share its counters: 2 for 1 s, 6 for 2 s, 1 for 1 s, 4 in no time.
TEST(Counters, AreWeightedByHowLongAValueHeld) {
  StreamWriter s = TwoThreads();
  s.Append(Counter{0, 1'000'001'000, 1, 0, 2});
  s.Append(Counter{0, 4'000'001'000, 1, 0, 1});
  s.Append(Counter{0, 5'000'001'000, 1, 0, 4});
  s.NewThread();
  s.Append(Counter{0, 2'000'001'000, 1, 0, 6});
  s.End(5'000'001'000);
  TemporaryArchive archive;
  const Trace trace = Opened(archive, s);
  EXPECT_EQ(TableCsv(CountersTable(trace, {})),
            "rank,process,name,unit,count,first,last,min,max,mean\n"
            "0,0,queue,items,4,2,4,1,6,3.75\n");
  Selection part;
  part.begin_ns = 1'500'000'000;
  part.end_ns = 4'500'000'000;  // 6 for 2 s, 1 for half a second
  EXPECT_EQ(TableCsv(CountersTable(trace, part)),
            "rank,process,name,unit,count,first,last,min,max,mean\n"
            "0,0,queue,items,2,6,1,1,6,5\n");
  part.ranks = {3};
  EXPECT_TRUE(CountersTable(trace, part).rows.empty());
}

TEST(Counters, AnyValueIsWritten) {
  StreamWriter s = TwoThreads();
  s.Append(Counter{0, 2000, 1, 0, 1e300});
  s.Append(Counter{0, 2000, 1, 0, 1.5e-12});
  s.End(2000);
  TemporaryArchive archive;
  const Trace trace = Opened(archive, s);
  const Table table = CountersTable(trace, {});
  EXPECT_NE(TableCsv(table).find("2,1e+300,1.5e-12,1.5e-12,1e+300,5e+299"), std::string::npos);
  EXPECT_NE(TableText(table).find("1.5e-12"), std::string::npos);
}

}  // namespace
}  // namespace stipple
