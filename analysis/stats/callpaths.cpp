// SPDX-License-Identifier: MIT
// Each location is scanned once, on its own core, into a tree of numbers: regions for events, words
// of native stacks for samples. The trees are then joined by name, one location after the other, so
// that the result does not depend on the machine.
#include "analysis/stats/callpaths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "analysis/stats/finding_of.h"
#include "analysis/stats/number.h"
#include "analysis/trace/call_stack.h"
#include "analysis/trace/demangle.h"
#include "analysis/trace/native_stack.h"

namespace stipple {
namespace {

/// A tree whose paths are made of numbers.
class NumberTree {
 public:
  struct Node {
    std::uint32_t parent;
    std::uint64_t number;
    PathSums own;
  };

  static constexpr std::size_t kMostPaths = 5'000;

  NumberTree() : nodes_(1) {}
  std::uint32_t Child(std::uint32_t parent, std::uint64_t number) {
    const auto [at, is_new] =
        children_.try_emplace({parent, number}, static_cast<std::uint32_t>(nodes_.size()));
    if (is_new) nodes_.push_back({parent, number, {}});
    return at->second;
  }
  /// The place of `number` on the path that ends at `node`, or else a new end of it.
  /// When there are more paths than anybody can read, calls that would make a new one count for
  /// their caller: memory stays bounded, whatever the program does.
  std::uint32_t Folded(std::uint32_t node, std::uint64_t number) {
    if (nodes_.size() >= kMostPaths) {
      const auto known = folded_.find({node, number});
      return known == folded_.end() ? node : known->second;
    }
    const auto [at, is_new] = folded_.try_emplace({node, number}, 0);
    if (is_new) {
      std::uint32_t seen = node;
      while (seen != 0 && nodes_[seen].number != number) seen = nodes_[seen].parent;
      at->second = seen != 0 ? seen : Child(node, number);
    }
    return at->second;
  }
  PathSums& Own(std::uint32_t node) { return nodes_[node].own; }
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  using Edge = std::pair<std::uint32_t, std::uint64_t>;
  struct HashOfEdge {
    std::size_t operator()(const Edge& e) const {
      return (e.first * 0x9e3779b97f4a7c15u) ^ (e.second * 0xff51afd7ed558ccdu);
    }
  };
  std::vector<Node> nodes_;  // a parent stands before its children
  std::unordered_map<Edge, std::uint32_t, HashOfEdge> children_;
  std::unordered_map<Edge, std::uint32_t, HashOfEdge> folded_;
};

constexpr std::uint64_t kCutFrame = ~std::uint64_t{0};  // stands for frames that were left out

/// Both trees of one location.
struct LocationPaths {
  NumberTree events;
  NumberTree samples;
  bool has_events = false;
};

/// Follows the call stack; `nodes_` holds the path of each open frame.
class PathVisitor {
 public:
  PathVisitor(LocationPaths& paths, std::uint64_t begin, std::uint64_t end, double ns_per_tick)
      : paths_(paths), begin_(begin), end_(end), last_(begin), ns_per_tick_(ns_per_tick) {}

  void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
    Charge(ticks);
    paths_.has_events = true;
    stack_.Function(region, leave);
    Follow(leave ? 0 : 1);
  }
  void Record(const EventWord* record, std::uint64_t ticks) {
    const RecordKind kind = KindOf(*record);
    if (kind == RecordKind::kSample) return AddSample(record, ticks);
    Charge(ticks);
    const std::uint32_t context = stack_.context();
    stack_.Record(record);
    const bool switched = stack_.context() != context;
    if (switched) nodes_.clear();
    Follow(switched ? 0 : 1);
    if (kind == RecordKind::kMpiSend && IsInside(ticks)) {
      PathSums& own = paths_.events.Own(Top());
      ++own.messages;
      own.bytes += RecordAt<MpiSend>(record).bytes;
    }
  }
  void Finish(std::uint64_t ticks) { Charge(ticks); }

 private:
  bool IsInside(std::uint64_t ticks) const {
    return begin_ <= ticks && (ticks < end_ || end_ == kNoTickLimit);
  }
  std::uint32_t Top() const { return nodes_.empty() ? 0 : nodes_.back(); }

  /// The time since the last event is the innermost frame's.
  void Charge(std::uint64_t ticks) {
    const std::uint64_t now = std::clamp(ticks, begin_, end_);
    counts_ = IsInside(ticks);
    if (now <= last_) return;
    if (!nodes_.empty())
      paths_.events.Own(Top()).exclusive_ns += static_cast<double>(now - last_) * ns_per_tick_;
    last_ = now;
  }

  /// Makes `nodes_` what the stack is now; a frame that is new has `calls`.
  void Follow(std::uint64_t calls) {
    const auto frames = stack_.frames();
    if (nodes_.size() > frames.size()) nodes_.resize(frames.size());
    while (nodes_.size() < frames.size()) {
      nodes_.push_back(paths_.events.Folded(Top(), frames[nodes_.size()]));
      if (counts_) paths_.events.Own(nodes_.back()).calls += calls;
    }
  }

  void AddSample(const EventWord* record, std::uint64_t ticks) {
    if (!IsInside(ticks)) return;
    const NativeFrames frames = FramesOf(record);
    const std::size_t count = frames.words.size();
    const bool inside = frames.cut != 0 && frames.cut != kUnknownCut && count > kMostOuterFrames;
    std::uint32_t node = 0;
    if (frames.cut != 0 && !inside) node = paths_.samples.Child(node, kCutFrame);
    for (std::size_t i = count; i-- > 0;) {
      // Which of two neighbours a return address belongs to is decided here: the call's.
      node = paths_.samples.Child(node, i == 0 ? frames.words[i] : frames.words[i] - 1);
      if (inside && i == count - kMostOuterFrames) node = paths_.samples.Child(node, kCutFrame);
    }
    PathSums& own = paths_.samples.Own(node);
    ++own.samples;
    own.exclusive_ns += static_cast<double>(RecordAt<Sample>(record).cpu_ns);
  }

  LocationPaths& paths_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::uint64_t last_;
  double ns_per_tick_;
  bool counts_ = true;  // the event lies in the selected span
  CallStack stack_;
  std::vector<std::uint32_t> nodes_;
};

LocationPaths PathsOf(const Trace& trace, const Location& l, const Selection& selection) {
  const bool whole = selection.WholeTime();
  LocationPaths paths;
  PathVisitor visitor(paths, whole ? 0 : trace.TicksAt(l, selection.begin_ns),
                      whole ? kNoTickLimit : trace.TicksAt(l, selection.end_ns),
                      trace.NsPerTick(l));
  trace.Scan(l, visitor);
  visitor.Finish(l.last_ticks);
  return paths;
}

void JoinEvents(const Trace& trace, const Process& process, NumberTree& from, PathTree& to) {
  std::vector<std::size_t> place(from.nodes().size(), to.Root());
  for (std::size_t i = 1; i < place.size(); ++i) {
    const NumberTree::Node& node = from.nodes()[i];
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

void JoinSamples(const Trace& trace, const Process& process, NumberTree& from, PathTree& to) {
  std::vector<std::size_t> place(from.nodes().size(), to.Root());
  std::vector<bool> has_children(place.size());
  for (const NumberTree::Node& node : from.nodes()) has_children[node.parent] = true;
  for (std::size_t i = 1; i < place.size(); ++i) {
    const NumberTree::Node& node = from.nodes()[i];
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
    push_children(at, depth + 1);
  }
}

}  // namespace

PathSums& PathSums::operator+=(const PathSums& o) {
  calls += o.calls;
  exclusive_ns += o.exclusive_ns;
  messages += o.messages;
  bytes += o.bytes;
  samples += o.samples;
  return *this;
}

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

CallPaths CallPathsOf(const Trace& trace, const Selection& selection) {
  std::vector<const Location*> selected;
  for (const Location& l : trace.locations())
    if (selection.HasRank(l.rank)) selected.push_back(&l);
  std::vector<LocationPaths> parts(trace.locations().size());
  trace.ForEachOf(selected, "reading",
                  [&](const Location& l) { parts[l.index] = PathsOf(trace, l, selection); });
  CallPaths paths;
  for (const Location* l : selected) {
    LocationPaths& part = parts[l->index];
    JoinEvents(trace, trace.ProcessOf(*l), part.events, paths.events);
    JoinSamples(trace, trace.ProcessOf(*l), part.samples, paths.samples);
    paths.has_events |= part.has_events;
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
  AddRows(paths.events, false, {}, table);
  if (paths.sample_count == 0) return table;
  std::vector<std::string> root;
  if (paths.has_events) {
    const Cell none;
    root.emplace_back(kSamplesPath);
    table.rows.push_back(
        RowOf(root, none, paths.sampled_ns * 1e-9, 0.0, none, none, CountCell(paths.sample_count)));
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

TableAnswer CallPathsAnswer(const Analysis& analysis, const Selection& selection,
                            const TableOptions&) {
  const CallPaths paths = CallPathsOf(analysis.trace, selection);
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
  const CallPaths paths = CallPathsOf(analysis.trace, all_regions);
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
