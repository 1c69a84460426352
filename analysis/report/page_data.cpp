// SPDX-License-Identifier: MIT
#include "analysis/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/report/page_code.h"
#include "analysis/report/page_series.h"
#include "analysis/views/layout.h"
#include "analysis/views/state_runs.h"
#include "analysis/views/text.h"

namespace stipple {
namespace {

constexpr std::size_t kMostStateBytes = 350'000;
constexpr std::size_t kLeastBins = 32;
constexpr std::size_t kMostMarks = 300;

/// The three states but idle of the ranks of one drawn row.
std::string StatesText(std::span<const TimelineRow> ranks, std::size_t bins) {
  const std::vector<StateShares> columns = AverageColumns(ranks, bins);
  std::string text = "[";
  for (std::size_t s = 0; s < 3; ++s) {
    std::vector<double> shares;
    for (const StateShares& column : columns) shares.push_back(static_cast<double>(column[s]));
    text += (s == 0 ? "" : ",") + SharesText(shares);
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
    std::vector<std::uint64_t> numbers;
    std::uint64_t last = 0;
    for (const MessageSeries::Dot& dot : messages.all) {
      const double place = (dot.time_s - timeline.begin_s) / (timeline.end_s - timeline.begin_s);
      const auto step = static_cast<std::uint64_t>(std::clamp(place, 0.0, 1.0) * kSteps);
      numbers.insert(numbers.end(), {step - std::min(last, step), std::uint64_t{dot.sender_row},
                                     std::uint64_t{dot.receiver_row}, dot.bytes});
      last = std::max(last, step);
    }
    text += R"(,"all":)" + NumbersText(numbers);
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
  std::size_t rest = budget > data.size() ? budget - data.size() : 0;
  data += SeriesData(input, rest - std::min(rest, kMostStateBytes / 2));
  rest = budget > data.size() ? budget - data.size() : 0;
  return data + States(timeline, grid, std::min(kMostStateBytes, rest)) + "}";
}

}  // namespace stipple
