// SPDX-License-Identifier: MIT
// Top-down construction: at each node the objects' centres are sorted into bins along each axis,
// and the boundary between two bins with the smallest expected cost (area x objects, on both sides)
// splits the node.
#include <algorithm>
#include <array>
#include <numeric>

#include "raytracer/geometry/convert.h"
#include "raytracer/geometry/model.h"

namespace stipple::raytracer {
namespace {

constexpr int kBinCount = 16;
constexpr std::uint32_t kMaxLeafObjects = 8;
constexpr double kBoxCost = 1.0;  // of one box test, in units of one primitive test
constexpr int kMaxHeuristicDepth =
    kMaxBvhDepth - 40;  // deeper nodes are halved by count: at most 32 levels more

struct Split {
  int axis = -1;
  int bin = 0;  // objects of bins below this one go left
  double cost = 0;
};

double Component(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Vec3 CenterOf(const Bounds& box) { return (box.low + box.high) * 0.5; }

class Builder {
 public:
  explicit Builder(const Shapes& shapes) : shapes_(shapes), order_(shapes.objects.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
  }

  void Build() {
    if (order_.empty()) return;
    bounds_.reserve(order_.size());
    for (const Object& object : shapes_.objects) bounds_.push_back(BoundsOf(shapes_, object));
    nodes_.reserve(order_.size());
    nodes_.push_back({});
    BuildNode(0, {0, static_cast<std::uint32_t>(order_.size())}, 0);
  }

  std::vector<BvhNode> TakeNodes() { return std::move(nodes_); }
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  struct Range {
    std::uint32_t begin, end;
    std::uint32_t size() const { return end - begin; }
  };

  /// Where along `axis` the bins of a node lie.
  struct Binning {
    int axis;
    double low;
    double bins_per_unit;

    Binning(const Bounds& centers, int along)
        : axis(along),
          low(Component(centers.low, along)),
          bins_per_unit(kBinCount / (Component(centers.high, along) - low)) {}
    bool Usable() const { return bins_per_unit > 0 && std::isfinite(bins_per_unit); }
    int BinOf(Vec3 center) const {
      const double bin = (Component(center, axis) - low) * bins_per_unit;
      return std::min(kBinCount - 1, static_cast<int>(bin));
    }
  };

  void BuildNode(std::uint32_t node, Range range, int depth) {
    Bounds box, centers;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      box.Include(bounds_[order_[i]]);
      centers.Include(CenterOf(bounds_[order_[i]]));
    }
    nodes_[node].bounds = box;
    const std::uint32_t middle = Divide(range, box, centers, depth);
    if (middle == range.end) {
      nodes_[node].first = range.begin;
      nodes_[node].count = range.size();
      return;
    }
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = children;
    nodes_[node].count = 0;
    nodes_.resize(nodes_.size() + 2);
    BuildNode(children, {range.begin, middle}, depth + 1);
    BuildNode(children + 1, {middle, range.end}, depth + 1);
  }

  /// Reorders the range and returns where its second part begins; the end of the range if it should
  /// be a leaf.
  std::uint32_t Divide(Range range, const Bounds& box, const Bounds& centers, int depth) {
    if (range.size() == 1) return range.end;
    const Split split = depth < kMaxHeuristicDepth ? BestSplit(range, centers) : Split{};
    if (split.axis < 0)  // all centres in one place, or too deep
      return range.size() <= kMaxLeafObjects ? range.end : range.begin + range.size() / 2;
    const double split_cost = 2 * kBoxCost + split.cost / HalfArea(box);
    if (range.size() <= kMaxLeafObjects && range.size() <= split_cost) return range.end;
    const Binning binning(centers, split.axis);
    const auto middle = std::stable_partition(
        order_.begin() + range.begin, order_.begin() + range.end,
        [&](std::uint32_t object) { return binning.BinOf(CenterOf(bounds_[object])) < split.bin; });
    return static_cast<std::uint32_t>(middle - order_.begin());
  }

  Split BestSplit(Range range, const Bounds& centers) const {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      const Binning binning(centers, axis);
      if (!binning.Usable()) continue;
      const Split split = BestSplitAlong(range, binning);
      if (split.axis >= 0 && (best.axis < 0 || split.cost < best.cost)) best = split;
    }
    return best;
  }

  Split BestSplitAlong(Range range, const Binning& binning) const {
    std::array<Bounds, kBinCount> boxes;
    std::array<std::uint32_t, kBinCount> counts{};
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Bounds& box = bounds_[order_[i]];
      const auto bin = static_cast<std::size_t>(binning.BinOf(CenterOf(box)));
      boxes[bin].Include(box);
      ++counts[bin];
    }
    std::array<double, kBinCount> right_cost{};  // of the bins from this one on
    Bounds box;
    std::uint32_t count = 0;
    for (std::size_t bin = kBinCount - 1; bin > 0; --bin) {
      box.Include(boxes[bin]);
      count += counts[bin];
      right_cost[bin] = HalfArea(box) * count;
    }
    Split best;
    box = {};
    count = 0;
    for (std::size_t bin = 1; bin < kBinCount; ++bin) {
      box.Include(boxes[bin - 1]);
      count += counts[bin - 1];
      if (count == 0 || count == range.size()) continue;
      const double cost = HalfArea(box) * count + right_cost[bin];
      if (best.axis < 0 || cost < best.cost) best = {binning.axis, static_cast<int>(bin), cost};
    }
    return best;
  }

  const Shapes& shapes_;
  std::vector<std::uint32_t> order_;
  std::vector<Bounds> bounds_;  // by object number
  std::vector<BvhNode> nodes_;
};

/// The elements of one kind in the order in which `order` visits them; tells the objects.
template <class Real, class From>
auto Reordered(const std::vector<From>& shapes, ShapeKind kind,
               const std::vector<std::uint32_t>& order, std::vector<Object>& objects) {
  std::vector<decltype(Converted<Real>(shapes[0]))> moved;
  moved.reserve(shapes.size());
  for (const std::uint32_t number : order) {
    Object& object = objects[number];
    if (object.kind != kind) continue;
    moved.push_back(Converted<Real>(shapes[object.index]));
    object.index = static_cast<std::uint32_t>(moved.size() - 1);
  }
  return moved;
}

template <class Real, class From>
auto AllConverted(const std::vector<From>& elements) {
  std::vector<decltype(Converted<Real>(elements[0]))> converted;
  converted.reserve(elements.size());
  for (const From& element : elements) converted.push_back(Converted<Real>(element));
  return converted;
}

}  // namespace

template <class Real>
Model<Real> BuildModel(Shapes&& shapes, Hierarchy hierarchy) {
  Builder builder(shapes);
  if (hierarchy == Hierarchy::kOfModel) builder.Build();
  const std::vector<std::uint32_t>& order = builder.order();
  std::vector<Object>& objects = shapes.objects;
  Model<Real> model;
  model.spheres = Reordered<Real>(shapes.spheres, ShapeKind::kSphere, order, objects);
  model.cones = Reordered<Real>(shapes.cones, ShapeKind::kCone, order, objects);
  model.triangles = Reordered<Real>(shapes.triangles, ShapeKind::kTriangle, order, objects);
  model.polygons = Reordered<Real>(shapes.polygons, ShapeKind::kPolygon, order, objects);
  model.patches = Reordered<Real>(shapes.patches, ShapeKind::kPatch, order, objects);
  model.vertices = AllConverted<Real>(shapes.vertices);
  model.outlines = AllConverted<Real>(shapes.outlines);
  model.normals = AllConverted<Real>(shapes.normals);
  if (hierarchy == Hierarchy::kOfModel) {
    std::vector<BvhEntry> entries;
    entries.reserve(order.size());
    for (const std::uint32_t number : order)
      entries.push_back({objects[number].kind, objects[number].index, number});
    model.entries = std::move(entries);
  }
  model.nodes = builder.TakeNodes();
  model.objects = std::move(shapes.objects);
  shapes = {};
  return model;
}

template Model<float> BuildModel(Shapes&&, Hierarchy);
template Model<double> BuildModel(Shapes&&, Hierarchy);
template Model<long double> BuildModel(Shapes&&, Hierarchy);

}  // namespace stipple::raytracer
