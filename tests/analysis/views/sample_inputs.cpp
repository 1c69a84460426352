// SPDX-License-Identifier: MIT
#include "sample_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "analysis/report/matrix_cells.h"
#include "analysis/views/table_access.h"

namespace stipple {
namespace {

constexpr double kSpan = 18.4;   // seconds
constexpr double kTurn = 9.1;    // when the host has no more work
constexpr double kRound = 0.64;  // of one exchange with node 0 after that
constexpr double kDetailBegin = 11.55, kDetailEnd = 13.15;

/// One stretch of a rank in one state; times in seconds.
struct Stretch {
  double begin, end;
  State state;
};
using Stretches = std::vector<Stretch>;
using Random = std::mt19937;

double Uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() % 100'000) / 100'000;
}

void Add(Stretches& row, double& time, double length, State state) {
  row.push_back({time, time + length, state});
  time += length;
}

/// Bundles from the host: compute, pack, send, wait a little.
void WorkForHost(Stretches& row, Random& random) {
  for (double time = 0; time < kTurn;) {
    Add(row, time, Uniform(random, 0.12, 0.4), State::kUser);
    Add(row, time, 0.006, State::kSystem);
    Add(row, time, 0.012, State::kMessage);
    Add(row, time, Uniform(random, 0.02, 0.06), State::kIdle);
  }
}

/// After the turn node 0 works all the time and the others wait for it in rounds.
void WaitForNodeZero(Stretches& row, Random& random, bool is_zero, double phase) {
  for (double time = kTurn; time < kSpan;) {
    if (is_zero) {
      Add(row, time, kRound - 0.06, State::kUser);
      Add(row, time, 0.012, State::kSystem);
      Add(row, time, 0.048, State::kMessage);
      continue;
    }
    const double busy = Uniform(random, 0.12, 0.2);
    Add(row, time, 0.04 + phase, State::kIdle);
    Add(row, time, busy, State::kUser);
    Add(row, time, 0.006, State::kMessage);
    Add(row, time, std::max(0.0, kRound - busy - 0.046 - phase), State::kIdle);
  }
}

Stretches StretchesOf(int node, int nodes, bool is_host) {
  Random random(static_cast<unsigned>(node) * 7919U + 13U);
  Stretches row;
  if (is_host) {
    for (double time = 0; time < kTurn;) {
      Add(row, time, 0.012, State::kMessage);
      Add(row, time, 0.006, State::kSystem);
      Add(row, time, Uniform(random, 0.02, 0.14), State::kIdle);
    }
    row.push_back({kTurn, kSpan, State::kIdle});
    return row;
  }
  WorkForHost(row, random);
  WaitForNodeZero(row, random, node == 0, 0.03 * node / nodes);
  return row;
}

std::vector<StateShares> Columns(const Stretches& row, double begin, double end,
                                 std::size_t count) {
  std::vector<StateShares> columns(count, StateShares{});
  const double width = (end - begin) / static_cast<double>(count);
  const auto column_of = [&](double time) {
    return static_cast<std::size_t>(
        std::clamp((time - begin) / width, 0.0, static_cast<double>(count)));
  };
  for (const Stretch& stretch : row)
    for (std::size_t i = column_of(stretch.begin); i < std::min(count, column_of(stretch.end) + 1);
         ++i) {
      const double left = begin + static_cast<double>(i) * width;
      const double shared = std::min(stretch.end, left + width) - std::max(stretch.begin, left);
      if (shared > 0)
        columns[i][static_cast<std::size_t>(stretch.state)] += static_cast<float>(shared / width);
    }
  for (StateShares& shares : columns) {
    const float sum = shares[0] + shares[1] + shares[2] + shares[3];
    if (sum > 1)
      for (float& share : shares) share /= sum;
  }
  return columns;
}

TimelineRow RowOf(int rank, bool host) {
  return {host ? "host" : std::to_string(rank), rank, host, {}};
}

constexpr std::size_t kLoadColumns = 600;

Timeline EmptyTimeline(int nodes, bool host, double begin, double end) {
  Timeline timeline{begin, end, {}, {}, {}, 0, std::vector<double>(kLoadColumns)};
  for (int rank = 0; rank < nodes; ++rank) timeline.rows.push_back(RowOf(rank, false));
  if (host) timeline.rows.push_back(RowOf(nodes, true));
  return timeline;
}

void AddMessage(Timeline& timeline, std::size_t from, std::size_t to, double send, double receive) {
  ++timeline.message_count;
  const double place = (send - timeline.begin_s) / (timeline.end_s - timeline.begin_s);
  if (place >= 0 && place < 1)
    timeline.sent_bytes[static_cast<std::size_t>(place * kLoadColumns)] += 900;
  if (send >= timeline.begin_s && receive <= timeline.end_s)
    timeline.messages.push_back({from, to, send, receive, 900});
}

/// In each round node 0 sends to every node and hears back.
void AddRounds(Timeline& timeline, int nodes) {
  for (double round = kTurn + kRound - 0.06; round < kSpan; round += kRound)
    for (int node = 1; node < nodes; ++node) {
      const auto row = static_cast<std::size_t>(node);
      const double send = round + 0.05 * node / nodes;
      if (send < timeline.begin_s || send + 0.4 > timeline.end_s) continue;
      AddMessage(timeline, 0, row, send, send + 0.04 + 0.01 * (node % 3));
      AddMessage(timeline, row, 0, send + 0.2 + 0.04 * (node % 4), send + 0.31 + 0.03 * (node % 4));
    }
}

Table StatesOf(const Timeline& timeline) {
  Table table{"states",
              TableShape::kRows,
              {{"rank"}, {"user_s"}, {"system_s"}, {"message_s"}, {"idle_s"}},
              {}};
  for (const TimelineRow& row : timeline.rows) {
    StateShares sum{};
    for (const StateShares& shares : row.columns)
      for (std::size_t s = 0; s < kStateCount; ++s) sum[s] += shares[s];
    std::vector<Cell> cells{std::int64_t{row.rank}};
    for (const float share : sum)
      cells.emplace_back(static_cast<double>(share) / static_cast<double>(row.columns.size()) *
                         kSpan);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table MatrixOf(const Timeline& timeline, std::int64_t unit) {
  Table table{unit == 1 ? "messages" : "volume", TableShape::kMatrix, {{"sender"}}, {}};
  Random random(5);
  for (const TimelineRow& row : timeline.rows) table.columns.push_back({row.name});
  for (const TimelineRow& sender : timeline.rows) {
    std::vector<Cell> cells{sender.name};
    for (const TimelineRow& receiver : timeline.rows) {
      std::int64_t count = random() % 5 == 0 ? 2 + static_cast<std::int64_t>(random() % 20) : 0;
      if (sender.rank == 0 || receiver.rank == 0)
        count = 14 + static_cast<std::int64_t>(random() % 25);
      if (sender.is_host || receiver.is_host) count = 26 + static_cast<std::int64_t>(random() % 15);
      cells.emplace_back(sender.rank == receiver.rank ? std::int64_t{0} : count * unit);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table ProfileOf(std::size_t functions) {
  Table table{"profile",
              TableShape::kRows,
              {{"region"}, {"file"}, {"line"}, {"calls"}, {"inclusive_s"}, {"exclusive_s"}},
              {}};
  const char* names[] = {"stipple::Bvh::Intersect(stipple::Ray const&, stipple::Hit&) const",
                         "MPI_Recv",
                         "std::vector<std::unique_ptr<scene::Primitive<double, 3>, "
                         "std::default_delete<scene::Primitive<double, "
                         "3> > >, std::allocator<std::unique_ptr<scene::Primitive<double, 3> > > "
                         ">::emplace_back<scene::Sphere>",
                         "Shade<&Light::Sample, \"x\" & 'y'>",
                         "main",
                         "operator<<(std::ostream&, Colour const&)",
                         "MPI_Send"};
  double exclusive = 41.8;
  for (std::size_t i = 0; i < functions; ++i) {
    const std::string name = i < std::size(names) ? names[i] : fmt::format("Helper{}", i);
    const bool mpi = name.starts_with("MPI_");
    table.rows.push_back({name, std::string(mpi ? "" : "/home/user/raytracer/geometry/bvh.cpp"),
                          static_cast<std::int64_t>(mpi ? 0 : 40 + i),
                          static_cast<std::int64_t>(9'000'000 / (i * i + 1)), exclusive * 1.4,
                          exclusive});
    exclusive *= 0.72;
  }
  return table;
}

Table WaitsOf(int nodes) {
  Table table{
      "waits", TableShape::kRows, {{"kind"}, {"waiter"}, {"culprit"}, {"seconds"}, {"region"}}, {}};
  for (int i = 1; i < std::min(nodes, 40); ++i)
    table.rows.push_back(
        {std::string(i % 4 == 3 ? "wait-at-barrier" : "late-sender"), std::int64_t{i},
         std::int64_t{i % 7 == 6 ? 3 : 0}, 0.62 / i,
         std::string("stipple::Bvh::Intersect(stipple::Ray const&, stipple::Hit&) const")});
  return table;
}

/// Messages as the matrix says, spread evenly over the run.
MessageSeries MessagesOf(const ReportInput& report, bool all) {
  MessageSeries series;
  series.counts.resize(1024);
  series.bytes.resize(1024);
  Random random(11);
  for (std::size_t i = 0; i < report.messages.rows.size(); ++i)
    for (std::size_t k = 1; k < report.messages.rows[i].size(); ++k) {
      const std::int64_t count = std::get<std::int64_t>(report.messages.rows[i][k]);
      series.count += static_cast<std::uint64_t>(count);
      for (std::int64_t n = 0; n < std::min<std::int64_t>(count, 40); ++n) {
        const double time = Uniform(random, 0, kSpan);
        const auto column = static_cast<std::size_t>(time / kSpan * 1024);
        ++series.counts[column];
        series.bytes[column] += 970;
        if (all)
          series.all.push_back(
              {time, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k - 1), 970});
      }
    }
  std::ranges::stable_sort(series.all, {}, &MessageSeries::Dot::time_s);
  return series;
}

std::vector<WaitSeries> WaitSeriesOf(const Finding& finding) {
  std::vector<WaitSeries> series;
  for (const WaitedFor& w : finding.waited_for) {
    series.push_back({w.rank, w.name, w.region, std::vector<double>(256)});
    for (std::size_t i = 128; i < 256; ++i) series.back().seconds[i] = w.seconds / 128;
  }
  return series;
}

std::vector<FunctionSpread> SpreadsOf(const Table& profile, std::size_t ranks) {
  std::vector<FunctionSpread> spreads;
  Random random(17);
  for (std::size_t i = 0; i < std::min<std::size_t>(profile.rows.size(), 30); ++i) {
    const double mean = CellNumber(profile.rows[i][5]) / static_cast<double>(ranks);
    FunctionSpread spread{CellText(profile.rows[i][0]), {}};
    for (std::size_t k = 0; k < ranks; ++k)
      spread.seconds.push_back(mean * Uniform(random, 0.7, 1.3));
    spreads.push_back(std::move(spread));
  }
  return spreads;
}

/// Each function works evenly over the run, on every rank.
FunctionSeries FunctionsOf(const Table& profile, std::size_t ranks) {
  constexpr std::size_t kParts = 256;
  FunctionSeries series;
  series.all_ns.resize(kParts);
  const std::size_t rows = ranks > 64 ? 0 : ranks;
  for (std::size_t i = 0; i < std::min<std::size_t>(profile.rows.size(), 30); ++i) {
    const auto part = [&](std::size_t column, double scale) {
      return static_cast<std::uint64_t>(CellNumber(profile.rows[i][column]) * scale / kParts);
    };
    FunctionSeries::Function f{CellText(profile.rows[i][0]), i == 3, {}};
    f.columns.calls.assign(kParts, part(3, 1));
    f.columns.inclusive_ns.assign(kParts, part(4, 1e9));
    f.columns.exclusive_ns.assign(kParts, part(5, 1e9));
    f.columns.exclusive_by_rank.assign(
        rows, std::vector<std::uint64_t>(kParts, part(5, 1e9 / static_cast<double>(ranks))));
    for (std::size_t c = 0; c < kParts; ++c) series.all_ns[c] += f.columns.exclusive_ns[c];
    series.functions.push_back(std::move(f));
  }
  return series;
}

/// Messages as the matrix says, spread evenly over the run, and a wait for each pair.
PairSeries PairsOf(const ReportInput& report) {
  PairSeries series;
  const std::size_t ranks = report.messages.rows.size();
  const MatrixCells cells =
      CellsFor(ranks, !report.timeline.rows.empty() && report.timeline.rows.back().is_host);
  if (ranks < 2) return series;
  series.columns = 64;
  for (std::uint32_t c = 0; c < series.columns; ++c)
    for (std::uint32_t i = 0; i < cells.count; ++i)
      for (std::uint32_t k = 0; k < cells.count; ++k) {
        const double count =
            CellNumber(report.messages.rows[i * ranks / cells.count][k * ranks / cells.count + 1]);
        series.parts.push_back({c, i, k, static_cast<std::uint64_t>(count),
                                static_cast<std::uint64_t>(count * 970), 40'000 + i * 1000 + k});
      }
  return series;
}

Table PhasesOf(const Timeline& timeline) {
  Table table{"phases",
              TableShape::kRows,
              {{"begin_s"}, {"end_s"}, {"user"}, {"message"}, {"max_over_mean"}, {"busiest_rank"}},
              {}};
  const double ends[] = {0, 0.01 * kSpan, 0.3 * kSpan, kTurn, 0.9 * kSpan, kSpan};
  for (std::size_t i = 0; i + 1 < std::size(ends); ++i)
    table.rows.push_back(
        {ends[i], ends[i + 1], 0.61, 0.1, 1.5, std::int64_t{timeline.rows[0].rank}});
  return table;
}

/// What follows from the rest.
void AddSeries(ReportInput& report, bool all_messages) {
  report.function_series = FunctionsOf(report.profile, report.timeline.rows.size());
  report.pair_series = PairsOf(report);
  report.phases = PhasesOf(report.timeline);
  report.message_series = MessagesOf(report, all_messages);
  report.wait_series = WaitSeriesOf(report.finding);
  report.spreads = SpreadsOf(report.profile, report.timeline.rows.size());
  for (int i = 0; i < 10; ++i)
    report.longest_waits.push_back({"late-sender", 1 + i % 2, 0, kTurn + 0.7 * i,
                                    kTurn + 0.7 * i + 0.4 / (i + 1), "MPI_Recv"});
}

Finding FindingOf(int nodes, bool host) {
  Finding finding;
  finding.sentence = fmt::format("{0}s 1\u2013{1} spend 37% of the run waiting for {2} 0",
                                 host ? "Node" : "Rank", nodes - 1, host ? "node" : "rank");
  finding.detail =
      "It was in Bvh::Intersect, with 1.5 times the mean work; balanced, the run would take 11.9 "
      "s.";
  finding.culprit = 0;
  finding.max_over_mean = 1.5;
  finding.waited_for = {{0, "0", 47.5, "Bvh::Intersect"}};
  if (host) finding.waited_for.push_back({nodes, "host", 7.5, "HandOutBundles"});
  for (int i = 1; i < std::min(nodes, 9); ++i)
    finding.waited_for.push_back({i, std::to_string(i), 0.1, "Shade"});
  return finding;
}

constexpr std::size_t kColumns = 1024;

ReportInput Three() { return SampleReport(3, false); }
ReportInput Nine() { return SampleReport(8, true); }
ReportInput ThirtyTwo() { return SampleReport(32, true); }
ReportInput HundredTwentyEight() { return SampleReport(128, true); }
ReportInput Thousand() { return SampleReport(1024, false); }
ReportInput Noise() { return SampleNoise(1024); }
/// The same run, but ten hours long.
ReportInput TenHours() {
  ReportInput report = SampleReport(8, true);
  constexpr double kTimes = 36'000 / kSpan;
  for (Timeline* timeline : {&report.timeline, &report.detail}) {
    timeline->begin_s *= kTimes;
    timeline->end_s *= kTimes;
    for (TimelineMark& mark : timeline->marks) mark.time_s *= kTimes;
    for (TimelineMessage& message : timeline->messages) {
      message.send_s *= kTimes;
      message.receive_s *= kTimes;
    }
  }
  for (MessageSeries::Dot& dot : report.message_series.all) dot.time_s *= kTimes;
  return report;
}
ReportInput Mono() {
  ReportInput report = SampleReport(8, true);
  report.mono = true;
  return report;
}

}  // namespace

ReportInput SampleReport(int nodes, bool host) {
  ReportInput report;
  report.title = "raytracer --scene rings";
  report.finding = FindingOf(nodes, host);
  report.timeline = EmptyTimeline(nodes, host, 0, kSpan);
  report.detail = EmptyTimeline(nodes, host, kDetailBegin, kDetailEnd);
  for (std::size_t i = 0; i < report.timeline.rows.size(); ++i) {
    const Stretches stretches =
        StretchesOf(static_cast<int>(i), nodes, report.timeline.rows[i].is_host);
    report.timeline.rows[i].columns = Columns(stretches, 0, kSpan, kColumns);
    report.detail.rows[i].columns = Columns(stretches, kDetailBegin, kDetailEnd, kColumns);
  }
  if (host) report.timeline.marks.push_back({kTurn, "host has no more rays to hand out", nodes});
  AddRounds(report.detail, nodes);
  if (nodes <= 32) {
    AddRounds(report.timeline, nodes);
    Random random(3);
    for (double time = 0.1; time < kTurn; time += 0.02)
      AddMessage(report.timeline, random() % static_cast<unsigned>(nodes), 0, time, time + 0.01);
  }
  report.states = StatesOf(report.timeline);
  report.messages = MatrixOf(report.timeline, 1);
  report.volume = MatrixOf(report.timeline, 970);
  report.profile = ProfileOf(nodes > 8 ? 1234 : 12);
  report.waits = WaitsOf(nodes);
  report.facts = {fmt::format("{} {}{}", nodes, host ? "nodes" : "ranks", host ? " + host" : ""),
                  "18.4 s", "1,063 messages", "1.02 MB", "12.4 million events"};
  AddSeries(report, nodes <= 32);
  if (nodes == 3) report.health = {"1,204 events of rank 2 lost", "3 messages without a receive"};
  return report;
}

ReportInput SampleSerial() {
  ReportInput report;
  report.title = "sort";
  report.finding.sentence = "QuickSort takes 61% of the run";
  report.facts = {"1 process", "18.4 s", "204,118 events"};
  report.timeline = EmptyTimeline(1, false, 0, kSpan);
  report.timeline.rows[0].columns = Columns(StretchesOf(0, 1, false), 0, kSpan, kColumns);
  report.detail = report.timeline;
  report.states = StatesOf(report.timeline);
  report.profile = ProfileOf(7);
  return report;
}

ReportInput SampleNoise(int ranks) {
  Random random(1);
  ReportInput report = SampleReport(2, false);
  report.timeline = EmptyTimeline(ranks, false, 0, kSpan);
  report.detail = EmptyTimeline(ranks, false, 4, 5);
  for (Timeline* timeline : {&report.timeline, &report.detail})
    for (TimelineRow& row : timeline->rows)
      for (std::size_t i = 0; i < kColumns; ++i) {
        const auto user = static_cast<float>(Uniform(random, 0, 0.7));
        const auto message = static_cast<float>(Uniform(random, 0, 0.3));
        row.columns.push_back({user, 0.0F, message, 1 - user - message});
      }
  for (int i = 0; i < 3000; ++i) {
    const auto count = static_cast<unsigned>(ranks);
    const double send = Uniform(random, 4, 4.9);
    AddMessage(report.detail, random() % count, random() % count, send, send + 0.05);
  }
  report.states = StatesOf(report.timeline);
  for (Table* table : {&report.messages, &report.volume}) {
    *table = MatrixOf(report.timeline, 1);
    for (std::vector<Cell>& row : table->rows)
      for (std::size_t i = 1; i < row.size(); ++i)
        row[i] = static_cast<std::int64_t>(random() % 1'000'000);
  }
  report.profile = ProfileOf(5000);
  for (std::vector<Cell>& row : report.profile.rows)
    row[0] = std::string(5000, '<') + std::get<std::string>(row[0]);
  report.longest_waits.clear();
  AddSeries(report, false);
  return report;
}

ReportInput SampleEmpty() {
  ReportInput report;
  report.title = "a.out";
  report.timeline = EmptyTimeline(1, false, 0, 0);
  report.timeline.rows[0].columns.assign(1, StateShares{});
  return report;
}

CompareInput SampleCompare(int nodes_a, int nodes_b) {
  CompareInput input;
  for (ComparedRun* run : {&input.a, &input.b}) {
    const bool first = run == &input.a;
    const int nodes = first ? nodes_a : nodes_b;
    ReportInput report = SampleReport(nodes, nodes > 1);
    run->name = first ? "before" : "after";
    run->program = report.title;
    run->span_s = first ? kSpan : kSpan * 0.8;
    run->timeline = std::move(report.timeline);
    run->messages = std::move(report.messages);
    run->volume = std::move(report.volume);
    run->state_s = {9.1, 0.4, first ? 1.2 : 1.5, first ? 7.7 : 3.7};
    run->has_system = true;
    run->waited_s = {{"node 0", first ? 5.9 : 1.8}, {"the host", 1.1}};
    run->facts = std::move(report.facts);
  }
  input.headline = CompareHeadline(input.a, input.b);
  if (nodes_a != nodes_b) input.notes = {"Different numbers of ranks."};
  input.functions = {"functions",
                     TableShape::kRows,
                     {{"region"}, {"a_s"}, {"b_s"}, {"change_s"}, {"a_calls"}, {"b_calls"}},
                     {}};
  for (int i = 0; i < 60; ++i)
    input.functions.rows.push_back({fmt::format("Helper{}(int)", i), 4.0 / (i + 1), 3.0 / (i + 1),
                                    -1.0 / (i + 1), std::int64_t{4}, std::int64_t{i}});
  return input;
}

std::span<const SampleEntry> Samples() {
  static constexpr SampleEntry kSamples[] = {{"serial", SampleSerial},
                                             {"three", Three},
                                             {"nine", Nine},
                                             {"thirty-two", ThirtyTwo},
                                             {"hundred", HundredTwentyEight},
                                             {"thousand", Thousand},
                                             {"noise", Noise},
                                             {"ten-hours", TenHours},
                                             {"mono", Mono},
                                             {"empty", SampleEmpty}};
  return kSamples;
}

ViewInput ViewsOfSample(const ReportInput& report) {
  return {&report.timeline, &report.detail, &report.states,
          &report.messages, &report.volume, &report.finding};
}

}  // namespace stipple
