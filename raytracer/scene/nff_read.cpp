// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "raytracer/errors.h"
#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/nff.h"
#include "raytracer/scene/nff_tokens.h"

namespace stipple::raytracer {
namespace {

constexpr long kMaxResolution = 16384;
constexpr double kThinnest = 1e-12;  // of a polygon's extent: what is thinner has no direction

class NffReader {
 public:
  NffReader(std::string_view text, std::string_view name) : tokens_(text, name) {}

  Scene Read() {
    struct Entity {
      std::string_view token;
      void (NffReader::*read)();
    };
    static constexpr Entity kEntities[] = {
        {"v", &NffReader::ReadView},   {"b", &NffReader::ReadBackground},
        {"l", &NffReader::ReadLight},  {"f", &NffReader::ReadFill},
        {"s", &NffReader::ReadSphere}, {"c", &NffReader::ReadCone},
        {"p", &NffReader::ReadPlain},  {"pp", &NffReader::ReadPatch}};
    while (!tokens_.AtEnd()) {
      entity_line_ = tokens_.line();
      const std::string_view token = tokens_.Take();
      const Entity* known = nullptr;
      for (const Entity& entity : kEntities)
        if (entity.token == token) known = &entity;
      if (known == nullptr)
        tokens_.Fail(entity_line_, fmt::format("unknown entity '{}'; known are v b l f s c p pp",
                                               Printable(token)));
      (this->*known->read)();
    }
    if (!view_seen_) tokens_.Fail("no view: an entity 'v' should say from where the scene is seen");
    return std::move(scene_);
  }

 private:
  static std::string Printable(std::string_view token) {
    std::string shown;
    for (const char c : token.substr(0, 20)) shown += c >= ' ' && c <= '~' ? c : '?';
    return shown;
  }

  void ReadView() {
    View& view = scene_.view;
    std::string missing;
    bool from = false, at = false, up = false, angle = false, resolution = false;
    for (bool more = true; more;) {
      const std::string_view part = tokens_.Peek();
      const auto next = [&](bool& seen) {
        tokens_.Take();
        seen = true;
      };
      bool hither = false;
      if (part == "from") {
        next(from);
        view.from = tokens_.Vector("'from'");
      } else if (part == "at") {
        next(at);
        view.at = tokens_.Vector("'at'");
      } else if (part == "up") {
        next(up);
        view.up = tokens_.Vector("'up'");
      } else if (part == "angle") {
        next(angle);
        view.angle_deg = tokens_.Number("'angle'");
      } else if (part == "hither") {
        next(hither);
        view.hither = tokens_.Number("'hither'");
      } else if (part == "resolution") {
        next(resolution);
        view.resolution.width = static_cast<int>(tokens_.Count("'resolution'", 1, kMaxResolution));
        view.resolution.height = static_cast<int>(tokens_.Count("'resolution'", 1, kMaxResolution));
      } else {
        more = false;
      }
    }
    for (const auto& [seen, name] :
         {std::pair{from, "from"}, std::pair{at, "at"}, std::pair{up, "up"},
          std::pair{angle, "angle"}, std::pair{resolution, "resolution"}})
      if (!seen) missing += fmt::format("{}'{}'", missing.empty() ? "" : ", ", name);
    if (!missing.empty()) FailEntity("the view lacks " + missing);
    CheckView(view);
    view_seen_ = true;
  }

  void CheckView(const View& view) const {
    const Vec3 forward = view.at - view.from;
    if (Dot(forward, forward) == 0) FailEntity("the view's 'from' and 'at' are the same point");
    const double sine =
        Length(Cross(Normalized(forward), view.up)) / std::max(Length(view.up), 1e-300);
    if (!(sine > 1e-9)) FailEntity("the view's 'up' is zero or points along the line of sight");
    if (!(view.angle_deg > 0 && view.angle_deg < 180))
      FailEntity("the view's 'angle' should be above 0 and below 180 degrees");
  }

  void ReadBackground() { scene_.background = tokens_.Vector("the background's colour"); }

  void ReadLight() {
    Light light;
    light.position = tokens_.Vector("the light's position");
    if (tokens_.NumberFollows()) {
      light.color = tokens_.Vector("the light's colour");
      light.colored = true;
    }
    scene_.lights.push_back(light);
  }

  void ReadFill() {
    Material m;
    m.color = tokens_.Vector("the fill's colour");
    m.diffuse = tokens_.Number("the fill's Kd");
    m.specular = tokens_.Number("the fill's Ks");
    m.shine = tokens_.Number("the fill's shine");
    m.transmission = tokens_.Number("the fill's T");
    m.refraction = tokens_.Number("the fill's index of refraction");
    if (m.transmission > 0 && !(m.refraction > 0))
      FailEntity("a fill that lets light through needs an index of refraction above 0");
    scene_.materials.push_back(m);
  }

  void ReadSphere() {
    const Vec3 center = tokens_.Vector("the sphere's centre");
    const double radius = tokens_.Number("the sphere's radius");
    if (radius == 0) FailEntity("sphere of radius 0");
    scene_.shapes.AddSphere(center, radius, CurrentMaterial());
  }

  void ReadCone() {
    const Vec3 base = tokens_.Vector("the cone's base");
    const double base_radius = tokens_.Number("the cone's base radius");
    const Vec3 apex = tokens_.Vector("the cone's apex");
    const double apex_radius = tokens_.Number("the cone's apex radius");
    if (!(Dot(apex - base, apex - base) > 0)) FailEntity("the cone's base and apex coincide");
    if (base_radius == 0 && apex_radius == 0) FailEntity("cone of radius 0 at both ends");
    if (base_radius * apex_radius < 0) FailEntity("the cone's radii have different signs");
    scene_.shapes.AddCone(base, base_radius, apex, apex_radius, CurrentMaterial());
  }

  void ReadPlain() { ReadPolygon(false); }
  void ReadPatch() { ReadPolygon(true); }

  void ReadPolygon(bool with_normals) {
    const long line = tokens_.line();
    const long count = tokens_.Count("the polygon's number of vertices", 3, 1L << 28);
    const auto numbers = static_cast<std::size_t>(count) * (with_normals ? 6 : 3);
    if (numbers > tokens_.NumbersLeftAtMost())
      tokens_.Fail(line, fmt::format("polygon of {} vertices, but the rest of the file is too "
                                     "short for them",
                                     count));
    vertices_.clear();
    normals_.clear();
    for (long i = 0; i < count; ++i) {
      vertices_.push_back(tokens_.Vector("the polygon's vertex"));
      if (with_normals) normals_.push_back(ReadNormal());
    }
    CheckArea();
    scene_.shapes.AddPolygon(vertices_, normals_, CurrentMaterial());
  }

  Vec3 ReadNormal() {
    const long line = tokens_.line();
    const Vec3 normal = tokens_.Vector("the polygon's normal");
    if (!(Dot(normal, normal) > 0)) tokens_.Fail(line, "normal of length 0");
    // One that is of unit length but for its six digits stays as it is: a file survives reading and
    // writing.
    return std::abs(Length(normal) - 1) < 1e-5 ? normal : Normalized(normal);
  }

  void CheckArea() const {
    double extent = 0;
    for (const Vec3& vertex : vertices_) extent = std::max(extent, MaxNorm(vertex - vertices_[0]));
    if (!(Length(NewellNormal(vertices_)) > kThinnest * extent * extent))
      FailEntity("polygon of zero area");
  }

  std::uint32_t CurrentMaterial() {
    if (scene_.materials.empty()) scene_.materials.push_back({});
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }

  [[noreturn]] void FailEntity(std::string_view problem) const {
    tokens_.Fail(entity_line_, problem);
  }

  NffTokens tokens_;
  long entity_line_ = 1;
  Scene scene_;
  bool view_seen_ = false;
  std::vector<Vec3> vertices_, normals_;
};

}  // namespace

Scene ParseNff(std::string_view text, std::string_view name) {
  return NffReader(text, name).Read();
}

Scene ReadNff(const std::string& path) { return ParseNff(ReadFile(path), path); }

View ReadNffView(const std::string& path) { return ReadNff(path).view; }

}  // namespace stipple::raytracer
