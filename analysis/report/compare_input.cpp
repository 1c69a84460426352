// SPDX-License-Identifier: MIT
#include "analysis/report/compare_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>
#include <utility>

#include "analysis/report/text.h"
#include "analysis/stats/blame.h"
#include "analysis/stats/message_matrix.h"
#include "analysis/stats/number.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/trace/trace.h"

namespace stipple {
namespace {

constexpr double kSame = 0.01;         // ratios nearer to 1 are no change
constexpr double kNotable = 0.02;      // of the longer run: smaller terms are not named
constexpr std::size_t kMostTerms = 3;  // in the headline

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string NameOfRank(const Trace& trace, int rank) {
  if (trace.IsHost(rank)) return "the host";
  return fmt::format("{} {}", trace.HasHost() ? "node" : "rank", rank);
}

double SpanOf(const Trace& trace, const Selection& selection) {
  const std::int64_t end = std::min(selection.end_ns, trace.SpanNs());
  return std::max(0.0, Seconds(end - std::max<std::int64_t>(0, selection.begin_ns)));
}

/// Means over the ranks; hosts wait by profession and are left out where others are.
void AddStates(const Analysis& analysis, const Selection& selection, ComparedRun& run) {
  const std::vector<RankStates> states = StatesOf(analysis, selection);
  const auto counts = [&](const RankStates& s) {
    return states.size() == 1 || !analysis.trace.IsHost(s.rank);
  };
  const auto ranks =
      static_cast<double>(std::max<std::ptrdiff_t>(1, std::ranges::count_if(states, counts)));
  for (const RankStates& s : states) {
    if (!counts(s)) continue;
    run.has_system = run.has_system || s.system_ns.has_value();
    const std::int64_t ns[] = {s.user_ns, s.system_ns.value_or(0), s.message_ns, s.idle_ns};
    for (std::size_t k = 0; k < kStateCount; ++k) run.state_s[k] += Seconds(ns[k]) / ranks;
  }
  const auto blames = BlameOf(analysis, selection);
  for (const Blame& b : blames)
    if (states.size() == 1 || !analysis.trace.IsHost(b.waiter))
      run.waited_s[NameOfRank(analysis.trace, b.culprit)] += b.seconds / ranks;
}

/// One thing that became more or less.
struct Term {
  std::string what;
  double change_s = 0;
};

std::vector<Term> TermsOf(const ComparedRun& a, const ComparedRun& b) {
  const auto waited = [](const ComparedRun& run, const std::string& who) {
    const auto found = run.waited_s.find(who);
    return found == run.waited_s.end() ? 0.0 : found->second;
  };
  std::vector<Term> terms = {
      {"computation", b.state_s[0] - a.state_s[0]},
      {"system time", a.has_system && b.has_system ? b.state_s[1] - a.state_s[1] : 0.0},
      {"messages", b.state_s[2] - a.state_s[2]}};
  double idle = b.state_s[3] - a.state_s[3];
  std::map<std::string, double> names = a.waited_s;
  names.insert(b.waited_s.begin(), b.waited_s.end());
  for (const auto& [who, seconds] : names) {
    terms.push_back({"waiting for " + who, waited(b, who) - waited(a, who)});
    idle -= terms.back().change_s;
  }
  terms.push_back({"waiting", idle});
  std::ranges::stable_sort(terms, std::greater<>(),
                           [](const Term& term) { return std::abs(term.change_s); });
  return terms;
}

/// Sums by name of what one table says of a run.
struct FunctionSums {
  double seconds[2] = {0, 0};
  std::int64_t calls[2] = {0, 0};
};

void AddFunctions(const Analysis& analysis, const Selection& selection, std::size_t side,
                  std::map<std::string, FunctionSums>& sums) {
  const Table profile = ProfileTable(analysis, selection, false);
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(profile.columns, name, &Column::name) -
                                    profile.columns.begin());
  };
  const std::size_t region = column("region"), calls = column("calls"),
                    exclusive = column("exclusive_s");
  for (const auto& row : profile.rows) {
    const auto* name = std::get_if<std::string>(&row[region]);
    if (name == nullptr) continue;
    FunctionSums& sum = sums[*name];
    if (const auto* seconds = std::get_if<double>(&row[exclusive])) sum.seconds[side] += *seconds;
    if (const auto* count = std::get_if<std::int64_t>(&row[calls])) sum.calls[side] += *count;
  }
}

Table FunctionsTable(const Analysis& a, const Analysis& b, const Selection& of_a,
                     const Selection& of_b) {
  std::map<std::string, FunctionSums> sums;
  AddFunctions(a, of_a, 0, sums);
  AddFunctions(b, of_b, 1, sums);
  std::vector<std::pair<std::string, FunctionSums>> sorted(sums.begin(), sums.end());
  std::ranges::stable_sort(sorted, std::greater<>(), [](const auto& one) {
    return std::abs(one.second.seconds[1] - one.second.seconds[0]);
  });
  Table table{"functions",
              TableShape::kRows,
              {{"region"}, {"a_s"}, {"b_s"}, {"change_s"}, {"a_calls"}, {"b_calls"}},
              {}};
  for (const auto& [name, sum] : sorted)
    table.rows.push_back(stipple::RowOf(name, sum.seconds[0], sum.seconds[1],
                                        sum.seconds[1] - sum.seconds[0], sum.calls[0],
                                        sum.calls[1]));
  return table;
}

/// Messages and bytes of both runs from one rank to another.
struct PairSums {
  std::int64_t messages[2] = {0, 0};
  std::int64_t bytes[2] = {0, 0};
};

void AddPairs(const Analysis& analysis, const Selection& selection, std::size_t side,
              std::map<std::pair<std::string, std::string>, PairSums>& sums) {
  for (const SendEvent& s : analysis.mpi.sends) {
    if (!selection.HasTime(s.enter_ns) || s.enter_ns < 0) continue;
    if (!selection.HasRank(s.channel.sender) || !selection.HasRank(s.channel.receiver)) continue;
    PairSums& sum = sums[{analysis.trace.RankName(s.channel.sender),
                          analysis.trace.RankName(s.channel.receiver)}];
    ++sum.messages[side];
    sum.bytes[side] += static_cast<std::int64_t>(s.bytes);
  }
}

Table PairsTable(const Analysis& a, const Analysis& b, const Selection& of_a,
                 const Selection& of_b) {
  std::map<std::pair<std::string, std::string>, PairSums> sums;
  AddPairs(a, of_a, 0, sums);
  AddPairs(b, of_b, 1, sums);
  std::vector<std::pair<std::pair<std::string, std::string>, PairSums>> sorted;
  for (const auto& one : sums)
    if (one.second.messages[0] != one.second.messages[1] ||
        one.second.bytes[0] != one.second.bytes[1])
      sorted.push_back(one);
  std::ranges::stable_sort(sorted, std::greater<>(), [](const auto& one) {
    return std::pair(std::abs(one.second.bytes[1] - one.second.bytes[0]),
                     std::abs(one.second.messages[1] - one.second.messages[0]));
  });
  Table table{"pairs",
              TableShape::kRows,
              {{"sender"}, {"receiver"}, {"a_messages"}, {"b_messages"}, {"a_bytes"}, {"b_bytes"}},
              {}};
  for (const auto& [pair, sum] : sorted)
    table.rows.push_back(stipple::RowOf(pair.first, pair.second, sum.messages[0], sum.messages[1],
                                        sum.bytes[0], sum.bytes[1]));
  return table;
}

/// "a" and "b", or with their folders where the names are the same.
std::pair<std::string, std::string> NamesOf(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  const auto plain = [](const std::string& path) {
    return fs::path(path).lexically_normal().stem().string();
  };
  if (plain(a) != plain(b)) return {plain(a), plain(b)};
  return {"the first", "the second"};
}

void AddNotes(const Analysis& a, const Analysis& b, CompareInput& input) {
  if (input.a.program != input.b.program)
    input.notes.push_back(
        fmt::format("Different programs: {} and {}.", input.a.program, input.b.program));
  if (a.trace.RankCount() != b.trace.RankCount())
    input.notes.push_back(
        fmt::format("{} against {}: times by state are means over the ranks; functions and "
                    "messages are sums.",
                    FormatCount(static_cast<std::uint64_t>(a.trace.RankCount()), "rank"),
                    FormatCount(static_cast<std::uint64_t>(b.trace.RankCount()), "rank")));
  if (input.a.has_system != input.b.has_system)
    input.notes.push_back(
        fmt::format("System time was recorded in {} only; elsewhere it counts as computation.",
                    input.a.has_system ? input.a.name : input.b.name));
}

}  // namespace

ComparedRun RunOf(const Analysis& analysis, const Selection& selection, std::string name) {
  ComparedRun run;
  run.name = std::move(name);
  run.program = analysis.trace.Program();
  run.span_s = SpanOf(analysis.trace, selection);
  run.messages = MessagesTable(analysis, selection);
  run.volume = VolumeTable(analysis, selection);
  AddStates(analysis, selection, run);
  run.facts = {run.program,
               FormatCount(static_cast<std::uint64_t>(analysis.trace.RankCount()), "rank"),
               FormatSeconds(run.span_s), FormatCount(analysis.trace.EventCount(), "event"),
               LossText(analysis.health)};
  for (const Problem& p : analysis.health.problems())
    if (p.defect != Defect::kStillRunning) run.health.push_back(TextOf(p));
  return run;
}

std::string CompareHeadline(const ComparedRun& a, const ComparedRun& b) {
  if (!(a.span_s > 0) || !(b.span_s > 0))
    return fmt::format("{} holds no time to compare", a.span_s > 0 ? b.name : a.name);
  const double ratio = a.span_s / b.span_s;
  std::string text =
      std::abs(ratio - 1) < kSame ? fmt::format("{} takes as long as {}", b.name, a.name)
      : ratio > 1 ? fmt::format("{} is {:.2f} times as fast as {}", b.name, ratio, a.name)
                  : fmt::format("{} takes {:.2f} times as long as {}", b.name, 1 / ratio, a.name);
  std::size_t named = 0;
  for (const Term& term : TermsOf(a, b)) {
    if (named == kMostTerms || std::abs(term.change_s) < kNotable * std::max(a.span_s, b.span_s))
      break;
    text +=
        fmt::format("{}{} {} {}", named == 0 ? ": " : ", ", FormatSeconds(std::abs(term.change_s)),
                    term.change_s < 0 ? "less" : "more", term.what);
    ++named;
  }
  return text;
}

CompareInput CompareInputOf(const Analysis& a, const Analysis& b, const Selection& selection_a,
                            const Selection& selection_b, std::size_t columns) {
  const auto [name_a, name_b] = NamesOf(a.trace.path(), b.trace.path());
  CompareInput input;
  input.a = RunOf(a, selection_a, name_a);
  input.b = RunOf(b, selection_b, name_b);
  input.headline = CompareHeadline(input.a, input.b);
  AddNotes(a, b, input);
  const double longest = std::max(input.a.span_s, input.b.span_s);
  const auto timeline = [&](const Analysis& of, const Selection& selection) {
    const double begin = Seconds(std::max<std::int64_t>(0, selection.begin_ns));
    return TimelineOf(of, begin, begin + longest, columns);
  };
  input.a.timeline = timeline(a, selection_a);
  input.b.timeline = timeline(b, selection_b);
  input.functions = FunctionsTable(a, b, selection_a, selection_b);
  input.pairs = PairsTable(a, b, selection_a, selection_b);
  return input;
}

}  // namespace stipple
