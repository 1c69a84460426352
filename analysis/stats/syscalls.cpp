// SPDX-License-Identifier: MIT
#include "analysis/stats/syscalls.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/stats/number.h"
#include "analysis/trace/call_stack.h"
#include "analysis/trace/kernel.h"

namespace stipple {
namespace {

struct CallTotals {
  std::uint64_t count = 0;
  std::uint64_t errors = 0;
  std::uint64_t in_mpi = 0;
  std::uint64_t bytes = 0;
  std::int64_t ns = 0;
  std::int64_t longest_ns = 0;
  bool moves_bytes = false;

  void Add(const CallTotals& o) {
    count += o.count;
    errors += o.errors;
    in_mpi += o.in_mpi;
    bytes += o.bytes;
    ns += o.ns;
    longest_ns = std::max(longest_ns, o.longest_ns);
    moves_bytes = moves_bytes || o.moves_bytes;
  }
};

/// Kernel's number and the process's name for it.
using CallKey = std::pair<std::uint32_t, std::uint32_t>;

/// Sees the events of one location.
class CallVisitor {
 public:
  CallVisitor(const Trace& trace, const Location& location, const Selection& selection)
      : trace_(trace), location_(location), selection_(selection) {
    for (const std::uint32_t region : trace.ProcessOf(location).regions)
      is_mpi_.push_back(trace.regions()[region].kind == RegionKind::kMpi);
  }

  void Function(std::uint32_t region, bool leave, std::uint64_t) {
    if (selection_.regions) stack_.Function(region, leave);
    if (!is_mpi_[region]) return;
    if (!leave)
      ++depth_;
    else if (depth_ > 0)
      --depth_;
  }
  void Record(const EventWord* word, std::uint64_t ticks) {
    if (selection_.regions) Follow(word);
    if (KindOf(*word) != RecordKind::kSystemCall || !IsInRegion()) return;
    const auto r = RecordAt<SystemCall>(word);
    const std::uint64_t enter = std::max(r.enter_ticks, location_.first_ticks);
    const std::int64_t enter_ns = trace_.TimeNs(location_, std::min(enter, ticks));
    if (!selection_.HasTime(enter_ns)) return;
    const std::int64_t ns = trace_.TimeNs(location_, ticks) - enter_ns;
    CallTotals& t = totals_[{r.number, r.name}];
    ++t.count;
    t.errors += r.result < 0 ? 1 : 0;
    t.in_mpi += depth_ > 0 ? 1 : 0;
    t.moves_bytes = MovesBytes(r.number);
    if (t.moves_bytes && r.result > 0) t.bytes += static_cast<std::uint64_t>(r.result);
    t.ns += ns;
    t.longest_ns = std::max(t.longest_ns, ns);
  }
  const std::map<CallKey, CallTotals>& totals() const { return totals_; }

 private:
  void Follow(const EventWord* word) {
    if (KindOf(*word) == RecordKind::kOpenFrames)
      stack_.Begin(word, OpenRegions(word, trace_.ProcessOf(location_).RegionCount()));
    else
      stack_.Record(word);
  }
  /// Whether one of the selected regions is open.
  bool IsInRegion() const {
    const Process& process = trace_.ProcessOf(location_);
    return !selection_.regions || std::ranges::any_of(stack_.frames(), [&](std::uint32_t region) {
      return selection_.HasRegion(process.regions[region]);
    });
  }

  const Trace& trace_;
  const Location& location_;
  const Selection& selection_;
  std::vector<bool> is_mpi_;
  CallStack stack_;  // if only some regions are selected
  std::uint64_t depth_ = 0;
  std::map<CallKey, CallTotals> totals_;
};

/// By rank (0: all of them) and name.
using NamedTotals = std::map<std::pair<int, std::string>, CallTotals>;
using NamedCall = std::pair<std::pair<int, std::string>, CallTotals>;

NamedTotals TotalsOf(const Trace& trace, const Selection& selection, bool per_rank) {
  std::vector<const Location*> some;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) some.push_back(&l);
  std::vector<std::map<CallKey, CallTotals>> found(trace.locations().size());
  trace.ForEachOf(some, "system calls", [&](const Location& l) {
    CallVisitor visitor(trace, l, selection);
    trace.Scan(l, visitor);
    found[l.index] = visitor.totals();
  });
  NamedTotals named;
  for (const Location* l : some) {
    for (const auto& [key, totals] : found[l->index]) {
      SystemCall call{};
      call.number = key.first;
      call.name = key.second;
      named[{per_rank ? l->rank : 0, NameOf(trace, trace.ProcessOf(*l), call)}].Add(totals);
    }
  }
  return named;
}

std::string Headline(const Trace& trace, const std::vector<NamedCall>& rows) {
  if (rows.empty()) {
    const bool recorded = std::ranges::any_of(trace.locations(), [&trace](const Location& l) {
      return HasRecorded(trace, l, "system calls");
    });
    return recorded ? "There were no system calls."
                    : "System calls were not recorded (stipple run --syscalls io).";
  }
  std::uint64_t count = 0;
  std::int64_t ns = 0;
  std::map<std::string, std::int64_t> by_name;
  for (const NamedCall& row : rows) {
    count += row.second.count;
    ns += row.second.ns;
    by_name[row.first.second] += row.second.ns;
  }
  const auto most =
      std::ranges::max_element(by_name, {}, [](const auto& entry) { return entry.second; });
  const auto seconds = [](std::int64_t n) { return FormatSeconds(static_cast<double>(n) * 1e-9); };
  return fmt::format("{} took {}, {} of it in {}.", FormatCount(count, "system call"), seconds(ns),
                     seconds(most->second), most->first);
}

}  // namespace

Table SystemCallsTable(const Trace& trace, const Selection& selection, bool per_rank,
                       std::string& headline) {
  Table table{"syscalls", TableShape::kRows, {}, {}};
  if (per_rank) table.columns.push_back({"rank"});
  for (const char* name : {"call", "count", "seconds", "bytes", "errors", "in_mpi", "longest_s"})
    table.columns.push_back({name});
  const NamedTotals named = TotalsOf(trace, selection, per_rank);
  std::vector<NamedCall> rows(named.begin(), named.end());
  std::ranges::stable_sort(rows, [](const NamedCall& a, const NamedCall& b) {
    return std::tuple(a.first.first, -a.second.ns) < std::tuple(b.first.first, -b.second.ns);
  });
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  for (const auto& [key, t] : rows) {
    std::vector<Cell> row;
    if (per_rank) row.emplace_back(std::int64_t{key.first});
    row.emplace_back(key.second);
    row.emplace_back(count(t.count));
    row.emplace_back(static_cast<double>(t.ns) * 1e-9);
    row.push_back(t.moves_bytes ? Cell(count(t.bytes)) : Cell());
    row.emplace_back(count(t.errors));
    row.emplace_back(count(t.in_mpi));
    row.emplace_back(static_cast<double>(t.longest_ns) * 1e-9);
    table.rows.push_back(std::move(row));
  }
  headline = Headline(trace, rows);
  return table;
}

TableAnswer SystemCallsAnswer(const Analysis& analysis, const Selection& selection,
                              const TableOptions& options) {
  TableAnswer answer;
  answer.table = SystemCallsTable(analysis.trace, selection, options.per_rank, answer.headline);
  return answer;
}

}  // namespace stipple
