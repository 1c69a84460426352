// SPDX-License-Identifier: MIT
#include "raytracer/charts/trials/crack_trial.h"

#include <map>
#include <utility>

#include "raytracer/charts/rejected/triangle.h"
#include "raytracer/charts/trials/random.h"
#include "raytracer/geometry/kernel.h"

namespace stipple::raytracer {
namespace {

constexpr int kDivisions = 2;
constexpr long double kEyeDistance = 5;

struct Face {
  int corner[3];
};

/// Vertices on the unit sphere; faces are counterclockwise seen from outside.
struct Mesh {
  std::vector<WideVec> vertices;
  std::vector<Face> faces;
};

Mesh Icosahedron() {
  const long double g = (1 + std::sqrt(5.0L)) / 2;
  Mesh mesh{{{-1, g, 0},
             {1, g, 0},
             {-1, -g, 0},
             {1, -g, 0},
             {0, -1, g},
             {0, 1, g},
             {0, -1, -g},
             {0, 1, -g},
             {g, 0, -1},
             {g, 0, 1},
             {-g, 0, -1},
             {-g, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (WideVec& vertex : mesh.vertices) vertex = Normalized(vertex);
  return mesh;
}

/// Each face becomes four.
Mesh Divided(const Mesh& mesh) {
  Mesh divided{mesh.vertices, {}};
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<int>(divided.vertices.size()));
    if (added)
      divided.vertices.push_back(Normalized(mesh.vertices[static_cast<std::size_t>(a)] +
                                            mesh.vertices[static_cast<std::size_t>(b)]));
    return at->second;
  };
  for (const auto& [c] : mesh.faces) {
    const int ab = middle(c[0], c[1]), bc = middle(c[1], c[2]), ca = middle(c[2], c[0]);
    for (const Face& face :
         {Face{{c[0], ab, ca}}, Face{{c[1], bc, ab}}, Face{{c[2], ca, bc}}, Face{{ab, bc, ca}}})
      divided.faces.push_back(face);
  }
  return divided;
}

Mesh Ball() {
  Mesh mesh = Icosahedron();
  for (int i = 0; i < kDivisions; ++i) mesh = Divided(mesh);
  return mesh;
}

/// The mesh where it stands, rounded, and rays at places where triangles meet.
template <class Real>
class CrackRays {
 public:
  explicit CrackRays(double offset)
      : mesh_(Ball()), center_{offset, offset, offset}, around_(mesh_.vertices.size()) {
    for (const Face& face : mesh_.faces) {
      std::vector<Vec3> corners;
      for (const int corner : face.corner) {
        around_[static_cast<std::size_t>(corner)].push_back(triangles_.size());
        const WideVec placed = center_ + mesh_.vertices[static_cast<std::size_t>(corner)];
        corners.push_back(Rounded<double>(Rounded<Real>(placed)));
      }
      shapes_.AddPolygon(corners, {}, 0);
      triangles_.emplace_back();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          triangles_.back().corner[i][j] = static_cast<Real>(shapes_.triangles.back().corner[i][j]);
    }
  }

  struct AimedRay {
    Ray<Real> ray;
    std::vector<std::size_t> faces;  // all that meet where the ray is aimed
  };

  /// At the inner part of an edge of a face; the whole of it faces the eye.
  AimedRay AtEdge() {
    const auto face = static_cast<std::size_t>(random_.Below(static_cast<int>(triangles_.size())));
    const int* const corner = mesh_.faces[face].corner;
    const int first = random_.Below(3);
    const int ends[2] = {corner[first], corner[(first + 1) % 3]};
    AimedRay aimed;
    for (const std::size_t i : around_[static_cast<std::size_t>(ends[0])])
      for (const int other : mesh_.faces[i].corner)
        if (other == ends[1]) aimed.faces.push_back(i);
    const long double part = random_.Between(0.1L, 0.9L);
    aimed.ray = Aim(Placed(ends[0]) * (1 - part) + Placed(ends[1]) * part);
    return aimed;
  }
  AimedRay AtVertex() {
    const auto vertex = random_.Below(static_cast<int>(mesh_.vertices.size()));
    return {Aim(Placed(vertex)), around_[static_cast<std::size_t>(vertex)]};
  }

  const std::vector<Triangle<Real>>& triangles() const { return triangles_; }
  const Shapes& shapes() const { return shapes_; }

 private:
  WideVec Placed(int vertex) const {
    return Rounded<long double>(
        Rounded<Real>(center_ + mesh_.vertices[static_cast<std::size_t>(vertex)]));
  }
  Ray<Real> Aim(WideVec target) {
    const WideVec outward = Normalized(target - center_);
    const WideVec eye = target + random_.DirectionAround(outward, 0.6L) * kEyeDistance;
    return RoundedRay<Real>(eye, target);
  }

  Mesh mesh_;
  WideVec center_;
  std::vector<std::vector<std::size_t>> around_;  // faces at each vertex
  std::vector<Triangle<Real>> triangles_;
  Shapes shapes_;
  Random random_{1};
};

/// `missed(aimed)`: did the ray slip through?
template <class Real, class Missed>
CrackRates CountCracks(CrackRays<Real>& rays, int count, Missed missed) {
  CrackRates rates;
  for (int i = 0; i < count; ++i) {
    rates.edges += missed(rays.AtEdge()) ? 1.0 / count : 0;
    rates.vertices += missed(rays.AtVertex()) ? 1.0 / count : 0;
  }
  return rates;
}

template <class Real>
void AddRows(std::string_view precision, int rays, std::vector<CrackRow>& rows) {
  for (const TriangleTest<Real>& test : TriangleTests<Real>())
    for (const double offset : {0.0, 10.0, 1000.0})
      rows.push_back({precision, test.name, offset, TryCracks(test, offset, rays)});
}

}  // namespace

template <class Real>
std::vector<TriangleTest<Real>> TriangleTests() {
  using Mesh = Triangle<Real>;
  using Line = Ray<Real>;
  return {{"moeller-trumbore",
           [](const Mesh& triangle, const Line& ray) {
             return rejected::MoellerTrumbore(triangle, ray, Real{0});
           }},
          {"moeller-trumbore guarded",
           [](const Mesh& triangle, const Line& ray) {
             return rejected::MoellerTrumbore(triangle, ray,
                                              static_cast<Real>(rejected::kSmallDeterminant));
           }},
          {"watertight", [](const Mesh& triangle, const Line& ray) {
             return IntersectTriangle(triangle, ShearRay<Real>(ray)).t;
           }}};
}

template <class Real>
CrackRates TryCracks(const TriangleTest<Real>& test, double offset, int rays) {
  CrackRays<Real> aimed_rays(offset);
  return CountCracks(aimed_rays, rays, [&](const auto& aimed) {
    for (const std::size_t face : aimed.faces)
      if (test.intersect(aimed_rays.triangles()[face], aimed.ray) != kMiss<Real>) return false;
    return true;
  });
}

template <class Real>
CrackRates TryCracks(std::string_view kernel_name, double offset, int rays) {
  CrackRays<Real> aimed_rays(offset);
  const Model<Real> model = BuildModel<Real>(Shapes(aimed_rays.shapes()));
  const auto kernel = MakeKernel(kernel_name, model);
  TestCounts tests;
  return CountCracks(aimed_rays, rays, [&](const auto& aimed) {
    const Hit<Real> hit = kernel->Intersect(aimed.ray, tests);
    return hit.object == kNoObject || hit.t > static_cast<Real>(kEyeDistance + 0.5L);
  });
}

template std::vector<TriangleTest<float>> TriangleTests();
template std::vector<TriangleTest<double>> TriangleTests();
template CrackRates TryCracks(const TriangleTest<float>&, double, int);
template CrackRates TryCracks(const TriangleTest<double>&, double, int);
template CrackRates TryCracks<float>(std::string_view, double, int);
template CrackRates TryCracks<double>(std::string_view, double, int);
template CrackRates TryCracks<long double>(std::string_view, double, int);

std::vector<CrackRow> CrackRows(int rays) {
  std::vector<CrackRow> rows;
  AddRows<float>("float", rays, rows);
  AddRows<double>("double", rays, rows);
  return rows;
}

}  // namespace stipple::raytracer
