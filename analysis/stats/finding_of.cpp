// SPDX-License-Identifier: MIT
#include "analysis/stats/finding_of.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <numeric>

#include "analysis/stats/number.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

// Below this share of the ranks' time waiting is not what the run is about.
constexpr double kNotableShare = 0.03;
// A rank that is to blame for this share of the waiting is named.
constexpr double kBlameShare = 0.4;
// Who lost less than this share of what the one who lost most did is not listed.
constexpr double kVictimShare = 0.1;

// Who computed at least this share of what the culprit did is named with it.
constexpr double kAsLongShare = 0.95;
// More ranks or spans of ranks than this are counted, not listed.
constexpr std::size_t kMostListed = 6;

std::string Number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

std::string Capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// Numbers of a run as text.
class Words {
 public:
  explicit Words(const Trace& trace) : trace_(trace), noun_(trace.HasHost() ? "node" : "rank") {}

  /// "rank 0", "the host"
  std::string One(int rank) const {
    return trace_.IsHost(rank) ? "the host" : noun_ + " " + std::to_string(rank);
  }
  std::string Noun() const { return noun_; }
  /// "ranks 1-3, 7 and the host"; "19 ranks" when that would be a long list.
  std::string Many(std::vector<int> ranks) const {
    std::ranges::sort(ranks);
    const std::size_t count = ranks.size();
    const bool host = std::erase_if(ranks, [this](int r) { return trace_.IsHost(r); }) > 0;
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < ranks.size();) {
      std::size_t j = i;
      while (j + 1 < ranks.size() && ranks[j + 1] == ranks[j] + 1) ++j;
      if (j == i + 1) j = i;  // two are two, not a span
      parts.push_back(std::to_string(ranks[i]));
      if (j > i) parts.back() += "-" + std::to_string(ranks[j]);
      i = j + 1;
    }
    if (parts.empty()) return "the host";
    if (host) parts.emplace_back("the host");
    if (parts.size() > kMostListed) return std::to_string(count) + " " + noun_ + "s";
    std::string list = parts.front();
    for (std::size_t i = 1; i < parts.size(); ++i)
      list += (i + 1 == parts.size() ? " and " : ", ") + parts[i];
    return noun_ + (ranks.size() > 1 ? "s " : " ") + list;
  }

 private:
  const Trace& trace_;
  std::string noun_;
};

struct Totals {
  double span = 0;
  double user = 0;
  double idle = 0;
};

Totals Sum(const Trace& trace, const std::vector<RankStates>& states) {
  Totals t;
  for (const RankStates& s : states) {
    if (trace.IsHost(s.rank) && states.size() > 1) continue;
    t.span += static_cast<double>(s.SpanNs()) * 1e-9;
    t.user += static_cast<double>(s.user_ns) * 1e-9;
    t.idle += static_cast<double>(s.idle_ns) * 1e-9;
  }
  return t;
}

double MaxOverMean(const Trace& trace, const std::vector<RankStates>& states) {
  double sum = 0;
  double most = 0;
  double count = 0;
  for (const RankStates& s : states) {
    if (trace.IsHost(s.rank) && states.size() > 1) continue;
    sum += static_cast<double>(s.user_ns);
    most = std::max(most, static_cast<double>(s.user_ns));
    ++count;
  }
  return sum > 0 ? most / (sum / count) : 1;
}

std::vector<WaitedFor> WaitedForOf(const Trace& trace, const std::vector<Blame>& blames) {
  std::map<int, WaitedFor> by_culprit;
  std::map<int, double> longest;
  for (const Blame& b : blames) {
    WaitedFor& w = by_culprit[b.culprit];
    w.rank = b.culprit;
    w.name = trace.RankName(b.culprit);
    w.seconds += b.seconds;
    if (b.region != 0 && b.seconds > longest[b.culprit]) {
      longest[b.culprit] = b.seconds;
      w.region = ShortName(trace.regions()[b.region].name);
    }
  }
  std::vector<WaitedFor> sorted;
  for (auto& [rank, w] : by_culprit) sorted.push_back(std::move(w));
  std::ranges::stable_sort(sorted, std::greater<>(), &WaitedFor::seconds);
  return sorted;
}

/// The culprit, and those that computed as long as it did: had it alone been faster, they would
/// have been waited for.
std::vector<int> CulpritsOf(const Trace& trace, const std::vector<RankStates>& states, int culprit,
                            const std::vector<int>& victims) {
  std::int64_t user_ns = 0;
  for (const RankStates& s : states)
    if (s.rank == culprit) user_ns = s.user_ns;
  std::vector<int> culprits = {culprit};
  if (trace.IsHost(culprit)) return culprits;
  for (const RankStates& s : states)
    if (s.rank != culprit && !trace.IsHost(s.rank) &&
        std::ranges::find(victims, s.rank) == victims.end() &&
        static_cast<double>(s.user_ns) >= kAsLongShare * static_cast<double>(user_ns))
      culprits.push_back(s.rank);
  return culprits;
}

/// The kind of wait by which most time was lost to `culprit`.
std::string CauseOf(const std::vector<Blame>& blames, int culprit) {
  std::map<WaitKind, double> seconds;
  for (const Blame& b : blames)
    if (b.culprit == culprit) seconds[b.kind] += b.seconds;
  const auto most =
      std::ranges::max_element(seconds, {}, &std::map<WaitKind, double>::value_type::second);
  return std::string(NameOf(most->first));
}

/// One rank holds the others up.
void BlameOne(const Trace& trace, const std::vector<RankStates>& states,
              const std::vector<Blame>& blames, Finding& f) {
  const Words words(trace);
  const WaitedFor& first = f.waited_for.front();
  std::map<int, double> lost;
  for (const Blame& b : blames)
    if (b.culprit == first.rank) lost[b.waiter] += b.seconds;
  double most = 0;
  for (const auto& [rank, seconds] : lost) most = std::max(most, seconds);
  std::vector<int> victims;
  double waited = 0;
  for (const auto& [rank, seconds] : lost) {
    if (seconds < kVictimShare * most) continue;
    victims.push_back(rank);
    waited += seconds;
  }
  double span = 0;
  for (const RankStates& s : states)
    if (std::ranges::find(victims, s.rank) != victims.end())
      span += static_cast<double>(s.SpanNs()) * 1e-9;
  const std::vector<int> culprits = CulpritsOf(trace, states, first.rank, victims);
  f.culprit = first.rank;
  f.cause = CauseOf(blames, first.rank);
  f.sentence = Capitalised(words.Many(victims)) + (victims.size() == 1 ? " spends " : " spend ") +
               PercentText(waited, span) + " of the run waiting for " + words.Many(culprits);
  if (!first.region.empty())
    f.detail = words.Many(culprits) + (culprits.size() == 1 ? " was" : " were") + " mostly in " +
               first.region + " meanwhile; ";
  const double mean = waited / static_cast<double>(victims.size());
  f.detail =
      Capitalised(f.detail + "at most " + FormatSeconds(mean) + " of " +
                  FormatSeconds(static_cast<double>(trace.SpanNs()) * 1e-9) + " could be gained.");
}

/// The region in which the ranks compute most, and its share of the computing time.
std::pair<std::string, double> BusiestRegion(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  const std::vector<RegionTime> times = SumOfMains(analysis, selection);
  std::vector<double> sums(times.size());
  for (std::size_t r = 0; r < times.size(); ++r)
    if (trace.regions()[r].kind != RegionKind::kMpi) sums[r] = times[r].exclusive_ns;
  if (sums.empty()) return {};
  const auto most = std::ranges::max_element(sums);
  const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
  if (sum <= 0) return {};
  return {ShortName(trace.regions()[static_cast<std::size_t>(most - sums.begin())].name),
          *most / sum};
}

void BlameNobody(const Analysis& analysis, const Selection& selection, const Totals& totals,
                 Finding& f) {
  const auto [region, share] = BusiestRegion(analysis, selection);
  const Words words(analysis.trace);
  f.sentence = "No " + words.Noun() +
               " waits for another: " + PercentText(totals.user, totals.span) +
               " of the time is computation";
  f.sentence += region.empty() ? "" : ", most of it in " + region;
  if (!region.empty())
    f.detail = region + " itself takes " + PercentText(share, 1) + " of the computing time.";
}

void BlameImbalance(const Trace& trace, const Totals& totals, Finding& f) {
  const Words words(trace);
  const WaitedFor& first = f.waited_for.front();
  f.cause = "imbalance";
  f.sentence = "The " + words.Noun() + "s wait for each other " +
               PercentText(totals.idle, totals.span) + " of the run; the busiest computes " +
               Number("%.2f", f.max_over_mean) + " times the mean";
  double blamed = 0;
  for (const WaitedFor& w : f.waited_for) blamed += w.seconds;
  f.detail = "Most is waited for " + words.One(first.rank) + ": " +
             PercentText(first.seconds, blamed) + " of the waiting" +
             (first.region.empty() ? "." : ", while it was mostly in " + first.region + ".");
}

}  // namespace

std::string PercentText(double part, double whole) {
  const double percent = whole > 0 ? 100 * part / whole : 0;
  return Number(percent > 0 && percent < 9.95 ? "%.1f%%" : "%.0f%%", percent);
}

Finding FindingOf(const Analysis& analysis, const Selection& selection,
                  const std::vector<Blame>& all_blames) {
  const Trace& trace = analysis.trace;
  // A host is there to wait for requests: nothing is lost by that.
  std::vector<Blame> blames = all_blames;
  std::erase_if(blames, [&trace](const Blame& b) { return trace.IsHost(b.waiter); });
  const std::vector<RankStates> states = StatesOf(analysis, selection);
  const Totals totals = Sum(trace, states);
  Finding f;
  f.waited_for = WaitedForOf(trace, blames);
  f.max_over_mean = MaxOverMean(trace, states);
  f.idle_share = totals.span > 0 ? totals.idle / totals.span : 0;
  double blamed = 0;
  for (const WaitedFor& w : f.waited_for) blamed += w.seconds;
  if (totals.span <= 0) {
    f.sentence = "The archive holds no events";
  } else if (f.waited_for.empty() || totals.idle < kNotableShare * totals.span) {
    BlameNobody(analysis, selection, totals, f);
  } else if (f.waited_for.front().seconds >= kBlameShare * blamed) {
    BlameOne(trace, states, blames, f);
  } else {
    BlameImbalance(trace, totals, f);
  }
  return f;
}

Finding FindingOf(const Trace& trace) {
  const Analysis analysis(trace);
  return FindingOf(analysis, {}, BlameOf(analysis, {}));
}

}  // namespace stipple
