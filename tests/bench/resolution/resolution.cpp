// SPDX-License-Identifier: MIT
// bench_resolution ARCHIVE FIGURES.csv CHART.svg: what an analysis loses that looks at less than
// all events of an archive. Two ways of looking at less: bins of time, each with the shares of the
// states, from 256 to 2^20 of them; and samples, the state and the function of each rank at moments
// 1/HZ apart, as a sampling profiler would have them. Against each stands the error of
//   states   the shares of the states over the whole run, mean over ranks,
//   windows  the same over windows of a hundredth of the run,
//   profile  the functions' shares of exclusive time,
// each as half the sum of the absolute differences, and whether the rank with the most work, as the
// shares tell it, is the one that the finding from all events names. A window without a sample says
// nothing: its error is 1.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/analysis.h"
#include "analysis/stats/finding_of.h"
#include "analysis/stats/profile.h"
#include "analysis/stats/states.h"
#include "analysis/stats/timeline_of.h"
#include "analysis/trace/call_stack.h"
#include "analysis/views/svg.h"
#include "analysis/views/xy_view.h"

namespace stipple {
namespace {

constexpr std::size_t kWindows = 50;
constexpr double kWindowPart = 0.01;  // of the run
constexpr std::size_t kSampleBytes = 16;
constexpr double kRounding = 1e-6;       // a smaller error is none: shares of bins are floats
constexpr double kMostImbalance = 1.05;  // below, no rank is said to have the most work

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

using Shares = std::vector<double>;

void Normalise(Shares& shares) {
  double sum = 0;
  for (const double s : shares) sum += s;
  for (double& s : shares) s = sum > 0 ? s / sum : 0;
}

bool SaysNothing(const Shares& shares) {
  return std::ranges::all_of(shares, [](double s) { return s <= 0; });
}

/// 0: alike; 1: nothing in common, or `a` says nothing.
double Distance(const Shares& a, const Shares& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return SaysNothing(a) ? 1 : sum / 2;
}

struct Window {
  std::int64_t begin_ns, end_ns;
};

/// What some way of looking says: by rank the shares of the states, in the run and in each window.
struct Account {
  std::vector<Shares> states;
  std::vector<std::vector<Shares>> in_windows;  // window, rank
  Shares profile;                               // by region; empty: says nothing of it
};

/// One point of the chart.
struct Figure {
  std::string method, setting;
  double bytes = 0, cpu_s = 0, states = 0, windows = 0;
  std::optional<double> profile;
  bool is_named = false;
};

class Resolution {
 public:
  explicit Resolution(const Trace& trace)
      : trace_(trace), analysis_(trace), ranks_(trace.RanksInOrder()) {
    const auto span = static_cast<double>(trace.SpanNs());
    for (std::size_t i = 0; i < kWindows; ++i) {
      const double begin = span * (static_cast<double>(i) + 0.37) / (kWindows + 1);
      windows_.push_back(
          {std::llround(begin), std::llround(begin + std::max(1.0, span * kWindowPart))});
    }
    exact_ = Exact();
    culprit_ = FindingOf(analysis_, {}, BlameOf(trace, analysis_.mpi, analysis_.waits, {})).culprit;
  }

  Figure OfEvents() {
    double bytes = 0;
    for (const Location& l : trace_.locations()) bytes += static_cast<double>(l.stream->Bytes());
    const double begin = CpuSeconds();
    const Analysis again(trace_);
    const double cpu_s = CpuSeconds() - begin;
    Figure f = Compare("events", "all", bytes, cpu_s, exact_);
    f.is_named = true;
    return f;
  }

  Figure OfBins(std::size_t bins) {
    const double begin = CpuSeconds();
    const double span_s = static_cast<double>(trace_.SpanNs()) * 1e-9;
    const Timeline timeline = TimelineOf(analysis_, 0, span_s, bins);
    const double cpu_s = CpuSeconds() - begin;
    Account account;
    const auto shares_in = [&](const Window& w, const TimelineRow& row) {
      const double bin_ns = static_cast<double>(trace_.SpanNs()) / static_cast<double>(bins);
      const double from = static_cast<double>(w.begin_ns) / bin_ns;
      const double to = std::min(static_cast<double>(w.end_ns) / bin_ns, static_cast<double>(bins));
      Shares shares(kStateCount);
      for (auto b = static_cast<std::size_t>(from); static_cast<double>(b) < to; ++b) {
        const auto left = static_cast<double>(b);
        const double part = std::min(to, left + 1) - std::max(from, left);
        for (std::size_t s = 0; s < kStateCount; ++s)
          shares[s] += part * static_cast<double>(row.columns[b][s]);
      }
      Normalise(shares);
      return shares;
    };
    for (const TimelineRow& row : timeline.rows)
      account.states.push_back(shares_in({0, trace_.SpanNs()}, row));
    for (const Window& w : windows_) {
      account.in_windows.emplace_back();
      for (const TimelineRow& row : timeline.rows)
        account.in_windows.back().push_back(shares_in(w, row));
    }
    const double bytes = static_cast<double>(bins * ranks_.size() * sizeof(StateShares));
    return Compare("bins", std::to_string(bins), bytes, cpu_s, account);
  }

  Figure OfSamples(double hz) {
    const double begin = CpuSeconds();
    Account account;
    account.profile.resize(trace_.regions().size());
    account.in_windows.assign(kWindows, std::vector<Shares>(ranks_.size(), Shares(kStateCount)));
    std::size_t samples = 0;
    for (std::size_t r = 0; r < ranks_.size(); ++r) {
      const Location& l = *trace_.MainOf(ranks_[r]);
      Shares states(kStateCount);
      Sampler sampler{*this, l, 1e9 / hz, account, states, r};
      sampler.next_ns = 1e9 / hz / 2;
      while (sampler.next_ns < static_cast<double>(l.begin_ns)) sampler.next_ns += 1e9 / hz;
      sampler.FindNext();
      trace_.Scan(l, sampler);
      samples += sampler.samples;
      Normalise(states);
      account.states.push_back(states);
      for (std::vector<Shares>& window : account.in_windows) Normalise(window[r]);
    }
    Normalise(account.profile);
    const double cpu_s = CpuSeconds() - begin;
    return Compare("samples", std::to_string(std::llround(hz)),
                   static_cast<double>(samples * kSampleBytes), cpu_s, account);
  }

 private:
  /// Looks at one rank at moments that are evenly apart.
  struct Sampler {
    const Resolution& of;
    const Location& location;
    double step_ns;
    Account& account;
    Shares& states;
    std::size_t rank;
    double next_ns = 0;
    std::uint64_t next_ticks = 0;
    std::size_t samples = 0;
    std::size_t call = 0;
    CallStack stack{};

    void FindNext() { next_ticks = of.trace_.TicksAt(location, std::llround(next_ns)); }
    void Until(std::uint64_t ticks) {
      for (; next_ticks <= ticks && ticks > location.first_ticks; next_ns += step_ns, FindNext())
        Take(std::llround(next_ns));
    }
    void Take(std::int64_t now_ns) {
      if (now_ns > location.end_ns) return;
      ++samples;
      const auto state = static_cast<std::size_t>(of.StateAt(location, now_ns, call));
      states[state] += 1;
      for (std::size_t w = 0; w < kWindows; ++w)
        if (of.windows_[w].begin_ns <= now_ns && now_ns < of.windows_[w].end_ns)
          account.in_windows[w][rank][state] += 1;
      if (stack.depth() != 0)
        account.profile[of.trace_.ProcessOf(location).regions[stack.top()]] += 1;
    }
    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      Until(ticks);
      stack.Function(region, leave);
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      Until(ticks);
      stack.Record(record);
    }
  };

  /// `call`: where to look for the MPI call, from one moment to a later one.
  State StateAt(const Location& l, std::int64_t now_ns, std::size_t& call) const {
    const std::span<const MpiCall> calls(analysis_.mpi.calls);
    while (call < calls.size() &&
           (calls[call].location < l.index ||
            (calls[call].location == l.index && calls[call].end_ns < now_ns)))
      ++call;
    if (call < calls.size() && calls[call].location == l.index && calls[call].begin_ns <= now_ns)
      return now_ns < calls[call].begin_ns + analysis_.waits[call].idle_ns ? State::kIdle
                                                                           : State::kMessage;
    const std::span<const CallSpan> kernel(analysis_.kernel[l.index]);
    const auto span = std::ranges::upper_bound(kernel, now_ns, {}, &CallSpan::end_ns);
    return span != kernel.end() && span->begin_ns <= now_ns ? State::kSystem : State::kUser;
  }

  std::vector<Shares> ExactStates(const Window& w) const {
    std::vector<Shares> of_ranks;
    Selection selection;
    selection.begin_ns = w.begin_ns;
    selection.end_ns = w.end_ns;
    for (const RankStates& s : StatesOf(analysis_, selection)) {
      of_ranks.push_back({static_cast<double>(s.user_ns),
                          static_cast<double>(s.system_ns.value_or(0)),
                          static_cast<double>(s.message_ns), static_cast<double>(s.idle_ns)});
      Normalise(of_ranks.back());
    }
    return of_ranks;
  }

  Account Exact() const {
    Account account;
    account.states = ExactStates({0, trace_.SpanNs()});
    for (const Window& w : windows_) account.in_windows.push_back(ExactStates(w));
    for (const RegionTime& t : SumOfMains(analysis_, {})) account.profile.push_back(t.exclusive_ns);
    Normalise(account.profile);
    return account;
  }

  /// The rank whose share of computing is above that of all; -1: none.
  int MostWork(const Account& account) const {
    double sum = 0;
    double most = 0;
    std::size_t count = 0;
    int rank = -1;
    for (std::size_t r = 0; r < ranks_.size(); ++r) {
      if (trace_.IsHost(ranks_[r])) continue;
      const double user = account.states[r][static_cast<std::size_t>(State::kUser)];
      sum += user;
      ++count;
      if (user <= most) continue;
      most = user;
      rank = ranks_[r];
    }
    return most * static_cast<double>(count) > kMostImbalance * sum ? rank : -1;
  }

  Figure Compare(const std::string& method, const std::string& setting, double bytes, double cpu_s,
                 const Account& account) const {
    Figure f{method, setting, bytes, cpu_s, 0, 0, {}, false};
    std::size_t windows = 0;  // in which the rank was there
    for (std::size_t r = 0; r < ranks_.size(); ++r) {
      f.states +=
          Distance(account.states[r], exact_.states[r]) / static_cast<double>(ranks_.size());
      for (std::size_t w = 0; w < kWindows; ++w) {
        if (SaysNothing(exact_.in_windows[w][r])) continue;
        ++windows;
        f.windows += Distance(account.in_windows[w][r], exact_.in_windows[w][r]);
      }
    }
    f.windows /= static_cast<double>(std::max<std::size_t>(windows, 1));
    if (!account.profile.empty()) f.profile = Distance(account.profile, exact_.profile);
    f.is_named = MostWork(account) == culprit_;
    return f;
  }

  const Trace& trace_;
  Analysis analysis_;
  std::vector<int> ranks_;
  std::vector<Window> windows_;
  Account exact_;
  int culprit_ = -1;
};

std::string LabelOf(const Figure& f) {
  const double n = std::stod(f.setting);
  if (f.method == "bins") return n < 1e5 ? f.setting : std::to_string(std::llround(n / 1e3)) + " k";
  if (n >= 1e6) return std::to_string(std::llround(n / 1e6)) + " MHz";
  return n < 1e3 ? f.setting + " Hz" : std::to_string(std::llround(n / 1e3)) + " kHz";
}

void Draw(const std::vector<Figure>& figures, const char* path) {
  XyChart chart{.name = "resolution", .title = "Resolution of an analysis against its error"};
  chart.heading = "What an analysis loses that looks at less than all events";
  chart.series = {{false, {}, "bins: states in windows", true, 0},
                  {false, {}, "samples: states in windows", true, 1},
                  {false, {}, "samples: profile", true, 2},
                  {true, {}}};
  std::vector<double> xs;
  std::vector<double> ys;
  const auto add = [&](std::size_t series, const Figure& f, double error, std::string label) {
    xs.push_back(f.bytes);
    error = error < kRounding ? 0 : error;
    ys.push_back(100 * error);
    chart.series[series].points.push_back(
        {f.bytes, 100 * error, std::move(label), !f.is_named && series != 2});
  };
  for (const Figure& f : figures) {
    if (f.method == "events") add(3, f, 0, "all events");
    if (f.method == "bins") add(0, f, f.windows, LabelOf(f));
    if (f.method != "samples") continue;
    add(1, f, f.windows, LabelOf(f));
    add(2, f, *f.profile, "");
  }
  chart.x = AxisOver("bytes that the answer is made from", xs);
  chart.y = AxisOver("error of shares, % (ring: another rank is named than from all events)", ys);
  std::ofstream(path) << DrawSvg(XyView(chart), {.standalone = true});
}

int Main(const char* archive, const char* csv, const char* svg) {
  const Trace trace = Trace::Open(archive);
  Resolution resolution(trace);
  std::vector<Figure> figures = {resolution.OfEvents()};
  for (std::size_t bins = 256; bins <= std::size_t{1} << 20; bins *= 4)
    figures.push_back(resolution.OfBins(bins));
  for (double hz = 100; hz <= 1e6; hz *= 10) figures.push_back(resolution.OfSamples(hz));
  std::ofstream out(csv);
  out << "method,setting,bytes,cpu_s,states_error,windows_error,profile_error,culprit_named\n";
  for (const Figure& f : figures) {
    char line[256];
    std::snprintf(line, sizeof(line), "%s,%s,%.0f,%.4f,%.6f,%.6f,%s,%s\n", f.method.c_str(),
                  f.setting.c_str(), f.bytes, f.cpu_s, f.states, f.windows,
                  f.profile ? std::to_string(*f.profile).c_str() : "", f.is_named ? "yes" : "no");
    out << line;
    std::fputs(line, stdout);
  }
  Draw(figures, svg);
  return out.good() ? 0 : 1;
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: bench_resolution ARCHIVE FIGURES.csv CHART.svg\n", stderr);
    return 2;
  }
  try {
    return stipple::Main(argv[1], argv[2], argv[3]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
