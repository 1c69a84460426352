// SPDX-License-Identifier: MIT
#include "analysis/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/views/layout.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostStateBytes = 350'000;
constexpr std::size_t kLeastBins = 32;
constexpr std::size_t kMostMarks = 300;
constexpr double kTolerance = 2;  // units of one column

using Bytes = std::vector<std::uint8_t>;

std::span<const std::uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Whole numbers, seven bits a byte, the lowest first.
void AddNumber(Bytes& bytes, std::uint64_t number) {
  for (; number >= 128; number >>= 7)
    bytes.push_back(static_cast<std::uint8_t>(number & 127) | std::uint8_t{128});
  bytes.push_back(static_cast<std::uint8_t>(number));
}

template <class Numbers>
std::string NumbersText(const Numbers& numbers) {
  Bytes bytes;
  for (const auto number : numbers) AddNumber(bytes, static_cast<std::uint64_t>(number));
  return '"' + Base64(bytes) + '"';
}

/// The three states but idle of the ranks of one drawn row.
std::string StatesText(std::span<const TimelineRow> ranks, std::size_t bins) {
  const std::vector<StateShares> columns = AverageColumns(ranks, bins);
  std::string text = "[";
  for (std::size_t s = 0; s < 3; ++s) {
    std::vector<double> shares;
    for (const StateShares& column : columns) shares.push_back(static_cast<double>(column[s]));
    text += fmt::format("{}\"{}\"", s == 0 ? "" : ",",
                        Base64(BytesOf(PackBits(BytesOf(ByteShares(shares))))));
  }
  return text + "]";
}

std::string RowName(std::span<const TimelineRow> ranks, bool host) {
  std::string name = RowLabel(ranks.front(), host);
  if (ranks.size() > 1) name += "\u2013" + ranks.back().name;
  return name;
}

/// Begin and end of a rank as its columns tell: a rank has time from the first that is not empty.
/// Of several ranks the mean.
std::pair<double, double> LifeOf(const Timeline& timeline, std::span<const TimelineRow> ranks) {
  double begin = 0, end = 0;
  for (const TimelineRow& rank : ranks) {
    const auto count = static_cast<double>(rank.columns.size());
    const auto share = [](const StateShares& c) {
      return std::min(1.0, static_cast<double>(c[0] + c[1] + c[2] + c[3]));
    };
    double first = 0, last = count;
    for (const StateShares& c : rank.columns) {
      if (share(c) > 0.999) break;
      first += 1 - share(c);
    }
    for (auto c = rank.columns.rbegin(); c != rank.columns.rend() && last > first; ++c) {
      if (share(*c) > 0.999) break;
      last -= 1 - share(*c);
    }
    begin += first / std::max(count, 1.0);
    end += std::max(first, last) / std::max(count, 1.0);
  }
  const double span = timeline.end_s - timeline.begin_s, n = static_cast<double>(ranks.size());
  return {timeline.begin_s + span * begin / n, timeline.begin_s + span * end / n};
}

std::string RowsText(const Timeline& timeline, const RowGrid& grid, std::size_t bins) {
  const std::span<const TimelineRow> ranks(timeline.rows);
  const bool host = HasHost(ranks);
  std::string text = "[";
  for (const GridRow& row : grid.rows) {
    const std::span<const TimelineRow> some = ranks.subspan(row.first, row.count);
    const auto [begin, end] = LifeOf(timeline, some);
    text += fmt::format(
        R"({}{{"name":"{}","y":{},"h":{},"n":{},"host":{},"label":{},"from":{:.9g},"to":{:.9g},"s":{}}})",
        text.size() == 1 ? "" : ",", JsonText(RowName(some, host)), row.y, row.height, row.count,
        some.front().is_host ? 1 : 0, row.label.empty() ? 0 : 1, begin, end,
        StatesText(some, bins));
  }
  return text + "]";
}

std::size_t MostBins(const Timeline& timeline) {
  std::size_t most = 1;
  for (const TimelineRow& row : timeline.rows) most = std::max(most, row.columns.size());
  return most;
}

/// Rows with as many columns as the budget allows.
std::string States(const Timeline& timeline, const RowGrid& grid, std::size_t budget) {
  for (std::size_t bins = MostBins(timeline);; bins = (bins + 1) / 2) {
    const std::string rows = RowsText(timeline, grid, bins);
    if (rows.size() <= budget || bins <= kLeastBins)
      return fmt::format(R"("bins":{},"rows":{})", bins, rows);
  }
}

/// Where each rank of the timeline is drawn.
std::string RowOfRank(const Timeline& timeline, const RowGrid& grid) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < timeline.rows.size(); ++i) rows.push_back(grid.RowOf(i));
  return NumbersText(rows);
}

std::string MarksText(const Timeline& timeline) {
  std::string text = R"("marks":[)";
  const std::size_t count = std::min(timeline.marks.size(), kMostMarks);
  for (std::size_t i = 0; i < count; ++i)
    text += fmt::format("{}[{:.9g},\"{}\"]", i == 0 ? "" : ",", timeline.marks[i].time_s,
                        JsonText(ShortenMiddle(timeline.marks[i].label, 40)));
  return text + "]";
}

std::string MessagesText(const MessageSeries& messages, const Timeline& timeline) {
  std::string text =
      fmt::format(R"("messages":{{"count":{},"bins":{})", messages.count, messages.counts.size());
  if (!messages.counts.empty())
    text += R"(,"counts":)" + NumbersText(messages.counts) + R"(,"bytes":)" +
            NumbersText(messages.bytes);
  if (!messages.all.empty()) {
    constexpr double kSteps = 1 << 30;
    Bytes bytes;
    std::uint64_t last = 0;
    for (const MessageSeries::Dot& dot : messages.all) {
      const double place = (dot.time_s - timeline.begin_s) / (timeline.end_s - timeline.begin_s);
      const auto step = static_cast<std::uint64_t>(std::clamp(place, 0.0, 1.0) * kSteps);
      AddNumber(bytes, step - std::min(last, step));
      AddNumber(bytes, dot.sender_row);
      AddNumber(bytes, dot.receiver_row);
      AddNumber(bytes, dot.bytes);
      last = std::max(last, step);
    }
    text += R"(,"all":")" + Base64(bytes) + '"';
  }
  return text + "}";
}

std::string WaitsText(const std::vector<WaitSeries>& waits) {
  std::string text = R"("waits":[)";
  for (const WaitSeries& wait : waits) {
    std::vector<std::uint64_t> microseconds;
    for (const double seconds : wait.seconds)
      microseconds.push_back(static_cast<std::uint64_t>(std::llround(seconds * 1e9)));
    text += fmt::format(R"({}{{"rank":{},"name":"{}","region":"{}","ns":{}}})",
                        &wait == waits.data() ? "" : ",", wait.rank, JsonText(wait.name),
                        JsonText(ShortenMiddle(wait.region, 60)), NumbersText(microseconds));
  }
  return text + "]";
}

}  // namespace

std::string Base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kLetters[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string PackBits(std::span<const std::uint8_t> bytes) {
  std::string packed;
  std::size_t literal = 0;  // where its count stands; npos: none is open
  literal = std::string::npos;
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t run = 1;
    while (i + run < bytes.size() && run < 130 && bytes[i + run] == bytes[i]) ++run;
    if (run >= 3) {
      packed += static_cast<char>(static_cast<std::uint8_t>(258 - run));
      packed += static_cast<char>(bytes[i]);
      literal = std::string::npos;
      i += run;
      continue;
    }
    if (literal == std::string::npos || static_cast<std::uint8_t>(packed[literal]) == 127) {
      literal = packed.size();
      packed += static_cast<char>(-1);
    }
    packed[literal] = static_cast<char>(packed[literal] + 1);
    packed += static_cast<char>(bytes[i++]);
  }
  return packed;
}

std::string ByteShares(std::span<const double> shares) {
  std::string bytes;
  double truth = 0, told = 0, last = 0;
  for (const double share : shares) {
    truth += std::clamp(share, 0.0, 1.0) * 255;
    // What stood before stands on while that is near enough: runs pack well. Nothing and all are
    // never told of what is not.
    const bool near = std::abs(truth - told - last) <= kTolerance &&
                      std::abs(share * 255 - last) <= kTolerance && (share > 0 || last == 0);
    if (!near) last = std::clamp(std::round(truth - told), 0.0, 255.0);
    told += last;
    bytes += static_cast<char>(static_cast<std::uint8_t>(last));
  }
  return bytes;
}

std::string JsonText(std::string_view text) {
  std::string escaped;
  for (const char letter : CleanUtf8(text)) {
    if (letter == '<')
      escaped += "\\u003c";
    else if (letter == '"' || letter == '\\')
      escaped.append({'\\', letter});
    else
      escaped += letter;
  }
  return escaped;
}

std::string PageData(const ReportInput& input, const ViewInput& views, std::size_t budget) {
  if (!HasRows(views.timeline) || !(input.timeline.end_s > input.timeline.begin_s)) return "{}";
  const RowGrid grid = MainGrid(views);
  const TimeAxis axis = MainAxis(views);
  const Timeline& timeline = input.timeline;
  std::string names;
  for (const TimelineRow& row : timeline.rows)
    names += (names.empty() ? "\"" : ",\"") + JsonText(row.name) + '"';
  std::string data = fmt::format(
      R"({{"begin":{},"end":{},"left":{},"right":{},"noun":"{}","culprit":{},"names":[{}],"row":{},)",
      timeline.begin_s, timeline.end_s, axis.left, axis.right, NounFor(timeline),
      input.finding.culprit, names, RowOfRank(timeline, grid));
  data += MarksText(timeline) + "," + MessagesText(input.message_series, timeline) + "," +
          WaitsText(input.wait_series) + ",";
  const std::size_t rest = budget > data.size() ? budget - data.size() : 0;
  return data + States(timeline, grid, std::min(kMostStateBytes, rest)) + "}";
}

}  // namespace stipple
