// SPDX-License-Identifier: MIT
#include "analysis/report/watch_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "analysis/report/text.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/number.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/time_sums.h"
#include "analysis/trace/demangle.h"
#include "analysis/views/palette.h"

namespace stipple {
namespace {

constexpr std::size_t kLabel = 9;      // "host", "100-131"
constexpr std::size_t kBar = 12;       // of shares
constexpr std::size_t kShare = 5;      // " 100%"
constexpr std::size_t kLeastLine = 8;  // of the timeline
constexpr std::size_t kLeastWidth = kLabel + kLeastLine + 2 * (2 + kBar + kShare);
constexpr std::size_t kMostRegions = 5;
constexpr std::size_t kMostCulprits = 3;

/// By State: patterns as dense as the state is busy. Nobody there: a blank.
constexpr std::array<char, kStateCount> kPatterns = {'#', '%', '=', '.'};
constexpr std::array<int, kStateCount> kPalette = {67, 89, 214, 255};
constexpr std::array<std::string_view, kStateCount> kShortNames = {"user", "system", "message",
                                                                   "idle"};

double Seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

/// Puts characters of states side by side; neighbours share their colour's code.
class Painter {
 public:
  explicit Painter(WatchColours colours) : colours_(colours) {}
  void Add(std::optional<State> state) {
    if (state != last_) Switch(state);
    text_ += state ? kPatterns[static_cast<std::size_t>(*state)] : ' ';
  }
  std::string Take() {
    Switch(std::nullopt);
    return std::exchange(text_, {});
  }

 private:
  void Switch(std::optional<State> state) {
    if (colours_ != WatchColours::kNone && last_) text_ += "\x1b[0m";
    last_ = state;
    if (colours_ == WatchColours::kNone || !state) return;
    const auto s = static_cast<std::size_t>(*state);
    const Colour c = kStateColours[s];
    // The pattern stays, a shade off its ground: who cannot tell the colours sees it.
    text_ += colours_ == WatchColours::kTrue
                 ? fmt::format("\x1b[48;2;{};{};{}m\x1b[38;5;{}m", c.red, c.green, c.blue,
                               *state == State::kIdle ? 250 : 188)
                 : fmt::format("\x1b[48;5;{}m\x1b[38;5;{}m", kPalette[s],
                               *state == State::kIdle ? 250 : 188);
  }

  WatchColours colours_;
  std::optional<State> last_;
  std::string text_;
};

using TimeByState = std::array<std::int64_t, kStateCount>;

/// One line: a rank, or neighbours together.
struct Row {
  std::string label;
  std::vector<int> ranks;
  std::vector<TimeByState> columns;  // of the timeline
  TimeByState last{};
  TimeByState whole{};
};

/// The moments that a line asks for.
struct Moments {
  std::vector<std::int64_t> columns;  // begin of the first, ends of all
  std::int64_t last_ns = 0;           // begin of the last window
  std::int64_t end_ns = 0;
};

Moments MomentsOf(const WatchReading& reading, std::size_t columns) {
  Moments m;
  m.end_ns = std::max<std::int64_t>(1, reading.analysis.trace.SpanNs());
  m.last_ns = std::max<std::int64_t>(0, m.end_ns - reading.window_ns);
  for (std::size_t c = 0; c <= columns; ++c)
    m.columns.push_back(static_cast<std::int64_t>(
        static_cast<double>(m.end_ns) * static_cast<double>(c) / static_cast<double>(columns)));
  m.columns.back() = m.end_ns;
  return m;
}

void AddTimes(StateClock& clock, std::int64_t begin_ns, std::int64_t end_ns, TimeByState& to) {
  for (std::size_t s = 0; s < kStateCount; ++s)
    to[s] += static_cast<std::int64_t>(SpentIn(clock, static_cast<State>(s), begin_ns, end_ns));
}

/// Ranks in at most `most` lines, each of about as many neighbours; a host has one of its own.
std::vector<Row> RowsOf(const Trace& trace, std::size_t most) {
  std::vector<int> nodes;
  std::vector<Row> hosts;
  for (const int rank : trace.RanksInOrder()) {
    if (trace.IsHost(rank))
      hosts.push_back({trace.RankName(rank), {rank}, {}, {}, {}});
    else
      nodes.push_back(rank);
  }
  const std::size_t lines = std::max<std::size_t>(1, most > hosts.size() ? most - hosts.size() : 1);
  const std::size_t group = std::max<std::size_t>(1, (nodes.size() + lines - 1) / lines);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < nodes.size(); i += group) {
    const std::size_t end = std::min(nodes.size(), i + group);
    Row row;
    row.ranks.assign(nodes.begin() + static_cast<std::ptrdiff_t>(i),
                     nodes.begin() + static_cast<std::ptrdiff_t>(end));
    row.label = group == 1 || end - i == 1 ? trace.RankName(nodes[i])
                                           : fmt::format("{}-{}", nodes[i], nodes[end - 1]);
    rows.push_back(std::move(row));
  }
  std::ranges::move(hosts, std::back_inserter(rows));
  return rows;
}

void Fill(Row& row, const Analysis& analysis, const Moments& m) {
  row.columns.resize(m.columns.size() - 1);
  for (const int rank : row.ranks) {
    StateClock clock(analysis, *analysis.trace.MainOf(rank));
    for (std::size_t c = 0; c < row.columns.size(); ++c)
      AddTimes(clock, m.columns[c], m.columns[c + 1], row.columns[c]);
    AddTimes(clock, m.last_ns, m.end_ns, row.last);
    AddTimes(clock, 0, m.end_ns, row.whole);
  }
}

/// The state with most of the time; none: mostly nobody was there.
std::optional<State> MostOf(const TimeByState& times, std::int64_t whole_ns) {
  const auto most = std::ranges::max_element(times);
  std::int64_t sum = 0;
  for (const std::int64_t t : times) sum += t;
  if (*most == 0 || *most < whole_ns - sum) return std::nullopt;
  return static_cast<State>(most - times.begin());
}

/// States side by side, as long as their shares, and the share of user.
std::string ShareText(const TimeByState& times, std::int64_t whole_ns, Painter& painter) {
  std::int64_t done = 0;
  std::size_t shown = 0;
  const auto cells = [whole_ns](std::int64_t ns) {
    return static_cast<std::size_t>(static_cast<double>(ns) / static_cast<double>(whole_ns) * kBar +
                                    0.5);
  };
  for (std::size_t s = 0; s < kStateCount; ++s) {
    done += times[s];
    for (; shown < std::min(kBar, cells(done)); ++shown) painter.Add(static_cast<State>(s));
  }
  for (; shown < kBar; ++shown) painter.Add(std::nullopt);
  return painter.Take() +
         fmt::format("{:>{}}",
                     FormatPercent(static_cast<double>(times[0]) / static_cast<double>(whole_ns)),
                     kShare);
}

/// At most `width` characters of UTF-8.
std::string Cut(std::string text, std::size_t width) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0) == 0x80) continue;
    if (++characters > width) {
      text.resize(i);
      break;
    }
  }
  return text;
}

std::string LegendText(WatchColours colours) {
  Painter painter(colours);
  std::string text(kLabel, ' ');
  for (std::size_t s = 0; s < kStateCount; ++s) {
    for (int i = 0; i < 2; ++i) painter.Add(static_cast<State>(s));
    text += painter.Take() + " " + std::string(kShortNames[s]) + (s + 1 < kStateCount ? "  " : "");
  }
  return text;
}

void AddRanks(const WatchReading& reading, const WatchLook& look, std::size_t most_rows,
              std::vector<std::string>& lines) {
  const Analysis& analysis = reading.analysis;
  const std::size_t width = std::max(look.width, kLeastWidth);
  const std::size_t columns = width - kLeastWidth + kLeastLine;
  const Moments m = MomentsOf(reading, columns);
  lines.push_back(LegendText(look.colours));
  lines.push_back(fmt::format("{:<{}}{:<{}}  {:<{}}  {}", "rank", kLabel,
                              Cut("the run, " + FormatSeconds(Seconds(m.end_ns)), columns), columns,
                              Cut("last " + FormatSeconds(Seconds(m.end_ns - m.last_ns)), kBar + 5),
                              kBar + kShare, "in all, user"));
  for (Row& row : RowsOf(analysis.trace, most_rows)) {
    Fill(row, analysis, m);
    Painter painter(look.colours);
    const auto count = static_cast<std::int64_t>(row.ranks.size());
    for (std::size_t c = 0; c < columns; ++c)
      painter.Add(MostOf(row.columns[c], count * (m.columns[c + 1] - m.columns[c])));
    std::string line = fmt::format("{:<{}}", row.label, kLabel) + painter.Take();
    line += "  " + ShareText(row.last, count * (m.end_ns - m.last_ns), painter);
    line += "  " + ShareText(row.whole, count * m.end_ns, painter);
    lines.push_back(std::move(line));
  }
}

std::vector<std::string> RegionLines(const Analysis& analysis) {
  std::vector<RegionTime> times = SumOfMains(analysis, {});
  double sum = 0;
  for (std::size_t r = 0; r < times.size(); ++r) {
    times[r].region = static_cast<std::uint32_t>(r);
    sum += times[r].exclusive_ns;
  }
  std::ranges::stable_sort(times, std::greater<>(), &RegionTime::exclusive_ns);
  std::vector<std::string> lines;
  for (const RegionTime& t : times) {
    if (lines.size() == kMostRegions || !(t.exclusive_ns > 0)) break;
    lines.push_back(fmt::format("{:>5}  {}  {}", FormatPercent(t.exclusive_ns / sum),
                                ShortName(analysis.trace.regions()[t.region].name),
                                FormatCount(t.calls, "call")));
  }
  if (!lines.empty()) lines.insert(lines.begin(), "most time itself");
  return lines;
}

std::vector<std::string> CulpritLines(const Finding& finding) {
  std::vector<std::string> lines;
  for (const WaitedFor& w : finding.waited_for) {
    if (lines.size() == kMostCulprits || !(w.seconds > 0)) break;
    lines.push_back(fmt::format("{:>9}  {}{}{}", FormatSeconds(w.seconds),
                                w.name == "host" ? "the " : "rank ", w.name,
                                w.region.empty() ? "" : ", in " + ShortName(w.region)));
  }
  if (!lines.empty()) lines.insert(lines.begin(), "waited for, by all together");
  return lines;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return lines;
}

std::string FirstLine(const WatchReading& reading) {
  const Trace& trace = reading.analysis.trace;
  const bool running = trace.header_health().Running();
  std::string text =
      fmt::format("{}: {}, {} {}, {}", trace.Program(),
                  FormatCount(static_cast<std::uint64_t>(trace.RankCount()), "rank"),
                  running ? "running, recorded until" : "ended at",
                  FormatSeconds(Seconds(trace.SpanNs())), FormatCount(reading.events, "event"));
  if (reading.per_s) text += fmt::format(", {} a second", FormatShort(*reading.per_s));
  if (reading.analysis.health.LostEvents() != 0 || reading.analysis.health.LostUncounted())
    text += ", " + LossText(reading.analysis.health);
  return text;
}

}  // namespace

WatchReading::WatchReading(const Analysis& of, std::int64_t last_ns, const WatchBefore& before)
    : analysis(of), window_ns(last_ns), events(of.trace.EventCount()) {
  const Selection all;
  finding = FindingOf(of, all, BlameOf(of, all));
  const std::int64_t span_ns = of.trace.SpanNs();
  if (events >= before.events && span_ns > before.span_ns)
    per_s = static_cast<double>(events - before.events) / Seconds(span_ns - before.span_ns);
  else if (span_ns > 0)
    per_s = static_cast<double>(events) / Seconds(span_ns);
}

std::vector<std::string> WatchLines(const WatchReading& reading, const WatchLook& look) {
  std::vector<std::string> lines = {FirstLine(reading), reading.finding.sentence, ""};
  std::vector<std::string> below;
  if (reading.table) {
    lines[1] = reading.table->headline;
    below = LinesOf(TableText(reading.table->table));
  } else {
    for (auto some : {RegionLines(reading.analysis), CulpritLines(reading.finding)}) {
      if (!some.empty()) below.emplace_back();
      std::ranges::move(some, std::back_inserter(below));
    }
    constexpr std::size_t kHeadLines = 2;
    const std::size_t others = lines.size() + kHeadLines + below.size();
    const std::size_t least = 4;
    const std::size_t most = look.height == 0 ? reading.analysis.trace.locations().size() + 1
                             : look.height > others + least ? look.height - others
                                                            : least;
    // Their lines hold codes of colours and have the right width by themselves.
    AddRanks(reading, look, most, lines);
  }
  for (std::size_t i = 0; i < 2; ++i) lines[i] = Cut(lines[i], look.width);
  for (std::string& line : below) lines.push_back(Cut(std::move(line), look.width));
  if (look.height != 0 && lines.size() > look.height) lines.resize(look.height);
  return lines;
}

}  // namespace stipple
