// SPDX-License-Identifier: MIT
#include "raytracer/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string_view>
#include <vector>

#include "raytracer/errors.h"
#include "raytracer/scene/patches.h"
#include "raytracer/scene/scene_cache.h"

namespace stipple::raytracer {
namespace {

double ToDouble(auto x) { return static_cast<double>(x); }

template <class Real>
Vec3 ToDouble(Vec<Real> v) {
  return {ToDouble(v.x), ToDouble(v.y), ToDouble(v.z)};
}

/// Takes the points and the sizes of shapes into the facts.
class Measure {
 public:
  Measure(SceneFacts& facts, Vec3 eye) : facts_(facts), eye_(eye) { facts_.reach = MaxNorm(eye); }

  void Point(Vec3 point, double around) {
    facts_.reach = std::max({facts_.reach, MaxNorm(point) + around, Length(point - eye_) + around});
  }
  void Feature(double size) { facts_.smallest = std::min(facts_.smallest, size); }

  /// A closed outline.
  void Outline(std::span<const Vec3> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Point(corners[i], 0);
      Feature(Length(corners[(i + 1) % corners.size()] - corners[i]));
    }
  }

 private:
  SceneFacts& facts_;
  Vec3 eye_;
};

template <class Real>
void TakeObject(const Model<Real>& model, const Object& object, Measure& measure) {
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<Real> sphere = model.SphereAt(object.index);
      const double radius = std::abs(ToDouble(sphere.radius));
      measure.Point(ToDouble(sphere.center), radius);
      return measure.Feature(radius);
    }
    case ShapeKind::kCone: {
      const Cone<Real> cone = model.ConeAt(object.index);
      const double base = std::abs(ToDouble(cone.base_radius));
      const double apex = std::abs(ToDouble(cone.apex_radius));
      measure.Point(ToDouble(cone.base), base);
      measure.Point(ToDouble(cone.apex), apex);
      measure.Feature(std::max(base, apex));
      return measure.Feature(ToDouble(cone.height));
    }
    case ShapeKind::kTriangle: {
      const Triangle<Real> triangle = model.TriangleAt(object.index);
      const auto& corner = triangle.corner;
      Vec3 corners[3];
      for (int i = 0; i < 3; ++i)
        corners[i] = {ToDouble(corner[i][0]), ToDouble(corner[i][1]), ToDouble(corner[i][2])};
      return measure.Outline(corners);
    }
    case ShapeKind::kPolygon: {
      const Polygon<Real> polygon = model.PolygonAt(object.index);
      std::vector<Vec3> corners;
      for (std::uint32_t i = 0; i < polygon.vertex_count; ++i)
        corners.push_back(ToDouble(model.vertices[polygon.first_vertex + i]));
      return measure.Outline(corners);
    }
    case ShapeKind::kPatch: {
      const Vec<Real>* const control = model.patches[object.index].control;
      for (int i = 0; i < 16; ++i) measure.Point(ToDouble(control[i]), 0);
      // Corner to corner; an edge that is a single point is no feature.
      for (const auto& [a, b] : {std::pair{0, 3}, {3, 15}, {15, 12}, {12, 0}})
        if (control[a] != control[b]) measure.Feature(ToDouble(Length(control[a] - control[b])));
      return;
    }
  }
}

struct Decision {
  std::string choice;
  std::string reason;
};

Decision Precision(const SceneFacts& facts, const Options& options) {
  return {
      options.precision,
      fmt::format("float errs by {:.2g} of the smallest feature ({:.3g}, seen over {:.3g}), {} is "
                  "allowed; double takes a tenth more time",
                  FloatError(facts), facts.smallest, facts.reach, kFloatErrorAllowed)};
}

Decision Shape(const SceneFacts& facts, const Options&) {
  return {
      "as they are",
      fmt::format("{} spheres, {} cones, {} triangles, {} polygons: quadrics are met exactly, cut "
                  "into triangles they would take 100 times the memory for a worse picture",
                  facts.CountOf(ShapeKind::kSphere), facts.CountOf(ShapeKind::kCone),
                  facts.CountOf(ShapeKind::kTriangle), facts.CountOf(ShapeKind::kPolygon))};
}

Decision Patches(const SceneFacts& facts, const Options& options) {
  const PatchChoice& patches = facts.patches;
  if (patches.patches == 0) return {"none", "the scene has no Bezier patches"};
  const std::string needed =
      fmt::format("{} cells a side would keep the triangles of {} patches within {} pixel",
                  patches.cells_needed, patches.patches, kPatchErrorPixels);
  const std::string_view asked = options.patches == "auto" ? "" : "as asked; ";
  if (patches.cells == 0)
    return {"met directly", fmt::format("{}{}; up to {} are made", asked, needed, kMostPatchCells)};
  return {fmt::format("{0} x {0} cells", patches.cells),
          fmt::format("{}off by {:.2g} pixel at most; {}", asked, patches.error_pixels, needed)};
}

Decision SamplesOfPixel(const SceneFacts&, const Options& options) {
  if (options.samples.corners())
    return {"corners", "one ray a pixel, shared with its neighbours: 5 dB better than one inside"};
  if (options.samples.adaptive)
    return {
        "8 to 256 a pixel",
        "as each needs: 1 to 4 dB better than N for the same work where some pixels are simple"};
  return {fmt::format("{} a pixel", options.samples.per_pixel),
          "as asked: in strata, error falls with the 0.66th power of their number"};
}

Decision Depth(const SceneFacts& facts, const Options& options) {
  const int depth = DepthFor(facts, static_cast<int>(options.max_depth));
  if (!facts.mirrors) return {"1", "no material reflects or lets through: no ray is lost"};
  return {fmt::format("{}", depth),
          options.min_contribution > 0
              ? fmt::format("rays that carry less than {} are cut; what they could add at most is "
                            "in the answer",
                            options.min_contribution)
              : "no ray is cut, as SPD has it; for pictures --min-contribution 0.02 saves up to a "
                "fifth and loses 0.1 dB at most"};
}

Decision Shading(const SceneFacts& facts, const Options&) {
  switch (facts.rules) {
    case Rules::kOpaque:
      return {"opaque", "nothing transmits: a tracer without refraction and media"};
    case Rules::kTransmitting:
      return {"refracting", "each transparent object lies in air: a tracer without media"};
    case Rules::kExtended:
      break;
  }
  return {"extended", "media with priorities, or lights that rays can meet"};
}

Decision Hierarchy(const SceneFacts& facts, const Options& options) {
  if (options.kernel == "embree") return {"Embree's", "as asked, in float"};
  return {"always", fmt::format("{} objects; it pays from 10 on, a tie below", facts.Objects())};
}

Decision RayGroups(const SceneFacts&, const Options&) {
  return {"one by one",
          "in packets the tests of a ray would depend on who traces its neighbours; what Embree's "
          "gain is in the chart packets"};
}

Decision Memory(const SceneFacts& facts, const Options&) {
  const auto bytes = static_cast<double>(facts.model_bytes);
  if (facts.parts > 0)
    return {
        fmt::format("{} of {} parts each", facts.parts_held, facts.parts),
        fmt::format("{:.1f} MB at most on a rank; with the copies of objects that lie in several "
                    "parts {} objects: rays travel to theirs",
                    bytes * 1e-6, facts.copies)};
  return {"a copy per node",
          fmt::format("{:.1f} MB, {:.0f} bytes an object: no ray has to travel to its objects",
                      bytes * 1e-6, bytes / std::max(1.0, static_cast<double>(facts.Objects())))};
}

Decision Cache(const SceneFacts& facts, const Options& options) {
  if (options.scene.find_first_of("./") == std::string::npos)
    return {"none", "the scene is generated, which is faster than reading it"};
  if (facts.Objects() < kLeastCachedObjects)
    return {"none", fmt::format("fewer than {} objects are read in a tenth of a second",
                                kLeastCachedObjects)};
  return {"kept",
          fmt::format("from {} objects on reading text takes longer than drawing: next time "
                      "the model is mapped from {}",
                      kLeastCachedObjects, CacheFolder())};
}

struct DecisionRow {
  std::string_view what;
  Decision (*decide)(const SceneFacts&, const Options&);
};
constexpr DecisionRow kDecisions[] = {
    {"precision", Precision},    {"shapes", Shape},   {"patches", Patches},
    {"samples", SamplesOfPixel}, {"depth", Depth},    {"shading", Shading},
    {"hierarchy", Hierarchy},    {"rays", RayGroups}, {"cache", Cache},
    {"memory", Memory},
};

}  // namespace

std::uint64_t SceneFacts::Objects() const {
  return std::accumulate(count.begin(), count.end(), std::uint64_t{0});
}

namespace {

/// What does not lie in the objects.
void TakeMaterials(const Scene& scene, SceneFacts& facts) {
  facts.patches = scene.patches;
  for (const Material& material : scene.materials)
    facts.mirrors |= material.specular > 0 || material.transmission > 0;
  facts.rules = RulesOf(scene);
}

}  // namespace

template <class Real>
SceneFacts FactsOf(const Scene& scene, Model<Real>& model) {
  SceneFacts facts;
  Measure measure(facts, scene.view.from);
  for (const Object& object : model.objects) {
    ++facts.count[static_cast<std::size_t>(object.kind)];
    TakeObject(model, object, measure);
  }
  model.ForEachArray(
      [&](const auto& array) { facts.model_bytes += array.size() * sizeof(array[0]); });
  TakeMaterials(scene, facts);
  return facts;
}

template SceneFacts FactsOf(const Scene&, Model<float>&);
template SceneFacts FactsOf(const Scene&, Model<double>&);
template SceneFacts FactsOf(const Scene&, Model<long double>&);

template <class Real>
SceneFacts FactsOf(const World& world, SceneParts<Real>& parts) {
  SceneFacts facts;
  const SceneFacts here = FactsOf(parts.scene, parts.here->model);
  facts.reach = here.reach;
  facts.smallest = here.smallest;
  facts.model_bytes = parts.model_bytes;
  MPI_Allreduce(MPI_IN_PLACE, &facts.reach, 1, MPI_DOUBLE, MPI_MAX, world.comm);
  MPI_Allreduce(MPI_IN_PLACE, &facts.smallest, 1, MPI_DOUBLE, MPI_MIN, world.comm);
  MPI_Allreduce(MPI_IN_PLACE, &facts.model_bytes, 1, MPI_UINT64_T, MPI_MAX, world.comm);
  TakeMaterials(parts.scene, facts);
  facts.count = parts.count;
  facts.parts = static_cast<int>(parts.tree.leaves());
  facts.parts_held = static_cast<int>(parts.holding.LeavesOf(0).size());
  facts.copies = parts.copies;
  return facts;
}

template SceneFacts FactsOf(const World&, SceneParts<float>&);
template SceneFacts FactsOf(const World&, SceneParts<double>&);

double FloatError(const SceneFacts& facts) { return facts.reach / facts.smallest * 0x1p-24 * 32; }

void RequireDigits(const SceneFacts& facts, const Options& options) {
  if (options.precision != "float" || FloatError(facts) < kFloatErrorAllowed) return;
  throw UsageError(
      fmt::format("--precision float: this scene needs double: its smallest feature is {:.3g}, its "
                  "coordinates and distances reach {:.3g}, so float would err by {:.2g} of the "
                  "feature; {} is allowed",
                  facts.smallest, facts.reach, FloatError(facts), kFloatErrorAllowed));
}

int DepthFor(const SceneFacts& facts, int wanted) { return facts.mirrors ? wanted : 1; }

std::string Explanation(const SceneFacts& facts, const Options& options) {
  std::string text = fmt::format("Plan for {} objects:\n", facts.Objects());
  for (const DecisionRow& row : kDecisions) {
    const Decision decision = row.decide(facts, options);
    text += fmt::format("  {:<10} {:<16} {}\n", row.what, decision.choice, decision.reason);
  }
  return text;
}

}  // namespace stipple::raytracer
