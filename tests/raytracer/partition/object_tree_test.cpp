// SPDX-License-Identifier: MIT
#include "raytracer/partition/object_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "raytracer/partition/box_sample.h"
#include "raytracer/partition/holding.h"

namespace stipple::raytracer {
namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon();

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double In(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 Point(double size) { return {In(-size, size), In(-size, size), In(-size, size)}; }
  /// Often along an axis, where planes are parallel to it.
  Vec3 Direction() {
    const double kind = In(0, 1);
    if (kind < 0.1) return {0, In(0, 1) < 0.5 ? 1.0 : -1.0, 0};
    if (kind < 0.2) return Normalized(Vec3{In(-1, 1), 0, In(-1, 1)});
    return Normalized(Point(1));
  }

 private:
  std::mt19937_64 random_;
};

std::vector<Bounds> SmallBoxes(std::size_t count, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    Bounds box;
    box.Include(dice.Point(10));
    box.Include(box.low + Vec3{dice.In(0, 1), dice.In(0, 1), i % 7 == 0 ? 0 : dice.In(0, 1)});
    boxes.push_back(box);
  }
  return boxes;
}

/// By leaf: numbers of the objects that lie in it.
std::vector<std::set<std::uint32_t>> ObjectsIn(const ObjectTree& tree,
                                               const std::vector<Bounds>& boxes) {
  std::vector<std::set<std::uint32_t>> objects(tree.leaves());
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t number = 0; number < boxes.size(); ++number) {
    tree.LeavesOf(boxes[number], leaves);
    EXPECT_TRUE(std::ranges::is_sorted(leaves));
    for (const std::uint32_t leaf : leaves) objects[leaf].insert(number);
  }
  return objects;
}

TEST(ObjectTree, EachObjectLiesInEveryLeafWhoseCellItReachesInto) {
  const std::vector<Bounds> boxes = SmallBoxes(500, 1);
  for (const std::uint32_t leaves : {1U, 2U, 3U, 8U, 32U, 100U}) {
    const ObjectTree tree(boxes, leaves);
    ASSERT_EQ(tree.leaves(), leaves);
    const std::vector<std::set<std::uint32_t>> objects = ObjectsIn(tree, boxes);
    for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
      const Bounds& cell = tree.CellOf(leaf);
      for (std::uint32_t number = 0; number < boxes.size(); ++number) {
        const Vec3 low = Max(boxes[number].low, cell.low),
                   high = Min(boxes[number].high, cell.high);
        if (low.x < high.x && low.y < high.y && low.z < high.z) {
          EXPECT_TRUE(objects[leaf].contains(number)) << leaf << ' ' << number;
        }
      }
    }
  }
}

TEST(ObjectTree, LeavesHoldAboutTheSameNumberOfObjects) {
  const std::vector<Bounds> boxes = SmallBoxes(5000, 2);
  for (const std::uint32_t leaves : {2U, 5U, 8U, 32U}) {
    const ObjectTree tree(boxes, leaves);
    std::size_t most = 0;
    for (const std::set<std::uint32_t>& in : ObjectsIn(tree, boxes))
      most = std::max(most, in.size());
    EXPECT_LT(static_cast<double>(most), 2.0 * 5000 / leaves) << leaves;
  }
}

/// All leaves on a ray's way.
std::vector<LeafOnWay> WayOf(const ObjectTree& tree, const Ray<double>& ray) {
  LeafWay way;
  way.Begin(tree, ray, kRounding);
  EXPECT_EQ(way.Reach(tree.leaves() + 1), false);
  return {way.leaves().begin(), way.leaves().end()};
}

// What makes the picture that of the serial program.
TEST(ObjectTree, WhateverARayMeetsLiesInALeafOnItsWay) {
  const std::vector<Bounds> boxes = SmallBoxes(300, 3);
  Dice dice(4);
  for (const std::uint32_t leaves : {1U, 2U, 7U, 32U}) {
    const ObjectTree tree(boxes, leaves);
    const std::vector<std::set<std::uint32_t>> objects = ObjectsIn(tree, boxes);
    for (int i = 0; i < 20000; ++i) {
      Ray<double> ray{dice.Point(12), dice.Direction()};
      if (i % 3 == 0) ray.origin = boxes[static_cast<std::size_t>(i) % boxes.size()].low;
      const std::vector<LeafOnWay> way = WayOf(tree, ray);
      for (std::size_t at = 1; at < way.size(); ++at) EXPECT_LE(way[at - 1].enter, way[at].enter);
      for (std::uint32_t number = 0; number < boxes.size(); ++number) {
        const double meets = EnterBounds(boxes[number], SlabRay(ray, 1), 1e30);
        if (std::isinf(meets)) continue;
        const bool found = std::ranges::any_of(way, [&](const LeafOnWay& on_way) {
          return on_way.enter <= meets && objects[on_way.leaf].contains(number);
        });
        EXPECT_TRUE(found) << leaves << ' ' << i << ' ' << number;
      }
    }
  }
}

TEST(ObjectTree, NothingAndOneEnormousObject) {
  EXPECT_TRUE(WayOf(ObjectTree({}, 8), {{0, 0, 0}, {0, 0, 1}}).empty());
  std::vector<Bounds> boxes = SmallBoxes(50, 5);
  boxes.push_back({{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}});
  const ObjectTree tree(boxes, 8);
  for (const std::set<std::uint32_t>& in : ObjectsIn(tree, boxes)) EXPECT_TRUE(in.contains(50));
}

TEST(ObjectTree, ObjectsInOnePlaceStillGiveAsManyLeaves) {
  const std::vector<Bounds> boxes(20, Bounds{{1, 1, 1}, {2, 2, 2}});
  const ObjectTree tree(boxes, 8);
  EXPECT_FALSE(WayOf(tree, {{0, 1.5, 1.5}, {1, 0, 0}}).empty());
}

TEST(ObjectTree, AWayIsTheSameHoweverMuchOfItIsAskedForAndCostsNoMoreThanIsAsked) {
  const ObjectTree tree(SmallBoxes(300, 3), 32);
  Dice dice(7);
  for (int i = 0; i < 1000; ++i) {
    const Ray<double> ray{dice.Point(12), dice.Direction()};
    const std::vector<LeafOnWay> whole = WayOf(tree, ray);
    LeafWay way;
    way.Begin(tree, ray, kRounding);
    std::uint64_t work = way.Work();
    for (std::size_t count = 1; count <= whole.size(); ++count) {
      ASSERT_TRUE(way.Reach(count));
      ASSERT_EQ(way.leaves().size(), count);
      ASSERT_EQ(way.leaves().back().leaf, whole[count - 1].leaf);
      ASSERT_EQ(way.leaves().back().enter, whole[count - 1].enter);
      ASSERT_GE(way.Work(), work);
      work = way.Work();
    }
    ASSERT_FALSE(way.Reach(whole.size() + 1));
    ASSERT_EQ(way.Work(), work);
  }
}

TEST(Holding, EvenReplicationIsTheStudys) {
  for (const int ranks : {1, 2, 5, 8})
    for (int each = 1; each <= ranks; ++each) {
      const Holding holding = Holding::Even(ranks, each);
      for (int rank = 0; rank < ranks; ++rank)
        EXPECT_EQ(holding.LeavesOf(rank).size(), static_cast<std::size_t>(each));
      const std::vector<LeafOnWay> way{{0, 0}, {static_cast<std::uint32_t>(ranks - 1), 1}};
      const std::vector<std::uint64_t> nobody(static_cast<std::size_t>(ranks));
      for (std::uint32_t spread = 0; spread < 20; ++spread)
        EXPECT_TRUE(holding.Holds(holding.Next(way, nobody, spread), 0));
    }
}

TEST(Holding, ARayGoesToWhoCanFollowItFarthest) {
  const Holding holding = Holding::Even(8, 3);  // rank r holds r, r + 1, r + 2
  std::vector<std::uint64_t> waiting(8);
  EXPECT_EQ(holding.Next(std::vector<LeafOnWay>{{2, 0}, {3, 1}, {4, 2}}, waiting, 5), 2);
  EXPECT_EQ(holding.Next(std::vector<LeafOnWay>{{2, 0}, {0, 1}}, waiting, 1), 0);
}

TEST(Holding, ARayGoesToWhoHasFewIfTheOthersHaveManyMore) {
  const Holding holding = Holding::Even(8, 3);
  const std::vector<LeafOnWay> way{{2, 0}, {3, 1}, {4, 2}};
  std::vector<std::uint64_t> waiting(8);
  waiting[2] = Holding::kManyRays - 1;
  EXPECT_EQ(holding.Next(way, waiting, 5), 2);
  waiting[2] = Holding::kManyRays;
  EXPECT_EQ(holding.Next(way, waiting, 5), 1);  // of 0, 1 and 2, which hold leaf 2
  waiting[0] = waiting[1] = 2 * Holding::kManyRays;
  EXPECT_EQ(holding.Next(way, waiting, 5), 2);
}

TEST(BoxSample, FewObjectsAreAllTaken) {
  const std::vector<Bounds> boxes = SmallBoxes(4096, 7);
  BoxSample sample(4);
  for (std::uint32_t number = 0; number < boxes.size(); ++number) sample.See(boxes[number], number);
  ASSERT_EQ(sample.boxes().size(), boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    EXPECT_EQ(sample.boxes()[i].low, boxes[i].low) << i;
}

// Objects that lie in rows, as generators make them: every second on the same side.
TEST(BoxSample, OfManyObjectsATreeHalvesAllAboutAsWell) {
  std::vector<Bounds> boxes = SmallBoxes(100000, 8);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    boxes[i].low.x -= 30;
    boxes[i].high.x -= 30;
  }
  for (const std::uint32_t leaves : {2U, 8U, 32U}) {
    BoxSample sample(leaves);
    for (std::uint32_t number = 0; number < boxes.size(); ++number)
      sample.See(boxes[number], number);
    EXPECT_LE(sample.boxes().size() * sizeof(Bounds), BoxSample::BytesFor(leaves, boxes.size()));
    const auto most_of = [&](const ObjectTree& tree) {
      std::size_t most = 0;
      for (const std::set<std::uint32_t>& in : ObjectsIn(tree, boxes))
        most = std::max(most, in.size());
      return static_cast<double>(most);
    };
    const ObjectTree tree(sample.boxes(), leaves, sample.scene());
    EXPECT_LT(most_of(tree), 1.2 * most_of(ObjectTree(boxes, leaves))) << leaves;
  }
}

}  // namespace
}  // namespace stipple::raytracer
