// SPDX-License-Identifier: MIT
#include "raytracer/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string_view>
#include <vector>

#include "raytracer/errors.h"

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
      const Sphere<Real>& sphere = model.spheres[object.index];
      const double radius = std::abs(ToDouble(sphere.radius));
      measure.Point(ToDouble(sphere.center), radius);
      return measure.Feature(radius);
    }
    case ShapeKind::kCone: {
      const Cone<Real>& cone = model.cones[object.index];
      const double base = std::abs(ToDouble(cone.base_radius));
      const double apex = std::abs(ToDouble(cone.apex_radius));
      measure.Point(ToDouble(cone.base), base);
      measure.Point(ToDouble(cone.apex), apex);
      measure.Feature(std::max(base, apex));
      return measure.Feature(ToDouble(cone.height));
    }
    case ShapeKind::kTriangle: {
      const auto& corner = model.triangles[object.index].corner;
      Vec3 corners[3];
      for (int i = 0; i < 3; ++i)
        corners[i] = {ToDouble(corner[i][0]), ToDouble(corner[i][1]), ToDouble(corner[i][2])};
      return measure.Outline(corners);
    }
    case ShapeKind::kPolygon: {
      const Polygon<Real>& polygon = model.polygons[object.index];
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
  const std::string error = fmt::format(
      "float would err by {:.2g} of the smallest feature ({:.3g}, with coordinates and "
      "distances to {:.3g}); allowed {}",
      FloatError(facts), facts.smallest, facts.reach, kFloatErrorAllowed);
  return {options.precision, options.precision == "float"
                                 ? error
                                 : error + "; double, exact to the pixel, takes a tenth more time"};
}

Decision Shape(const SceneFacts& facts, const Options&) {
  return {"as they are",
          fmt::format("{} spheres, {} cones, {} triangles, {} polygons: quadrics are met exactly; "
                      "as triangles they would take 1000 times the memory for a worse picture",
                      facts.CountOf(ShapeKind::kSphere), facts.CountOf(ShapeKind::kCone),
                      facts.CountOf(ShapeKind::kTriangle), facts.CountOf(ShapeKind::kPolygon))};
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
              : "and no ray is cut: SPD's rule; --min-contribution 0.02 saves up to a fifth of the "
                "rays for 0.1 dB"};
}

Decision Shading(const SceneFacts& facts, const Options&) {
  if (facts.extended) return {"extended", "media with priorities, or lights that rays can meet"};
  if (facts.transmits) return {"with refraction", "no media that overlap, no lights with a radius"};
  return {"opaque", "nothing transmits: the code of refraction and media is not run"};
}

Decision Hierarchy(const SceneFacts& facts, const Options& options) {
  if (options.kernel == "embree") return {"Embree's", "as asked, in float"};
  return {"always",
          fmt::format("{} objects: already with 3 it takes fewer tests than trying all of them",
                      facts.Objects())};
}

Decision RayGroups(const SceneFacts&, const Options&) {
  return {"one by one",
          "packets pay for eye rays on meshes only, and cost up to twice the time elsewhere"};
}

Decision Memory(const SceneFacts& facts, const Options&) {
  const std::uint64_t objects = std::max<std::uint64_t>(1, facts.Objects());
  return {"a copy per node", fmt::format("{} bytes, {} an object: no rays travel to objects",
                                         facts.model_bytes, facts.model_bytes / objects)};
}

struct DecisionRow {
  std::string_view what;
  Decision (*decide)(const SceneFacts&, const Options&);
};
constexpr DecisionRow kDecisions[] = {
    {"precision", Precision}, {"shapes", Shape},    {"samples", SamplesOfPixel},
    {"depth", Depth},         {"shading", Shading}, {"hierarchy", Hierarchy},
    {"rays", RayGroups},      {"memory", Memory},
};

}  // namespace

std::uint64_t SceneFacts::Objects() const {
  return std::accumulate(count.begin(), count.end(), std::uint64_t{0});
}

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
  for (const Material& material : scene.materials) {
    facts.transmits |= material.transmission > 0;
    facts.mirrors |= material.specular > 0 || material.transmission > 0;
    facts.extended |= material.priority > 0;
  }
  for (const Light& light : scene.lights) facts.extended |= light.radius > 0;
  return facts;
}

template SceneFacts FactsOf(const Scene&, Model<float>&);
template SceneFacts FactsOf(const Scene&, Model<double>&);
template SceneFacts FactsOf(const Scene&, Model<long double>&);

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
