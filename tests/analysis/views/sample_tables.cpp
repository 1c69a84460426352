// SPDX-License-Identifier: MIT
#include "sample_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace stipple {
namespace {

constexpr double kSpan = 18.4;

/// Makes cells: plausible numbers, or what the sample asks for.
struct Maker {
  int ranks;
  bool host;
  Values values;
  std::mt19937 random{7};

  Cell Number(double sound) {
    switch (values) {
      case Values::kZero:
        return 0.0;
      case Values::kMissing:
        return {};
      case Values::kHuge:
        return random() % 3 == 0 ? 1.7e308 : 9.1e18;
      case Values::kTiny:
        return 3e-310;
      case Values::kNegative:
        return -sound;
      case Values::kNotFinite: {
        const unsigned which = random() % 4;
        if (which == 0) return std::numeric_limits<double>::quiet_NaN();
        if (which == 1) return std::numeric_limits<double>::infinity();
        if (which == 2) return -std::numeric_limits<double>::infinity();
        return sound;
      }
      default:
        return sound;
    }
  }
  Cell Count(double sound) {
    if (values == Values::kHuge) return std::numeric_limits<std::int64_t>::max();
    if (values == Values::kNegative) return std::numeric_limits<std::int64_t>::min();
    if (values == Values::kZero) return std::int64_t{0};
    if (values == Values::kMissing) return {};
    return static_cast<std::int64_t>(sound);
  }
  Cell Rank(int i) const {
    if (host && i == ranks) return std::string("host");
    return std::int64_t{i};
  }
  int All() const { return ranks + (host ? 1 : 0); }
  double Noise(double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000;
  }
  /// How busy a rank is: rank 0 always, the others in rounds after the turn, the host hardly.
  double Busy(int rank, double time) {
    if (host && rank == ranks) return time < 9.1 ? Noise(0.05, 0.12) : 0;
    if (rank == 0) return Noise(0.88, 0.97);
    if (time < 9.1) return Noise(0.72, 0.86);
    return 0.34 + 0.26 * std::sin(time * 2.2 + rank * 0.8) + Noise(-0.04, 0.04);
  }
  int Steps() const { return values == Values::kOne ? 1 : ranks > 100 ? 60 : 230; }
};

Table Utilisation(Maker& maker) {
  Table table{"utilisation",
              TableShape::kRows,
              {{"time_s"}, {"window"}, {"since_start"}, {"least"}, {"most"}},
              {}};
  double sum = 0;
  for (int i = 0; i < maker.Steps(); ++i) {
    const double time = kSpan * i / maker.Steps();
    double mean = 0, least = 1, most = 0;
    for (int rank = 0; rank < std::min(maker.ranks, 40); ++rank) {
      const double busy = maker.Busy(rank, time);
      mean += busy / std::min(maker.ranks, 40);
      least = std::min(least, busy), most = std::max(most, busy);
    }
    sum += mean;
    table.rows.push_back(RowOf(time, maker.Number(mean), maker.Number(sum / (i + 1)),
                               maker.Number(least), maker.Number(most)));
  }
  return table;
}

Table UtilisationByRank(Maker& maker) {
  Table table{
      "utilisation", TableShape::kRows, {{"time_s"}, {"rank"}, {"window"}, {"since_start"}}, {}};
  std::vector<double> sums(static_cast<std::size_t>(maker.All()), 0);
  for (int i = 0; i < maker.Steps(); ++i)
    for (int rank = 0; rank < maker.All(); ++rank) {
      const double time = kSpan * i / maker.Steps(), busy = maker.Busy(rank, time);
      double& sum = sums[static_cast<std::size_t>(rank)];
      sum += busy;
      table.rows.push_back(
          RowOf(time, maker.Rank(rank), maker.Number(busy), maker.Number(sum / (i + 1))));
    }
  return table;
}

Table Load(Maker& maker) {
  Table table{"load",
              TableShape::kRows,
              {{"time_s"}, {"messages"}, {"bytes"}, {"messages_per_s"}, {"bytes_per_s"}},
              {}};
  for (int i = 0; i < maker.Steps(); ++i) {
    const double messages = std::floor(maker.Noise(20, 60) * (i < maker.Steps() / 2 ? 2 : 1));
    const double step = kSpan / maker.Steps();
    table.rows.push_back(RowOf(kSpan * i / maker.Steps(), maker.Count(messages),
                               maker.Count(messages * 970), maker.Number(messages / step),
                               maker.Number(messages * 970 / step)));
  }
  return table;
}

Table States(Maker& maker) {
  Table table{"states",
              TableShape::kRows,
              {{"rank"}, {"user_s"}, {"system_s"}, {"message_s"}, {"idle_s"}},
              {}};
  for (int rank = 0; rank < maker.All(); ++rank) {
    const double busy = maker.Busy(rank, 3) * kSpan;
    table.rows.push_back(RowOf(maker.Rank(rank), maker.Number(busy * 0.9),
                               rank % 2 == 0 ? maker.Number(busy * 0.03) : Cell(),
                               maker.Number(busy * 0.07), maker.Number(kSpan - busy)));
  }
  return table;
}

Table Status(Maker& maker) {
  Table table{"status",
              TableShape::kRows,
              {{"time_s"}, {"rank"}, {"state"}, {"user"}, {"system"}, {"message"}, {"idle"}},
              {}};
  constexpr const char* kWords[] = {"user", "idle", "message", "system", "user", "idle"};
  for (int i = 0; i < std::min(maker.Steps(), 12); ++i)
    for (int rank = 0; rank < maker.All(); ++rank) {
      const double busy = maker.Busy(rank, kSpan * i / 12);
      table.rows.push_back(RowOf(kSpan * i / 12, maker.Rank(rank),
                                 std::string(kWords[maker.random() % 6]), maker.Number(busy * 0.8),
                                 maker.Number(busy * 0.05), maker.Number(busy * 0.15),
                                 maker.Number(1 - busy)));
    }
  return table;
}

Table Switches(Maker& maker) {
  Table table{"switches",
              TableShape::kRows,
              {{"rank"}, {"process"}, {"thread"}, {"switches"}, {"blocked"}, {"blocked_s"}},
              {}};
  for (int rank = 0; rank < maker.All(); ++rank)
    for (int thread = 0; thread < 2; ++thread)
      table.rows.push_back(RowOf(maker.Rank(rank), std::int64_t{rank}, std::int64_t{thread},
                                 maker.Count(maker.Noise(100, 9000)),
                                 maker.Count(maker.Noise(50, 4000)),
                                 maker.Number(maker.Noise(0, 3))));
  return table;
}

Table Sizes(Maker& maker) {
  Table table{"sizes", TableShape::kRows, {{"low"}, {"high"}, {"messages"}, {"bytes"}}, {}};
  const int classes = maker.values == Values::kOne ? 1 : 24;
  for (int i = 0; i < classes; ++i) {
    const double low = i == 0 ? 0 : std::pow(2, i - 1), high = std::pow(2, i);
    const double messages = std::floor(9000 * std::exp(-0.1 * (i - 9) * (i - 9)));
    table.rows.push_back(RowOf(static_cast<std::int64_t>(low), static_cast<std::int64_t>(high),
                               maker.Count(messages), maker.Count(messages * low)));
  }
  return table;
}

Table Types(Maker& maker) {
  Table table{"types", TableShape::kRows, {{"tag"}, {"messages"}, {"bytes"}}, {}};
  for (int i = 0; i < (maker.values == Values::kOne ? 1 : std::min(maker.ranks, 200)); ++i)
    table.rows.push_back(RowOf(std::int64_t{i * 37}, maker.Count(maker.Noise(1, 4000)),
                               maker.Count(maker.Noise(1, 4e6))));
  return table;
}

Table Matrix(Maker& maker, const char* name, double factor) {
  Table table{name, TableShape::kMatrix, {{"sender"}}, {}};
  const auto name_of = [&](int i) {
    return maker.host && i == maker.ranks ? std::string("host") : std::to_string(i);
  };
  for (int i = 0; i < maker.All(); ++i) table.columns.push_back({name_of(i)});
  for (int i = 0; i < maker.All(); ++i) {
    std::vector<Cell>& row = table.rows.emplace_back();
    row.emplace_back(name_of(i));
    for (int k = 0; k < maker.All(); ++k) {
      const bool sent = i != k && (maker.random() % 4 == 0 || i == maker.ranks || k == maker.ranks);
      row.push_back(sent ? maker.Count(maker.Noise(1, 60) * factor) : Cell(std::int64_t{0}));
    }
  }
  return table;
}

Table Profile(Maker& maker) {
  Table table{"profile",
              TableShape::kRows,
              {{"region"}, {"file"}, {"line"}, {"calls"}, {"inclusive_s"}, {"exclusive_s"}},
              {}};
  for (int i = 0; i < (maker.values == Values::kOne ? 1 : std::min(5 * maker.ranks, 900)); ++i)
    table.rows.push_back(
        RowOf(fmt::format("stipple::Bvh<float, {}>::Intersect{}(stipple::Ray const&) const", i, i),
              std::string("raytracer/geometry/bvh.cpp"), std::int64_t{i + 12},
              maker.Count(std::pow(10, maker.Noise(0, 7))),
              maker.Number(std::pow(10, maker.Noise(-4, 2))),
              maker.Number(std::pow(10, maker.Noise(-5, 1)))));
  return table;
}

void AddPaths(Maker& maker, Table& table, std::vector<std::string> path, double time, int depth) {
  table.rows.push_back(
      RowOf(path, maker.Count(time * 1000), maker.Number(time), maker.Number(time * 0.2)));
  if (depth == 0) return;
  constexpr const char* kNames[] = {
      "Render",   "TraceRay", "Bvh::Intersect",
      "MPI_Recv", "Shade",    "void a::(anonymous namespace)::F<int>(int) const",
      "MPI_Send"};
  double left = time * 0.8;
  for (int i = 0; i < 4; ++i) {
    const double part = left * 0.5;
    left -= part;
    std::vector<std::string> below = path;
    below.push_back(fmt::format("{}", kNames[(depth * 3 + i) % 7]));
    AddPaths(maker, table, below, part, depth - 1);
  }
}

Table CallPaths(Maker& maker) {
  Table table{
      "callpaths", TableShape::kTree, {{"path"}, {"calls"}, {"inclusive_s"}, {"exclusive_s"}}, {}};
  const int depth = maker.values == Values::kOne ? 0 : maker.ranks > 30 ? 6 : 4;
  AddPaths(maker, table, {"main"}, kSpan * maker.ranks, depth);
  AddPaths(maker, table, {"<span> & \"worker\" \xff"}, kSpan, 2);
  AddPaths(maker, table, {std::string(kSamplesPath)}, kSpan, 1);
  return table;
}

Table Waits(Maker& maker) {
  Table table{
      "waits", TableShape::kRows, {{"kind"}, {"waiter"}, {"culprit"}, {"seconds"}, {"region"}}, {}};
  for (int i = 0; i < maker.ranks; ++i)
    table.rows.push_back(RowOf(std::string("late-sender"), std::int64_t{i}, std::int64_t{0},
                               maker.Number(maker.Noise(0, 2)), std::string("Shade")));
  return table;
}

}  // namespace

std::vector<Table> SampleTables(int ranks, bool host, Values values) {
  Maker maker{ranks, host, values};
  std::vector<Table> tables = {Utilisation(maker),
                               UtilisationByRank(maker),
                               Load(maker),
                               States(maker),
                               Status(maker),
                               Switches(maker),
                               Sizes(maker),
                               Types(maker),
                               Matrix(maker, "messages", 1),
                               Matrix(maker, "volume", 970),
                               Profile(maker),
                               CallPaths(maker),
                               Waits(maker)};
  if (values == Values::kEmpty)
    for (Table& table : tables) table.rows.clear();
  return tables;
}

}  // namespace stipple
