// SPDX-License-Identifier: MIT
// What each event touches is small and near: the sums of a path lie apart from the tree, times are
// added as ticks, and where a call leads is one look into an open table.
#include "analysis/stats/path_scan.h"

#include <algorithm>
#include <utility>

#include "analysis/stats/frame_stack.h"
#include "analysis/trace/native_stack.h"
#include "analysis/trace/whole_scan.h"

namespace stipple {
namespace {

/// A tree whose paths are made of numbers.
class NumberTree {
 public:
  NumberTree() : nodes_(1), slots_(64) {}

  /// The path that goes on from `node` with `number`; 0: it was not met.
  std::uint32_t Find(std::uint32_t node, std::uint64_t number) const {
    return slots_[PlaceOf(node, number)].to;
  }
  std::uint32_t Child(std::uint32_t node, std::uint64_t number) {
    if (const std::uint32_t known = Find(node, number); known != 0) return known;
    nodes_.push_back({node, number, {}});
    return Know(node, number, static_cast<std::uint32_t>(nodes_.size() - 1));
  }
  /// The place of `number` on the path that ends at `node`, or else a new end of it.
  std::uint32_t Folded(std::uint32_t node, std::uint64_t number) {
    std::uint64_t seen = node;
    while (seen != 0 && nodes_[seen].number != number) seen = nodes_[seen].parent;
    return seen == 0 ? Child(node, number) : Know(node, number, static_cast<std::uint32_t>(seen));
  }
  std::vector<PathNode>& nodes() { return nodes_; }

 private:
  struct Slot {
    std::uint64_t number = 0;
    std::uint32_t from = 0;
    std::uint32_t to = 0;  // 0: free, for nothing leads to the root
  };

  std::size_t PlaceOf(std::uint32_t node, std::uint64_t number) const {
    const std::size_t mask = slots_.size() - 1;
    const std::uint64_t hash =
        (number * 0x9e3779b97f4a7c15U + node) * std::uint64_t{0xff51afd7ed558ccd};
    std::size_t at = (hash >> 32) & mask;
    while (slots_[at].to != 0 && (slots_[at].from != node || slots_[at].number != number))
      at = (at + 1) & mask;
    return at;
  }
  std::uint32_t Know(std::uint32_t node, std::uint64_t number, std::uint32_t to) {
    slots_[PlaceOf(node, number)] = {number, node, to};
    if (2 * ++used_ > slots_.size()) {
      const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
      for (const Slot& s : old)
        if (s.to != 0) slots_[PlaceOf(s.from, s.number)] = s;
    }
    return to;
  }

  std::vector<PathNode> nodes_;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

/// An open visit; the lowest one stands for no region.
struct Frame {
  std::uint32_t region;
  std::uint32_t path;
  std::uint32_t folded;  // the path is its caller's
};

class PathVisitor {
 public:
  /// What an event adds to.
  struct Sums {
    std::uint64_t calls = 0;
    std::uint64_t ticks = 0;
    std::uint64_t folded = 0;
    std::uint64_t leads_on = 0;  // calls from here were followed
  };

  struct Hot {
    PathVisitor* owner;
    Sums* sums;
    RegionCalls* regions;
    Frame* top;
    Frame* limit;
    std::uint64_t begin;
    std::uint64_t end;
    std::uint64_t last;
    bool is_full;  // there is to be no further path

    void Function(std::uint32_t region, bool leave, std::uint64_t ticks) {
      Charge(ticks);
      if (leave) {
        if (top->region != region) [[unlikely]] {
          top = owner->stack_.Innermost(top, region);
          if (top->region != region) return;  // was never entered
        }
        --top;
        return;
      }
      const auto counts = static_cast<std::uint64_t>(begin <= ticks && ticks < end);
      regions[region].calls += counts;
      regions[top->region].children += counts;
      // What is called from a call that is not told apart is not, either.
      std::uint32_t path = top->path;
      std::uint32_t folded = top->folded;
      if (folded == 0) {
        path = sums[path].leads_on == 0 ? 0 : owner->events_.Find(path, region);
        if (path == 0 && !is_full) {
          path = owner->NewPath(top->path, region);
          sums = owner->sums_.data();
          is_full = owner->sums_.size() >= kMostPaths;
        } else if (path == 0) {
          path = top->path;
          folded = 1;
        }
      }
      sums[path].calls += counts & (folded ^ 1);
      sums[path].folded += counts & folded;
      if (top == limit) [[unlikely]] {
        top = owner->stack_.Grow(top);
        limit = owner->stack_.Limit();
      }
      *++top = {region, path, folded};
    }
    void Unclocked(std::uint32_t region, bool leave, std::uint64_t ticks) {
      ++owner->paths_.unclocked;
      Function(region, leave, ticks);
    }
    void Record(const EventWord* record, std::uint64_t ticks) {
      *this = owner->Record(*this, record, ticks);
    }
    /// The time since the last event is the innermost frame's.
    void Charge(std::uint64_t ticks) {
      const std::uint64_t now = ticks < begin ? begin : ticks > end ? end : ticks;
      sums[top->path].ticks += now - last;
      last = now;
    }
  };

  PathVisitor(std::uint32_t region_count, std::uint64_t begin, std::uint64_t end)
      : sums_(1), stack_({region_count, 0, 0}) {
    paths_.regions.resize(region_count + 1);
    hot_ = {this,  sums_.data(), paths_.regions.data(), stack_.Bottom(), stack_.Limit(), begin, end,
            begin, false};
  }
  PathVisitor(const PathVisitor&) = delete;
  PathVisitor& operator=(const PathVisitor&) = delete;

  Hot Begin() const { return hot_; }
  void End(const Hot& hot) { hot_ = hot; }

  LocationPaths Finish(std::uint64_t ticks, double ns_per_tick) {
    hot_.Charge(std::max(hot_.last, ticks));
    std::vector<PathNode>& nodes = events_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i].own.calls = sums_[i].calls;
      nodes[i].own.folded = sums_[i].folded;
      nodes[i].own.exclusive_ns = static_cast<double>(sums_[i].ticks) * ns_per_tick;
    }
    nodes.front().own.exclusive_ns = 0;  // what is on no path is nobody's
    paths_.events = std::move(nodes);
    paths_.samples = std::move(samples_.nodes());
    paths_.regions.pop_back();
    return std::move(paths_);
  }

 private:
  /// Where a call from a path leads for the first time.
  std::uint32_t NewPath(std::uint32_t path, std::uint32_t region) {
    const std::uint32_t to = events_.Folded(path, region);
    sums_.resize(events_.nodes().size());
    sums_[path].leads_on = 1;
    return to;
  }

  // By value: a hot part whose address is known elsewhere would not stay in registers.
  Hot Record(Hot hot, const EventWord* record, std::uint64_t ticks) {
    const RecordKind kind = KindOf(*record);
    const bool inside = hot.begin <= ticks && ticks < hot.end;
    if (kind == RecordKind::kSample) {
      if (inside) AddSample(record);
      return hot;
    }
    hot.Charge(ticks);
    hot.top = stack_.Record(hot.top, record);
    hot.limit = stack_.Limit();
    if (kind == RecordKind::kMpiSend && inside) {
      PathSums& own = events_.nodes()[hot.top->path].own;
      ++own.messages;
      own.bytes += RecordAt<MpiSend>(record).bytes;
    }
    return hot;
  }

  void AddSample(const EventWord* record) {
    const NativeFrames frames = FramesOf(record);
    const std::size_t count = frames.words.size();
    const bool inside = frames.cut != 0 && frames.cut != kUnknownCut && count > kMostOuterFrames;
    std::uint32_t node = 0;
    if (frames.cut != 0 && !inside) node = samples_.Child(node, kCutFrame);
    for (std::size_t i = count; i-- > 0;) {
      // Which of two neighbours a return address belongs to is decided here: the call's.
      node = samples_.Child(node, i == 0 ? frames.words[i] : frames.words[i] - 1);
      if (inside && i == count - kMostOuterFrames) node = samples_.Child(node, kCutFrame);
    }
    PathSums& own = samples_.nodes()[node].own;
    ++own.samples;
    own.exclusive_ns += static_cast<double>(RecordAt<Sample>(record).cpu_ns);
  }

  std::vector<Sums> sums_;  // by path of events
  FrameStack<Frame> stack_;
  NumberTree events_;
  NumberTree samples_;
  LocationPaths paths_;
  Hot hot_{};
};

}  // namespace

PathSums& PathSums::operator+=(const PathSums& o) {
  calls += o.calls;
  exclusive_ns += o.exclusive_ns;
  messages += o.messages;
  bytes += o.bytes;
  samples += o.samples;
  folded += o.folded;
  return *this;
}

LocationPaths PathsOf(const Trace& trace, const Location& l, const Selection& selection) {
  const bool whole = selection.WholeTime();
  PathVisitor visitor(trace.ProcessOf(l).RegionCount(),
                      whole ? 0 : trace.TicksAt(l, selection.begin_ns),
                      whole ? kNoTickLimit + 1 : trace.TicksAt(l, selection.end_ns));
  ScanWhole(trace, l, visitor);
  return visitor.Finish(l.last_ticks, trace.NsPerTick(l));
}

}  // namespace stipple
