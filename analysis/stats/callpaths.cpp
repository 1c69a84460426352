// SPDX-License-Identifier: MIT
// The trees of locations (path_scan.h) are joined by name, one after the other, so that the result
// does not depend on the machine.
#include "analysis/stats/callpaths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/number.h"
#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

void JoinEvents(const Trace& trace, const Process& process, const std::vector<PathNode>& from,
                PathTree& to) {
  std::vector<std::size_t> place(from.size(), to.Root());
  for (std::size_t i = 1; i < place.size(); ++i) {
    const PathNode& node = from[i];
    const std::uint32_t region = process.regions[node.number];
    place[i] = to.Child(place[node.parent], trace.regions()[region].name);
    to.Own(place[i]) += node.own;
  }
}

/// What is below a program's first function, or a thread's: the C library's, and the runtime's.
bool StartsThreads(const FrameName& frame) {
  return frame.name == "_start" || frame.module == "libc.so.6" || frame.module == "libstipple.so" ||
         frame.module == "libpthread.so.0";
}

void JoinSamples(const Trace& trace, const Process& process, const std::vector<PathNode>& from,
                 PathTree& to) {
  std::vector<std::size_t> place(from.size(), to.Root());
  std::vector<bool> has_children(place.size());
  for (const PathNode& node : from) has_children[node.parent] = true;
  for (std::size_t i = 1; i < place.size(); ++i) {
    const PathNode& node = from[i];
    std::size_t& at = place[i] = place[node.parent];
    if (node.number == kCutFrame) {
      at = to.Child(at, "...");
    } else {
      const auto& names = trace.FrameNamesOf(process, node.number, false);
      const bool starts = at == to.Root() && StartsThreads(names.back());
      if (!starts || !has_children[i])
        for (auto n = names.rbegin(); n != names.rend(); ++n) at = to.Child(at, n->name);
    }
    to.Own(at) += node.own;
  }
}

/// The paths that pass a selected region, with those that lead there; of these only what passes
/// counts.
PathTree Through(const PathTree& all, const Selection& selection) {
  PathTree some;
  std::vector<bool> passes(all.nodes().size());
  std::vector<bool> leads(all.nodes().size());
  for (std::size_t i = 1; i < passes.size(); ++i) {  // a parent stands before its children
    const PathTree::Node& node = all.nodes()[i];
    passes[i] = passes[node.parent] || selection.HasRegion(node.name);
  }
  for (std::size_t i = passes.size(); i-- > 1;)
    if (passes[i] || leads[i]) leads[all.nodes()[i].parent] = true;
  std::vector<std::size_t> place(passes.size(), some.Root());
  for (std::size_t i = 1; i < passes.size(); ++i) {
    const PathTree::Node& node = all.nodes()[i];
    if (!passes[i] && !leads[i]) continue;
    place[i] = some.Child(place[node.parent], node.name);
    if (passes[i]) some.Own(place[i]) += node.own;
  }
  return some;
}

Cell CountCell(std::uint64_t count) { return static_cast<std::int64_t>(count); }

/// Rows of a subtree, in order, with `path` before each name.
void AddRows(const PathTree& tree, bool sampled, std::vector<std::string> path, Table& table) {
  struct Visit {
    std::size_t node;
    std::size_t depth;
  };
  const std::size_t base = path.size();
  std::vector<Visit> open;
  const auto push_children = [&](std::size_t node, std::size_t depth) {
    const auto& children = tree.nodes()[node].children;
    for (auto c = children.rbegin(); c != children.rend(); ++c) open.push_back({*c, depth});
  };
  push_children(tree.Root(), base);
  while (!open.empty()) {
    const auto [at, depth] = open.back();
    open.pop_back();
    const PathTree::Node& node = tree.nodes()[at];
    path.resize(depth);
    path.push_back(node.name);
    const Cell none;
    table.rows.push_back(RowOf(path, sampled ? none : CountCell(node.own.calls),
                               node.inclusive_ns * 1e-9, node.own.exclusive_ns * 1e-9,
                               sampled ? none : CountCell(node.own.messages),
                               sampled ? none : CountCell(node.own.bytes),
                               sampled ? CountCell(node.samples_below) : none));
    if (table.columns.size() > table.rows.back().size())
      table.rows.back().push_back(sampled ? none : CountCell(node.own.folded));
    push_children(at, depth + 1);
  }
}

}  // namespace

std::size_t PathTree::Child(std::size_t parent, std::string_view name) {
  for (std::size_t n = parent; n != Root(); n = nodes_[n].parent)
    if (nodes_[n].name == name) return n;
  const auto [at, is_new] = child_.try_emplace({parent, std::string(name)}, nodes_.size());
  if (is_new) {
    nodes_.push_back({parent, std::string(name), {}, 0, 0, {}});
    nodes_[parent].children.push_back(at->second);
  }
  return at->second;
}

void PathTree::Finish() {
  for (Node& n : nodes_) {
    n.inclusive_ns = n.own.exclusive_ns;
    n.samples_below = n.own.samples;
  }
  for (std::size_t i = nodes_.size(); i-- > 1;) {  // a parent stands before its children
    nodes_[nodes_[i].parent].inclusive_ns += nodes_[i].inclusive_ns;
    nodes_[nodes_[i].parent].samples_below += nodes_[i].samples_below;
  }
  for (Node& n : nodes_)
    std::ranges::sort(n.children, [this](std::size_t a, std::size_t b) {
      return std::pair(-nodes_[a].inclusive_ns, std::string_view(nodes_[a].name)) <
             std::pair(-nodes_[b].inclusive_ns, std::string_view(nodes_[b].name));
    });
}

namespace {

/// What was found in each location; of the selected ranks and span.
struct FoundPaths {
  std::vector<std::vector<PathNode>> events;
  std::vector<std::vector<PathNode>> samples;
};

FoundPaths PathsOfSpan(const Trace& trace, const Selection& selection) {
  std::vector<const Location*> selected;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) selected.push_back(&l);
  FoundPaths found;
  found.events.resize(trace.locations().size());
  found.samples.resize(trace.locations().size());
  trace.ForEachOf(selected, "reading", [&](const Location& l) {
    LocationPaths paths = PathsOf(trace, l, selection);
    found.events[l.index] = std::move(paths.events);
    found.samples[l.index] = std::move(paths.samples);
  });
  return found;
}

}  // namespace

CallPaths CallPathsOf(const Analysis& analysis, const Selection& selection) {
  const Trace& trace = analysis.trace;
  FoundPaths of_span;
  if (selection.WholeTime())
    analysis.NeedPaths();
  else
    of_span = PathsOfSpan(trace, selection);
  const auto& events = selection.WholeTime() ? *analysis.paths : of_span.events;
  const auto& samples = selection.WholeTime() ? *analysis.sample_paths : of_span.samples;
  CallPaths paths;
  for (const Location& l : trace.locations()) {
    if (!selection.HasRank(l.rank)) continue;
    JoinEvents(trace, trace.ProcessOf(l), events[l.index], paths.events);
    JoinSamples(trace, trace.ProcessOf(l), samples[l.index], paths.samples);
    paths.has_events |= events[l.index].size() > 1;
    for (const PathNode& node : events[l.index]) paths.folded += node.own.folded;
  }
  if (selection.regions) {
    paths.events = Through(paths.events, selection);
    paths.samples = Through(paths.samples, selection);
  }
  paths.events.Finish();
  paths.samples.Finish();
  paths.sample_count = paths.samples.nodes().front().samples_below;
  paths.sampled_ns = paths.samples.nodes().front().inclusive_ns;
  return paths;
}

Table CallPathsTable(const CallPaths& paths) {
  Table table{"callpaths", TableShape::kTree, {}, {}};
  for (const char* name :
       {"path", "calls", "inclusive_s", "exclusive_s", "messages", "bytes", "samples"})
    table.columns.push_back({name});
  if (paths.folded != 0) table.columns.push_back({"folded_calls"});
  AddRows(paths.events, false, {}, table);
  if (paths.sample_count == 0) return table;
  std::vector<std::string> root;
  if (paths.has_events) {
    const Cell none;
    root.emplace_back(kSamplesPath);
    table.rows.push_back(
        RowOf(root, none, paths.sampled_ns * 1e-9, 0.0, none, none, CountCell(paths.sample_count)));
    if (paths.folded != 0) table.rows.back().emplace_back();
  }
  AddRows(paths.samples, true, root, table);
  return table;
}

Table SampledProfileTable(const CallPaths& paths) {
  struct Times {
    double inclusive_ns = 0;
    double exclusive_ns = 0;
  };
  std::map<std::string_view, Times> by_name;
  for (const PathTree::Node& n : paths.samples.nodes()) {
    if (n.name.empty()) continue;
    by_name[n.name].inclusive_ns += n.inclusive_ns;
    by_name[n.name].exclusive_ns += n.own.exclusive_ns;
  }
  std::vector<std::tuple<double, double, std::string_view>> order;
  for (const auto& [name, t] : by_name) order.emplace_back(-t.exclusive_ns, -t.inclusive_ns, name);
  std::ranges::sort(order);
  Table table{"profile", TableShape::kRows, {}, {}};
  for (const char* name :
       {"region", "file", "line", "calls", "inclusive_s", "exclusive_s", "exclusive_low_s",
        "exclusive_high_s", "inclusive_low_s", "inclusive_high_s"})
    table.columns.push_back({name});
  for (const auto& [exclusive, inclusive, name] : order)
    table.rows.push_back(RowOf(std::string(name), Cell(), Cell(), Cell(), -inclusive * 1e-9,
                               -exclusive * 1e-9, Cell(), Cell(), Cell(), Cell()));
  return table;
}

std::string SamplesText(const CallPaths& paths) {
  // A share p of n samples has the standard error sqrt(p (1 - p) / n): at most half of 1/sqrt(n).
  const double worst =
      0.98 / std::sqrt(static_cast<double>(std::max<std::uint64_t>(paths.sample_count, 1)));
  return fmt::format(
      "From {}, {} of processor time: a share is an estimate, {:.1f} % more or less.",
      FormatCount(paths.sample_count, "sample"), FormatSeconds(paths.sampled_ns * 1e-9),
      worst * 100);
}

std::string FoldedText(const CallPaths& paths) {
  if (paths.folded == 0) return {};
  std::uint64_t calls = paths.folded;
  for (const PathTree::Node& n : paths.events.nodes()) calls += n.own.calls;
  return fmt::format(
      "{} ({} of all) would have led to more than {} of a thread: they are not among the calls, "
      "and their time is their callers'.",
      FormatCount(paths.folded, "call"),
      PercentText(static_cast<double>(paths.folded), static_cast<double>(calls)),
      FormatCount(kMostPaths, "path"));
}

TableAnswer CallPathsAnswer(const Analysis& analysis, const Selection& selection,
                            const TableOptions&) {
  const CallPaths paths = CallPathsOf(analysis, selection);
  TableAnswer answer{CallPathsTable(paths), "No region was visited."};
  const PathTree& tree = paths.has_events ? paths.events : paths.samples;
  const PathTree::Node* best = nullptr;
  for (const PathTree::Node& n : tree.nodes())
    if (!n.name.empty() && (best == nullptr || n.own.exclusive_ns > best->own.exclusive_ns))
      best = &n;
  if (best == nullptr) return answer;
  std::string path;
  for (const PathTree::Node* n = best; !n->name.empty(); n = &tree.nodes()[n->parent])
    path = ShortName(n->name) + (path.empty() ? "" : " > ") + path;
  answer.headline = PercentText(best->own.exclusive_ns, tree.nodes().front().inclusive_ns) +
                    " of the time is spent at the end of " + path + ".";
  if (!paths.has_events) answer.headline += " " + SamplesText(paths);
  if (paths.folded != 0) answer.headline += " " + FoldedText(paths);
  if (!analysis.steps.empty())
    answer.headline +=
        " Of functions that the budget left without times only timed visits have time here, the "
        "rest is their callers', and visits that were only counted are missing: see profile.";
  return answer;
}

TableAnswer SampledProfileAnswer(const Analysis& analysis, const Selection& selection) {
  constexpr std::size_t kExclusive = 5;
  Selection all_regions = selection;  // a region's time is its own on all paths
  all_regions.regions.reset();
  const CallPaths paths = CallPathsOf(analysis, all_regions);
  TableAnswer answer{SampledProfileTable(paths), "No region was visited."};
  auto& rows = answer.table.rows;
  std::erase_if(rows, [&selection](const std::vector<Cell>& row) {
    return !selection.HasRegion(std::get<std::string>(row.front()));
  });
  if (!rows.empty())
    answer.headline =
        PercentText(std::get<double>(rows.front()[kExclusive]), paths.sampled_ns * 1e-9) +
        " of the time is spent in " + ShortName(std::get<std::string>(rows.front().front())) +
        " itself. " + SamplesText(paths);
  return answer;
}

}  // namespace stipple
