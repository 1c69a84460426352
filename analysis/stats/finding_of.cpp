// SPDX-License-Identifier: MIT
#include "analysis/stats/finding_of.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>

#include "analysis/stats/finding_words.h"
#include "analysis/stats/message_cost.h"
#include "analysis/stats/number.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

// Waiting for somebody, or by a mechanism that can be named, counts from a twentieth of the nodes'
// time: two runs of one program differ by that much.
constexpr double kNotableShare = 0.05;
// Waiting for nobody in particular counts from a tenth: equal ranks wait a few percent for each
// other because of what else their machine does. So do messages: some time they always cost.
constexpr double kNobodysShare = 0.1;
// Ranks that are to blame for this share of the waiting are named, if they themselves wait at most
// kOwnShare as long as those that wait for them: who waits as long as others is not what is slow.
constexpr double kBlameShare = 0.4;
constexpr double kOwnShare = 0.5;
// Who computed at least this share of what the culprit did is named with it, ...
constexpr double kAsLongShare = 0.95;
// ... and who lost less than this share of what the one who lost most did is not listed.
constexpr double kVictimShare = 0.1;
// Below this share of the time nobody waits.
constexpr double kNoWaitShare = 0.01;
// A mean message of at most so many bytes is small.
constexpr double kSmallBytes = 4096;

std::string Number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

bool IsOverhead(const Blame& b) { return b.kind == WaitKind::kMessageOverhead; }

/// What the sentence is chosen from. A host is there to wait for requests: nothing is lost by that,
/// so its own waiting is left out.
struct Evidence {
  Evidence(const Analysis& of, const Selection& in, const std::vector<Blame>& all_blames)
      : analysis(of), selection(in), trace(of.trace) {
    run_s = static_cast<double>(selection.Clamp(trace.SpanNs()) - selection.Clamp(0)) * 1e-9;
    for (const Blame& b : all_blames) {
      if (IsOverhead(b)) {
        overhead.push_back(b);
      } else if (!trace.IsHost(b.waiter)) {
        waits.push_back(b);
        waited_s += b.seconds;
      }
    }
    const std::vector<RankStates> all = StatesOf(analysis, selection);
    for (const RankStates& s : all) {
      if (trace.IsHost(s.rank) && all.size() > 1) continue;
      nodes[s.rank] = s;
      span_s += static_cast<double>(s.SpanNs()) * 1e-9;
      user_s += static_cast<double>(s.user_ns) * 1e-9;
      idle_s += static_cast<double>(s.idle_ns) * 1e-9;
    }
  }

  double SpanOf(const std::vector<int>& ranks) const {
    double sum = 0;
    for (const int r : ranks)
      if (const auto node = nodes.find(r); node != nodes.end())
        sum += static_cast<double>(node->second.SpanNs()) * 1e-9;
    return sum;
  }
  /// Seconds that a node waited, for whomever.
  double IdleOf(int rank) const {
    const auto node = nodes.find(rank);
    return node == nodes.end() ? 0 : static_cast<double>(node->second.idle_ns) * 1e-9;
  }

  const Analysis& analysis;
  const Selection& selection;
  const Trace& trace;
  std::map<int, RankStates> nodes;
  std::vector<Blame> waits;
  std::vector<Blame> overhead;
  double run_s = 0;
  double waited_s = 0;
  double span_s = 0;  // of all nodes together
  double user_s = 0;
  double idle_s = 0;
};

double MaxOverMean(const Evidence& e) {
  double most = 0;
  for (const auto& [rank, s] : e.nodes) most = std::max(most, static_cast<double>(s.user_ns));
  return e.user_s > 0 ? most * 1e-9 * static_cast<double>(e.nodes.size()) / e.user_s : 1;
}

std::vector<WaitedFor> WaitedForOf(const Evidence& e) {
  std::map<int, WaitedFor> by_culprit;
  std::map<int, double> longest;
  for (const Blame& b : e.waits) {
    WaitedFor& w = by_culprit[b.culprit];
    w.rank = b.culprit;
    w.name = e.trace.RankName(b.culprit);
    w.seconds += b.seconds;
    if (b.region != 0 && b.seconds > longest[b.culprit]) {
      longest[b.culprit] = b.seconds;
      w.region = ShortName(e.trace.regions()[b.region].name);
    }
  }
  std::vector<WaitedFor> sorted;
  for (auto& [rank, w] : by_culprit) sorted.push_back(std::move(w));
  std::ranges::stable_sort(sorted, std::greater<>(), &WaitedFor::seconds);
  return sorted;
}

/// The kind by which most time was lost, of those blames that `counts`; and how much.
template <class Counts>
std::pair<std::string, double> MostKind(const std::vector<Blame>& blames, Counts counts) {
  std::map<std::string_view, double> seconds;
  for (const Blame& b : blames)
    if (counts(b)) seconds[NameOf(b.kind)] += b.seconds;
  if (seconds.empty()) return {"none", 0};
  const auto most = std::ranges::max_element(
      seconds, {}, &std::map<std::string_view, double>::value_type::second);
  return {std::string(most->first), most->second};
}

/// Some ranks that the others wait for.
struct Suspects {
  std::set<int> culprits;
  std::vector<int> victims;
  double waited_s = 0;  // by the victims for the culprits
  bool guilty = false;  // what is waited for, rather than just one of those that wait
};

/// Those that computed as long as `first`, hardly waited, and met those who waited for it: had it
/// alone been faster, they would have been waited for.
std::set<int> AsLate(const Evidence& e, int first, double victims_idle_s) {
  std::set<int> culprits = {first};
  if (e.trace.IsHost(first) || !e.nodes.contains(first)) return culprits;
  const double user_ns = static_cast<double>(e.nodes.at(first).user_ns);
  const std::string kind =
      MostKind(e.waits, [first](const Blame& b) { return b.culprit == first; }).first;
  for (const Blame& b : e.waits) {
    if (NameOf(b.kind) != kind) continue;
    const int other = b.culprit == first ? b.waiter : b.culprit;
    if (other == first || !e.nodes.contains(other)) continue;
    if (static_cast<double>(e.nodes.at(other).user_ns) >= kAsLongShare * user_ns &&
        e.IdleOf(other) <= kOwnShare * victims_idle_s)
      culprits.insert(other);
  }
  // More than half of all are no culprits: whoever they met, they were not late for it.
  if (2 * culprits.size() > e.nodes.size()) culprits = {first};
  return culprits;
}

Suspects SuspectsOf(const Evidence& e, int first) {
  double lost = 0;
  double lost_idle = 0;
  for (const Blame& b : e.waits) {
    if (b.culprit != first) continue;
    lost += b.seconds;
    lost_idle += b.seconds * e.IdleOf(b.waiter);
  }
  const double victims_idle_s = lost > 0 ? lost_idle / lost : 0;
  Suspects s;
  s.culprits = AsLate(e, first, victims_idle_s);
  double charged = 0;
  std::map<int, double> lost_by;
  for (const Blame& b : e.waits) {
    if (!s.culprits.contains(b.culprit)) continue;
    charged += b.seconds;
    if (!s.culprits.contains(b.waiter)) lost_by[b.waiter] += b.seconds;
  }
  double most = 0;
  for (const auto& [rank, seconds] : lost_by) most = std::max(most, seconds);
  for (const auto& [rank, seconds] : lost_by) {
    if (seconds < kVictimShare * most) continue;
    s.victims.push_back(rank);
    s.waited_s += seconds;
  }
  s.guilty = charged >= kBlameShare * e.waited_s && !s.victims.empty() &&
             (e.trace.IsHost(first) || e.IdleOf(first) <= kOwnShare * victims_idle_s);
  return s;
}

/// "at most 2 s of 18 s (11%) could be gained if ..."
std::string GainText(const Evidence& e, const Finding& f, std::string_view if_mended) {
  return "at most " + FormatSeconds(f.gain_s) + " of " + FormatSeconds(e.run_s) + " (" +
         PercentText(f.gain_s, e.run_s) + ") could be gained" +
         (if_mended.empty() ? "" : " " + std::string(if_mended)) + ".";
}

/// Some ranks hold the others up.
///
/// Gain: the victims wait for w each in the mean, because the culprits are later by w. Spread over
/// all, that excess is w * culprits / (victims + culprits) for each, so the run ends earlier by the
/// rest. A host's work, turns, and an order of receives need not be done by another instead: then
/// it is w.
void BlameSome(const Evidence& e, const Suspects& s, Finding& f) {
  const RankWords words(e.trace);
  const std::vector<int> culprits(s.culprits.begin(), s.culprits.end());
  f.culprit = f.waited_for.front().rank;
  f.cause = MostKind(e.waits, [&s](const Blame& b) {
              return s.culprits.contains(b.culprit) && !s.culprits.contains(b.waiter);
            }).first;
  const CauseWords& cause = WordsOf(f.cause);
  const double victims = static_cast<double>(s.victims.size());
  const bool one = culprits.size() == 1;
  f.gain_s = s.waited_s / (victims + (cause.spread && !e.trace.IsHost(f.culprit)
                                          ? static_cast<double>(culprits.size())
                                          : 0));
  f.sentence = Capitalised(words.Many(s.victims)) +
               (s.victims.size() == 1 ? " spends " : " spend ") +
               PercentText(s.waited_s, e.SpanOf(s.victims)) + " of the run waiting for " +
               words.Many(culprits) + ": " + std::string(one ? cause.of_one : cause.of_many);
  const std::string& region = f.waited_for.front().region;
  f.detail = region.empty() ? ""
                            : words.Many(culprits) + (one ? " was" : " were") + " mostly in " +
                                  region + " meanwhile; ";
  const bool of_host = cause.spread && e.trace.IsHost(f.culprit);
  f.detail =
      Capitalised(f.detail + GainText(e, f, of_host ? "if nobody waited for it" : cause.if_mended));
}

/// The ranks wait, but for none in particular. Gain: if all were always equally late, nobody would
/// wait; work that is only moved from one to the other still has to be done, so it is the mean.
void BlameAll(const Evidence& e, const std::string& cause, Finding& f) {
  const RankWords words(e.trace);
  const WaitedFor& first = f.waited_for.front();
  f.cause = cause;
  f.gain_s = e.waited_s / static_cast<double>(e.nodes.size());
  f.sentence = "The " + words.Noun() + "s spend " + PercentText(e.waited_s, e.span_s) +
               " of the run waiting for each other: " + std::string(WordsOf(cause).of_all);
  f.detail = "Most is waited for " + words.One(first.rank) + ", " +
             PercentText(first.seconds, e.waited_s) + " of the waiting" +
             (first.region.empty() ? "; " : ", while it is mostly in " + first.region + "; ") +
             GainText(e, f, WordsOf(cause).if_mended);
}

/// Messages themselves cost what is lost. Gain: small ones cost the same each, so that of those
/// that packing would save; of large ones at most all.
void BlameMessages(const Evidence& e, const MessageCost& cost, Finding& f) {
  const RankWords words(e.trace);
  f.cause = "message-overhead";
  f.gain_s = cost.seconds / static_cast<double>(e.nodes.size());
  f.sentence = "The " + words.Noun() + "s spend " + PercentText(cost.seconds, e.span_s) +
               " of the run in MPI without waiting, most of it in " + cost.function;
  std::string if_mended = "if less were moved";
  const double bytes = static_cast<double>(cost.bytes);
  const double messages = static_cast<double>(cost.messages);
  if (cost.messages > 0 && bytes <= kSmallBytes * messages) {
    f.sentence += ": they send " + FormatCount(cost.messages, "message") + " of " +
                  FormatBytes(bytes / messages);
    f.gain_s *= 1 - static_cast<double>(std::min(cost.packed, cost.messages)) / messages;
    if_mended = "if small messages were sent together";
  }
  const auto first = std::ranges::max_element(e.overhead, {}, &Blame::seconds);
  if (first != e.overhead.end() && first->region != 0)
    f.detail = ShortName(e.trace.regions()[first->region].name) + " calls it mostly; ";
  f.detail = Capitalised(f.detail + GainText(e, f, if_mended));
}

/// The region in which the ranks compute most, and its share of the computing time.
std::pair<std::string, double> BusiestRegion(const Evidence& e) {
  const std::vector<RegionTime> times = SumOfMains(e.analysis, e.selection);
  std::vector<double> sums(times.size());
  for (std::size_t r = 0; r < times.size(); ++r)
    if (e.trace.regions()[r].kind != RegionKind::kMpi) sums[r] = times[r].exclusive_ns;
  if (sums.empty()) return {};
  const auto most = std::ranges::max_element(sums);
  const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
  if (sum <= 0) return {};
  return {ShortName(e.trace.regions()[static_cast<std::size_t>(most - sums.begin())].name),
          *most / sum};
}

void BlameNobody(const Evidence& e, Finding& f) {
  const auto [region, share] = BusiestRegion(e);
  const std::string noun = RankWords(e.trace).Noun();
  f.sentence = e.idle_s < kNoWaitShare * e.span_s
                   ? "No " + noun + " waits for another: "
                   : "No " + noun + " holds the others up for long: ";
  f.sentence += PercentText(e.user_s, e.span_s) + " of the time is computation";
  f.sentence += region.empty() ? "" : ", most of it in " + region;
  if (e.idle_s >= kNoWaitShare * e.span_s)
    f.sentence += ", " + PercentText(e.idle_s, e.span_s) + " waiting";
  if (!region.empty())
    f.detail = region + " itself takes " + PercentText(share, 1) + " of the computing time.";
}

/// Whatever cost most of what is worth naming.
void Choose(const Evidence& e, Finding& f) {
  const MessageCost cost = CostOfMessages(e.analysis, e.selection);
  const bool dear = cost.seconds >= kNobodysShare * e.span_s;
  if (f.waited_for.empty()) return dear ? BlameMessages(e, cost, f) : BlameNobody(e, f);
  const Suspects suspects = SuspectsOf(e, f.waited_for.front().rank);
  const double waited_s = suspects.guilty ? suspects.waited_s : e.waited_s;
  if (dear && cost.seconds >= waited_s) return BlameMessages(e, cost, f);
  if (suspects.guilty && waited_s >= kNotableShare * e.span_s) return BlameSome(e, suspects, f);
  const auto [kind, seconds] = MostKind(e.waits, [](const Blame&) { return true; });
  const bool mechanism = !WordsOf(kind).of_all.empty() && seconds >= e.waited_s / 2;
  if (!suspects.guilty && waited_s >= (mechanism ? kNotableShare : kNobodysShare) * e.span_s)
    return BlameAll(e, mechanism ? kind : "imbalance", f);
  BlameNobody(e, f);
}

}  // namespace

std::string PercentText(double part, double whole) {
  const double percent = whole > 0 ? 100 * part / whole : 0;
  return Number(percent > 0 && percent < 9.95 ? "%.1f%%" : "%.0f%%", percent);
}

Finding FindingOf(const Analysis& analysis, const Selection& selection,
                  const std::vector<Blame>& blames) {
  const Evidence e(analysis, selection, blames);
  Finding f;
  f.waited_for = WaitedForOf(e);
  f.max_over_mean = MaxOverMean(e);
  f.idle_share = e.span_s > 0 ? e.idle_s / e.span_s : 0;
  if (e.span_s <= 0) {
    f.sentence = "The archive holds no events";
  } else {
    Choose(e, f);
  }
  return f;
}

Finding FindingOf(const Trace& trace) {
  const Analysis analysis(trace);
  return FindingOf(analysis, {}, BlameOf(analysis, {}));
}

}  // namespace stipple
