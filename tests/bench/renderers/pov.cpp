// SPDX-License-Identifier: MIT
// A scene in POV-Ray's language, so that both renderers draw the same: bench_pov SCENE [SIZE] >
// F.pov
//
// The camera's vectors are given, so POV-Ray's frame is right-handed as ours, and its picture has
// the edges that the corner rays have. Surfaces have what Whitted's model has and nothing else.
#include <fmt/format.h>

#include <cstdlib>
#include <iterator>
#include <string>

#include "raytracer/scene/load.h"

namespace stipple::raytracer {
namespace {

std::string Text(Vec3 v) { return fmt::format("<{}, {}, {}>", v.x, v.y, v.z); }

class PovWriter {
 public:
  explicit PovWriter(const Scene& scene) : scene_(scene) {}

  std::string Format() {
    Line("#version 3.7;");
    Line("global_settings {{ assumed_gamma 1 max_trace_level 5 adc_bailout 0 }}");
    Line("#default {{ finish {{ ambient 0 emission 0 }} }}");
    Line("background {{ rgb {} }}", Text(scene_.background));
    WriteCamera();
    const auto lights = static_cast<double>(scene_.lights.size());
    const double scale = std::sqrt(lights) / (2 * lights);
    for (const Light& light : scene_.lights)
      Line("light_source {{ {} rgb {} }}", Text(light.position), Text(light.color * scale));
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) WriteMaterial(i);
    for (const Object& object : scene_.shapes.objects) WriteObject(object);
    return std::move(text_);
  }

 private:
  template <class... Args>
  void Line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void WriteCamera() {
    const View& view = scene_.view;
    const Vec3 forward = Normalized(view.at - view.from);
    const Vec3 right = Normalized(Cross(forward, view.up));
    const Vec3 up = Cross(right, forward);
    const double height = 2 * std::tan(view.angle_deg * 3.141592653589793 / 360);
    const double width = height * view.resolution.width / view.resolution.height;
    Line("camera {{ location {} direction {} right {} up {} }}", Text(view.from), Text(forward),
         Text(right * width), Text(up * height));
  }

  void WriteMaterial(std::size_t i) {
    const Material& m = scene_.materials[i];
    Line(
        "#declare M{} = texture {{ pigment {{ rgb {} }} finish {{ diffuse {} phong {} "
        "phong_size {} reflection {} }} }}",
        i, Text(m.color), m.diffuse, m.specular, m.shine, m.specular);
  }

  void WriteObject(const Object& object) {
    const Shapes& shapes = scene_.shapes;
    const std::string texture = fmt::format("texture {{ M{} }}", object.material);
    switch (object.kind) {
      case ShapeKind::kSphere: {
        const Sphere<double>& s = shapes.spheres[object.index];
        return Line("sphere {{ {}, {} {} }}", Text(s.center), std::abs(s.radius), texture);
      }
      case ShapeKind::kCone: {
        const Cone<double>& c = shapes.cones[object.index];
        const double base = std::abs(c.base_radius), apex = std::abs(c.apex_radius);
        if (base == apex)
          return Line("cylinder {{ {}, {}, {} open {} }}", Text(c.base), Text(c.apex), base,
                      texture);
        return Line("cone {{ {}, {}, {}, {} open {} }}", Text(c.base), base, Text(c.apex), apex,
                    texture);
      }
      case ShapeKind::kTriangle:
        return WriteTriangle(shapes.triangles[object.index], texture);
      case ShapeKind::kPolygon:
        return WritePolygon(shapes.polygons[object.index], texture);
      case ShapeKind::kPatch:
        fmt::print(stderr, "bench_pov: the scene has patches\n");
        std::exit(2);
    }
  }

  void WriteTriangle(const Triangle<double>& t, const std::string& texture) {
    std::string corners;
    for (std::uint32_t i = 0; i < 3; ++i) {
      corners += (i > 0 ? ", " : "") + Text({t.corner[i][0], t.corner[i][1], t.corner[i][2]});
      if (t.first_normal != kNoNormals)
        corners += ", " + Text(scene_.shapes.normals[t.first_normal + i]);
    }
    Line("{} {{ {} {} }}", t.first_normal != kNoNormals ? "smooth_triangle" : "triangle", corners,
         texture);
  }

  void WritePolygon(const Polygon<double>& p, const std::string& texture) {
    std::string corners;  // the first is repeated: POV-Ray's outlines are closed
    for (std::uint32_t i = 0; i <= p.vertex_count; ++i)
      corners += ", " + Text(scene_.shapes.vertices[p.first_vertex + i % p.vertex_count]);
    Line("polygon {{ {}{} {} }}", p.vertex_count + 1, corners, texture);
  }

  const Scene& scene_;
  std::string text_;
};

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  using namespace stipple::raytracer;
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: bench_pov SCENE [SIZE] > F.pov\n");
    return 2;
  }
  const Scene scene = LoadScene({.scene = argv[1], .size = argc > 2 ? std::atol(argv[2]) : -1});
  fmt::print("{}", PovWriter(scene).Format());
}
