// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "raytracer/errors.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

class NffWriter {
 public:
  explicit NffWriter(const Scene& scene) : scene_(scene), shapes_(scene.shapes) {}

  std::string Format() {
    WriteHead();
    std::uint32_t material = 0xffffffff;
    for (const Object& object : shapes_.objects) {
      if (object.material != material) WriteFill(scene_.materials[object.material]);
      material = object.material;
      WriteObject(object);
    }
    return std::move(text_);
  }

 private:
  template <class... Args>
  void Line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  static std::string Text(Vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

  void WriteHead() {
    const View& view = scene_.view;
    Line("v");
    Line("from {}", Text(view.from));
    Line("at {}", Text(view.at));
    Line("up {}", Text(view.up));
    Line("angle {}", view.angle_deg);
    Line("hither {}", view.hither);
    Line("resolution {} {}", view.resolution.width, view.resolution.height);
    Line("b {}", Text(scene_.background));
    for (const Light& light : scene_.lights)
      Line("l {}{}", Text(light.position),
           light.colored ? fmt::format(" {}", Text(light.color)) : "");
  }

  void WriteFill(const Material& m) {
    Line("f {} {} {} {} {} {}", Text(m.color), m.diffuse, m.specular, m.shine, m.transmission,
         m.refraction);
  }

  void WriteObject(const Object& object) {
    switch (object.kind) {
      case ShapeKind::kSphere: {
        const Sphere<double>& s = shapes_.spheres[object.index];
        Line("s {} {}", Text(s.center), s.radius);
        break;
      }
      case ShapeKind::kCone: {
        const Cone<double>& c = shapes_.cones[object.index];
        Line("c {} {} {} {}", Text(c.base), c.base_radius, Text(c.apex), c.apex_radius);
        break;
      }
      case ShapeKind::kTriangle: {
        const Triangle<double>& t = shapes_.triangles[object.index];
        Line("{} 3", t.first_normal == kNoNormals ? "p" : "pp");
        for (std::uint32_t i = 0; i < 3; ++i)
          WriteVertex({t.corner[i][0], t.corner[i][1], t.corner[i][2]}, t.first_normal, i);
        break;
      }
      case ShapeKind::kPolygon: {
        const Polygon<double>& p = shapes_.polygons[object.index];
        Line("{} {}", p.first_normal == kNoNormals ? "p" : "pp", p.vertex_count);
        for (std::uint32_t i = 0; i < p.vertex_count; ++i)
          WriteVertex(shapes_.vertices[p.first_vertex + i], p.first_normal, i);
        break;
      }
      case ShapeKind::kPatch:
        Line("bezier");
        for (const Vec3& point : shapes_.patches[object.index].control) Line("{}", Text(point));
        break;
    }
  }

  void WriteVertex(Vec3 vertex, std::uint32_t first_normal, std::uint32_t i) {
    if (first_normal == kNoNormals)
      Line("{}", Text(vertex));
    else
      Line("{} {}", Text(vertex), Text(shapes_.normals[first_normal + i]));
  }

  const Scene& scene_;
  const Shapes& shapes_;
  std::string text_;
};

}  // namespace

std::string FormatNff(const Scene& scene) { return NffWriter(scene).Format(); }

void WriteNff(const Scene& scene, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << FormatNff(scene);
  file.close();
  if (!file) throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace stipple::raytracer
