// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <unordered_map>

#include "raytracer/errors.h"
#include "raytracer/scene/check.h"
#include "raytracer/scene/file_bytes.h"
#include "raytracer/scene/nff.h"
#include "raytracer/scene/nff_tokens.h"

namespace stipple::raytracer {
namespace {

constexpr long kMaxResolution = 16384;
constexpr long kMostVertices = 1L << 28;
constexpr long kHighestPriority = 1000;

struct MaterialHash {
  std::size_t operator()(const Material& m) const {
    std::size_t hash = static_cast<std::size_t>(m.priority);
    for (const double value : {m.color.x, m.color.y, m.color.z, m.diffuse, m.specular, m.shine,
                               m.transmission, m.refraction})
      hash = hash * 31 + std::hash<double>()(value);
    return hash;
  }
};

class NffReader {
 public:
  /// `take` gets the objects while they are read; what it leaves is in the scene.
  NffReader(Text& text, std::string_view name, const TakeShapes& take)
      : tokens_(text, name), shapes_(scene_.shapes, take) {}

  Scene Read() {
    while (!tokens_.AtEnd()) ReadEntity();
    if (view_line_ == 0) FailWithoutView();
    return std::move(scene_);
  }

  View ReadUpToView() {
    while (!tokens_.AtEnd() && view_line_ == 0) ReadEntity();
    if (view_line_ == 0) FailWithoutView();
    return scene_.view;
  }

 private:
  struct Entity {
    std::string_view token;
    void (NffReader::*read)();
  };

  void ReadEntity() {
    static constexpr Entity kEntities[] = {
        {"s", &NffReader::ReadSphere}, {"c", &NffReader::ReadCone},
        {"p", &NffReader::ReadPlain},  {"pp", &NffReader::ReadWithNormals},
        {"f", &NffReader::ReadFill},   {"bezier", &NffReader::ReadPatch},
        {"v", &NffReader::ReadView},   {"b", &NffReader::ReadBackground},
        {"l", &NffReader::ReadLight}};
    entity_line_ = tokens_.line();
    const std::string_view token = tokens_.Peek();
    for (const Entity& entity : kEntities) {
      if (entity.token != token) continue;
      tokens_.Take();
      return (this->*entity.read)();
    }
    FailEntity(fmt::format("unknown entity '{}'; known are v b l f s c p pp bezier", Shown(token)));
  }

  void ReadView() {
    if (view_line_ > 0)
      FailEntity(fmt::format("a second view; the first stands in line {}", view_line_));
    struct Part {
      std::string_view name;
      bool seen = false;
    };
    Part parts[] = {{"from"}, {"at"}, {"up"}, {"angle"}, {"resolution"}};
    for (std::string part(tokens_.Peek()); ReadViewPart(part); part = tokens_.Peek())
      for (Part& needed : parts) needed.seen = needed.seen || needed.name == part;
    std::string missing;
    for (const Part& part : parts)
      if (!part.seen) missing += fmt::format("{}'{}'", missing.empty() ? "" : ", ", part.name);
    if (!missing.empty()) FailEntity("the view lacks " + missing);
    Check(ProblemOf(scene_.view));
    view_line_ = entity_line_;
  }

  /// False if the token is no part of a view.
  bool ReadViewPart(std::string_view part) {
    View& view = scene_.view;
    const auto size = [&] {
      return static_cast<int>(tokens_.Count("'resolution'", 1, kMaxResolution));
    };
    const auto is = [&](std::string_view name) { return part == name && (tokens_.Take(), true); };
    if (is("from"))
      view.from = tokens_.Vector("'from'");
    else if (is("at"))
      view.at = tokens_.Vector("'at'");
    else if (is("up"))
      view.up = tokens_.Vector("'up'");
    else if (is("angle"))
      view.angle_deg = tokens_.Number("'angle'");
    else if (is("hither"))
      view.hither = tokens_.Number("'hither'");
    else if (is("resolution"))
      view.resolution.width = size(), view.resolution.height = size();
    else
      return false;
    return true;
  }

  void ReadBackground() {
    if (background_line_ > 0)
      FailEntity(fmt::format("a second background; the first stands in line {}", background_line_));
    background_line_ = entity_line_;
    scene_.background = tokens_.Vector("the background's colour");
    if (!ProblemOf(Light{{}, scene_.background}).empty())
      FailEntity("the background's colour should be from 0 to 1000");
  }

  void ReadLight() {
    Light light;
    light.position = tokens_.Vector("the light's position");
    if (tokens_.NumberFollows()) {
      light.color = tokens_.Vector("the light's colour");
      light.colored = true;
      if (tokens_.NumberFollows()) light.radius = tokens_.Number("the light's radius");
    }
    Check(ProblemOf(light));
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
    if (tokens_.NumberFollows())
      m.priority = static_cast<int>(tokens_.Count("the fill's priority", 0, kHighestPriority));
    Check(ProblemOf(m));
    UseMaterial(m);
  }

  void ReadSphere() {
    const Vec3 center = tokens_.Vector("the sphere's centre");
    const double radius = tokens_.Number("the sphere's radius");
    Check(ProblemOfSphere(center, radius));
    shapes_.AddSphere(center, radius, CurrentMaterial());
  }

  void ReadCone() {
    const Vec3 base = tokens_.Vector("the cone's base");
    const double base_radius = tokens_.Number("the cone's base radius");
    const Vec3 apex = tokens_.Vector("the cone's apex");
    const double apex_radius = tokens_.Number("the cone's apex radius");
    Check(ProblemOfCone(base, base_radius, apex, apex_radius));
    shapes_.AddCone(base, base_radius, apex, apex_radius, CurrentMaterial());
  }

  void ReadPlain() { ReadPolygon(false); }
  void ReadWithNormals() { ReadPolygon(true); }

  void ReadPolygon(bool with_normals) {
    const long line = tokens_.line();
    const long count = tokens_.Count("the polygon's number of vertices", 3, kMostVertices);
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
    Check(ProblemOfPolygon(vertices_));
    shapes_.AddPolygon(vertices_, normals_, CurrentMaterial());
  }

  Vec3 ReadNormal() {
    const long line = tokens_.line();
    const Vec3 normal = tokens_.Vector("the polygon's normal");
    if (!(Dot(normal, normal) > 0)) tokens_.Fail(line, "normal of length 0");
    // One that is of unit length but for its six digits stays as it is: a file survives reading and
    // writing.
    return std::abs(Length(normal) - 1) < 1e-5 ? normal : Normalized(normal);
  }

  void ReadPatch() {
    std::array<Vec3, 16> control;
    for (Vec3& point : control) point = tokens_.Vector("the patch's control point");
    Check(ProblemOfPatch(control));
    shapes_.AddPatch(control, CurrentMaterial());
  }

  /// Files that repeat a fill before each object have as many materials as differ.
  void UseMaterial(const Material& material) {
    const auto next = static_cast<std::uint32_t>(scene_.materials.size());
    const auto [place, is_new] = numbers_.try_emplace(material, next);
    if (is_new) scene_.materials.push_back(material);
    material_ = place->second;
  }

  std::uint32_t CurrentMaterial() {
    if (scene_.materials.empty()) UseMaterial({});
    return material_;
  }

  void Check(std::string_view problem) const {
    if (!problem.empty()) FailEntity(problem);
  }
  [[noreturn]] void FailEntity(std::string_view problem) const {
    tokens_.Fail(entity_line_, problem);
  }
  [[noreturn]] void FailWithoutView() const {
    tokens_.Fail("no view: an entity 'v' should say from where the scene is seen");
  }

  NffTokens tokens_;
  long entity_line_ = 1;
  long view_line_ = 0, background_line_ = 0;  // 0: none yet
  Scene scene_;
  ShapeStream shapes_;
  std::unordered_map<Material, std::uint32_t, MaterialHash> numbers_;
  std::uint32_t material_ = 0;  // of the objects that follow
  std::vector<Vec3> vertices_, normals_;
};

}  // namespace

Scene ReadNff(Text& text, std::string_view name, const TakeShapes& take) {
  return NffReader(text, name, take).Read();
}

Scene ParseNff(std::string_view text, std::string_view name) {
  Text all = Text::InMemory(text);
  return ReadNff(all, name, {});
}

Scene ReadNff(const std::string& path) {
  Text text = Text::OfFile(path);
  return ReadNff(text, path, {});
}

View ReadNffView(const std::string& path) {
  Text text = Text::OfFile(path);
  return NffReader(text, path, {}).ReadUpToView();
}

}  // namespace stipple::raytracer
