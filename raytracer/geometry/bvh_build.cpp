// SPDX-License-Identifier: MIT
// Top-down construction. A range of boxes is split where bins of centres along one axis promise the
// smallest expected cost (area x objects, on both sides). A node begins as one
// range, and the largest of its ranges is split until there are eight or none is worth it.
//
// Speed comes from touching memory little: boxes are 32 bytes, partitioned in place, and the pass
// that partitions a range also finds the boxes of both parts. Four numbers at a time: vectors of
// the compiler, which every machine has; minimum and maximum are exact, so the tree is everywhere
// the same.
#include "raytracer/geometry/bvh_build.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

using Four [[gnu::vector_size(16)]] = float;
using FourInts [[gnu::vector_size(16)]] = std::int32_t;

Four Least(Four a, Four b) { return a < b ? a : b; }
Four Greatest(Four a, Four b) { return a > b ? a : b; }

constexpr int kMaxBins = 16;
// Of what testing a block of four objects costs: opening one more box.
constexpr float kBoxCost = 0.9F;
constexpr float kPatchCost = 16;  // of one patch
constexpr float kFar = std::numeric_limits<float>::infinity();
// Deeper ranges are halved by count: at most 32 levels more.
constexpr int kMaxHeuristicDepth = static_cast<int>(kMaxBvhDepth) - 40;

/// A box; the fourth number is of no account.
struct Box {
  Four low = {kFar, kFar, kFar, kFar};
  Four high = {-kFar, -kFar, -kFar, -kFar};

  void Include(Four other_low, Four other_high) {
    low = Least(low, other_low);
    high = Greatest(high, other_high);
  }
  void Include(const Box& other) { Include(other.low, other.high); }

  float HalfArea() const {
    const Four size = high - low;
    return size[0] >= 0 ? size[0] * size[1] + size[1] * size[2] + size[2] * size[0] : 0;
  }
};

Four LowOf(const BoxedObject& object) {
  Four low;
  std::memcpy(&low, object.low, sizeof low);
  return low;
}
Four HighOf(const BoxedObject& object) {
  Four high;
  std::memcpy(&high, object.high, sizeof high);
  return high;
}

struct Range {
  std::uint32_t begin = 0, end = 0;
  int depth = 0;
  bool leaf = false;  // as far as it will be split
  Box box{};
  Box centers{};  // of low + high, twice the centre

  std::uint32_t size() const { return end - begin; }
  void Include(const BoxedObject& object) {
    const Four low = LowOf(object), high = HighOf(object);
    const Four center = low + high;
    box.Include(low, high);
    centers.Include(center, center);
  }
};

/// Where the bins of a range lie along all axes.
struct Binning {
  Four low, bins_per_unit;
  int count;

  explicit Binning(const Range& range)
      : low(range.centers.low),
        count(std::min<int>(kMaxBins, 4 + static_cast<int>(range.size()) / 2)) {
    const Four extent = range.centers.high - low;
    const Four bins = static_cast<float>(count) * 0.9999F / extent;
    bins_per_unit = bins < kFar ? bins : Four{};  // flat or tiny: all in one bin
  }
  /// Number of the bin along x, y, z.
  FourInts BinsOf(Four object_low, Four object_high) const {
    return __builtin_convertvector((object_low + object_high - low) * bins_per_unit, FourInts);
  }
};

struct Split {
  int axis = -1;
  int bin = 0;  // objects of bins below this one go left
  float cost = 0;
};

/// Cost of testing `count` objects that begin with one of `kind`. Triangles are counted in whole
/// blocks, others by their share of one: that is what measured best, for either.
float CostOf(ShapeKind kind, std::uint32_t count) {
  if (kind == ShapeKind::kTriangle) return static_cast<float>((count + kLanes - 1) / kLanes);
  if (kind == ShapeKind::kPatch) return kPatchCost * static_cast<float>(count);
  return static_cast<float>(count) / kLanes;
}

class Builder {
 public:
  explicit Builder(std::vector<BoxedObject>& boxes) : boxes_(boxes) {
    tree_.nodes.reserve(boxes.size() / 8 + 1);
  }

  Hierarchy8 Build() {
    Range all{.end = static_cast<std::uint32_t>(boxes_.size())};
    for (const BoxedObject& object : boxes_) all.Include(object);
    tree_.nodes.emplace_back();
    tree_.root = ChildRef::ToNode(0, BuildNode(0, all));
    return std::move(tree_);
  }

 private:
  /// Returns how many children the node has.
  std::uint32_t BuildNode(std::uint32_t node, const Range& all) {
    std::array<Range, kMaxChildren> children;
    const std::size_t count = Open(all, children);
    auto next = static_cast<std::uint32_t>(tree_.nodes.size());
    const auto inner = std::count_if(children.begin(), children.begin() + static_cast<long>(count),
                                     [](const Range& range) { return !range.leaf; });
    tree_.nodes.resize(tree_.nodes.size() + static_cast<std::size_t>(inner));
    if (tree_.nodes.size() > ChildRef::kMaxNodes)
      throw InputError("scene", 0, "too many objects for one hierarchy");
    for (std::size_t i = 0; i < kMaxChildren; ++i) SetBox(tree_.nodes[node], i, children[i].box);
    for (std::size_t i = 0; i < count; ++i) {
      if (children[i].leaf) {
        tree_.nodes[node].child[i] = AddLeaf(children[i]);
        continue;
      }
      const std::uint32_t child = next++;
      const ChildRef ref = ChildRef::ToNode(child, BuildNode(child, children[i]));
      tree_.nodes[node].child[i] = ref;
    }
    return static_cast<std::uint32_t>(count);
  }

  static void SetBox(WideNode& node, std::size_t child, const Box& box) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      node.side[WideNode::SideAt(0, axis) + child] = box.low[axis];
      node.side[WideNode::SideAt(1, axis) + child] = box.high[axis];
    }
  }

  /// Splits the range, always the largest part, until there are eight; returns how many.
  std::size_t Open(const Range& all, std::array<Range, kMaxChildren>& children) {
    std::size_t count = 1;
    children[0] = all;
    while (count < kMaxChildren) {
      Range* widest = nullptr;
      float widest_area = -1;
      for (std::size_t i = 0; i < count; ++i) {
        const float area = children[i].box.HalfArea();
        if (children[i].leaf || area <= widest_area) continue;
        widest = &children[i];
        widest_area = area;
      }
      if (widest == nullptr) break;
      if (!Divide(*widest, children[count])) {
        widest->leaf = true;
        continue;
      }
      ++count;
    }
    for (std::size_t i = 0; i < count; ++i)
      children[i].leaf = children[i].leaf || children[i].size() == 1;
    return count;
  }

  bool OfOneKind(const Range& range) const {
    for (std::uint32_t i = range.begin + 1; i < range.end; ++i)
      if (boxes_[i].kind != boxes_[range.begin].kind) return false;
    return true;
  }

  /// Of the kind of its first object: are four tested at once?
  bool InBlocks(const Range& range) const {
    const ShapeKind kind = boxes_[range.begin].kind;
    return kind != ShapeKind::kPolygon && kind != ShapeKind::kPatch;
  }

  /// Moves a part of the range to `right`; false if it is best left whole.
  bool Divide(Range& range, Range& right) {
    if (range.size() == 1) return false;
    const bool small = range.size() <= ChildRef::kMaxLeafObjects;
    const bool can_be_leaf = small && OfOneKind(range);
    if (small && !can_be_leaf) {
      const ShapeKind kind = boxes_[range.begin].kind;
      Partition(range, right, [&](const BoxedObject& object) { return object.kind == kind; });
      return true;
    }
    const Binning binning(range);
    const Split split = range.depth < kMaxHeuristicDepth ? BestSplit(range, binning) : Split{};
    if (can_be_leaf) {
      const float area = range.box.HalfArea();
      const float together = CostOf(boxes_[range.begin].kind, range.size());
      if (split.axis < 0 || together * area <= split.cost + kBoxCost * area) return false;
    }
    if (split.axis < 0) {
      Halve(range, right);
      return true;
    }
    const auto axis = static_cast<std::size_t>(split.axis);
    Partition(range, right, [&](const BoxedObject& object) {
      return binning.BinsOf(LowOf(object), HighOf(object))[axis] < split.bin;
    });
    return true;
  }

  /// Objects that go left are brought to the front, the others to the end.
  template <class GoesLeft>
  void Partition(Range& range, Range& right_part, GoesLeft goes_left) {
    Range left{.begin = range.begin, .depth = range.depth + 1};
    Range right{.end = range.end, .depth = range.depth + 1};
    std::uint32_t i = range.begin, j = range.end;
    for (;;) {
      while (i < j && goes_left(boxes_[i])) left.Include(boxes_[i++]);
      while (i < j && !goes_left(boxes_[j - 1])) right.Include(boxes_[--j]);
      if (i == j) break;
      std::swap(boxes_[i], boxes_[j - 1]);
    }
    left.end = right.begin = i;
    range = left;
    right_part = right;
  }

  /// For what no bin tells apart.
  void Halve(Range& range, Range& right_part) {
    const std::uint32_t middle = range.begin + range.size() / 2;
    Range left{.begin = range.begin, .end = middle, .depth = range.depth + 1};
    Range right{.begin = middle, .end = range.end, .depth = range.depth + 1};
    for (std::uint32_t i = left.begin; i < left.end; ++i) left.Include(boxes_[i]);
    for (std::uint32_t i = right.begin; i < right.end; ++i) right.Include(boxes_[i]);
    range = left;
    right_part = right;
  }

  struct Bins {
    Box box[3][kMaxBins];
    std::uint32_t count[3][kMaxBins] = {};
  };

  Split BestSplit(const Range& range, const Binning& binning) const {
    Bins bins;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Four low = LowOf(boxes_[i]), high = HighOf(boxes_[i]);
      const FourInts bin = binning.BinsOf(low, high);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto b = static_cast<std::size_t>(bin[axis]);
        bins.box[axis][b].Include(low, high);
        ++bins.count[axis][b];
      }
    }
    Split best;
    for (int axis = 0; axis < 3; ++axis)
      ConsiderAxis(bins, axis, binning.count, boxes_[range.begin].kind, best);
    return best;
  }

  static void ConsiderAxis(const Bins& bins, int axis, int bin_count, ShapeKind kind, Split& best) {
    const Box(&boxes)[kMaxBins] = bins.box[axis];
    const std::uint32_t(&counts)[kMaxBins] = bins.count[axis];
    float right_cost[kMaxBins];  // of the bins from this one on
    std::uint32_t right_count[kMaxBins];
    Box box;
    std::uint32_t count = 0;
    for (int bin = bin_count - 1; bin > 0; --bin) {
      box.Include(boxes[bin]);
      count += counts[bin];
      right_count[bin] = count;
      right_cost[bin] = count == 0 ? 0 : box.HalfArea() * CostOf(kind, count);
    }
    box = {};
    count = 0;
    for (int bin = 1; bin < bin_count; ++bin) {
      box.Include(boxes[bin - 1]);
      count += counts[bin - 1];
      if (count == 0 || right_count[bin] == 0) continue;
      const float cost = box.HalfArea() * CostOf(kind, count) + right_cost[bin];
      if (best.axis < 0 || cost < best.cost) best = {axis, bin, cost};
    }
  }

  ChildRef AddLeaf(const Range& range) {
    const ShapeKind kind = boxes_[range.begin].kind;
    std::vector<std::uint32_t>& numbers = tree_.numbers[static_cast<std::size_t>(kind)];
    const std::uint32_t lanes = InBlocks(range) ? kLanes : 1;
    const auto first = static_cast<std::uint32_t>(numbers.size()) / lanes;
    if (first >= ChildRef::kMaxPlaces)
      throw InputError("scene", 0, "too many objects for one hierarchy");
    for (std::uint32_t i = range.begin; i < range.end; ++i) numbers.push_back(boxes_[i].object);
    while (numbers.size() % lanes != 0) numbers.push_back(kNoObject);
    return ChildRef::ToLeaf(kind, first, range.size());
  }

  std::vector<BoxedObject>& boxes_;
  Hierarchy8 tree_;
};

}  // namespace

Hierarchy8 BuildHierarchy(std::vector<BoxedObject>& boxes) { return Builder(boxes).Build(); }

}  // namespace stipple::raytracer
