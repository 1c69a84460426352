// SPDX-License-Identifier: MIT
#include <fmt/compile.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <ostream>
#include <sstream>

#include "raytracer/errors.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 20;

class NffWriter {
 public:
  NffWriter(const Scene& scene, std::ostream& file)
      : scene_(scene), shapes_(scene.shapes), file_(file) {}

  void Write() {
    WriteHead();
    std::uint32_t material = 0xffffffff;
    for (const Object& object : shapes_.objects) {
      if (object.material != material) WriteFill(scene_.materials[object.material]);
      material = object.material;
      WriteObject(object);
      if (text_.size() >= kFlushBytes) Flush();
    }
    Flush();
  }

 private:
  /// A line of words, numbers and points.
  template <class... Items>
  void Line(const Items&... items) {
    (Put(items), ...);
    text_[text_.size() - 1] = '\n';
  }
  void Put(Vec3 v) { Put(v.x), Put(v.y), Put(v.z); }
  template <class Item>
  void Put(const Item& item) {
    fmt::format_to(fmt::appender(text_), FMT_COMPILE("{} "), item);
  }

  void Flush() {
    file_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  void WriteHead() {
    const View& view = scene_.view;
    Line("v");
    Line("from", view.from);
    Line("at", view.at);
    Line("up", view.up);
    Line("angle", view.angle_deg);
    Line("hither", view.hither);
    Line("resolution", view.resolution.width, view.resolution.height);
    Line("b", scene_.background);
    for (const Light& light : scene_.lights) WriteLight(light);
  }

  void WriteLight(const Light& light) {
    if (light.radius > 0)
      Line("l", light.position, light.color, light.radius);
    else if (light.colored)
      Line("l", light.position, light.color);
    else
      Line("l", light.position);
  }

  void WriteFill(const Material& m) {
    Put("f"), Put(m.color);
    if (m.priority == 0)
      Line(m.diffuse, m.specular, m.shine, m.transmission, m.refraction);
    else
      Line(m.diffuse, m.specular, m.shine, m.transmission, m.refraction, m.priority);
  }

  void WriteObject(const Object& object) {
    switch (object.kind) {
      case ShapeKind::kSphere: {
        const Sphere<double>& s = shapes_.spheres[object.index];
        Line("s", s.center, s.radius);
        break;
      }
      case ShapeKind::kCone: {
        const Cone<double>& c = shapes_.cones[object.index];
        Line("c", c.base, c.base_radius, c.apex, c.apex_radius);
        break;
      }
      case ShapeKind::kTriangle: {
        const Triangle<double>& t = shapes_.triangles[object.index];
        Line(t.first_normal == kNoNormals ? "p" : "pp", 3);
        for (std::uint32_t i = 0; i < 3; ++i)
          WriteVertex({t.corner[i][0], t.corner[i][1], t.corner[i][2]}, t.first_normal, i);
        break;
      }
      case ShapeKind::kPolygon: {
        const Polygon<double>& p = shapes_.polygons[object.index];
        Line(p.first_normal == kNoNormals ? "p" : "pp", p.vertex_count);
        for (std::uint32_t i = 0; i < p.vertex_count; ++i)
          WriteVertex(shapes_.vertices[p.first_vertex + i], p.first_normal, i);
        break;
      }
      case ShapeKind::kPatch:
        Line("bezier");
        for (const Vec3& point : shapes_.patches[object.index].control) Line(point);
        break;
    }
  }

  void WriteVertex(Vec3 vertex, std::uint32_t first_normal, std::uint32_t i) {
    if (first_normal == kNoNormals)
      Line(vertex);
    else
      Line(vertex, shapes_.normals[first_normal + i]);
  }

  const Scene& scene_;
  const Shapes& shapes_;
  std::ostream& file_;
  fmt::memory_buffer text_;
};

}  // namespace

std::string FormatNff(const Scene& scene) {
  std::ostringstream text;
  NffWriter(scene, text).Write();
  return std::move(text).str();
}

void WriteNff(const Scene& scene, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  NffWriter(scene, file).Write();
  file.close();
  if (!file) throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace stipple::raytracer
