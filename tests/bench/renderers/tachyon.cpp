// SPDX-License-Identifier: MIT
// Tachyon through its library, on one thread: bench_tachyon SCENE SIZE PIXELS [F.ppm] prints the
// CPU seconds of drawing the scene with PIXELS x PIXELS rays, less those of 16 x 16, so that what
// its grid takes to build is not in them.
//
// Its own reader of NFF mirrors the picture and makes every cone a cylinder, hence this one. It
// draws no cones, so scenes with other cones than cylinders end with exit status 3. It cuts rays
// that add less than 1/512: that cannot be switched off.
#include <fmt/format.h>
#include <tachyon.h>

#include <cstdlib>
#include <ctime>
#include <vector>

#include "raytracer/scene/load.h"

namespace stipple::raytracer {
namespace {

constexpr int kNoSuchPrimitive = 3;  // exit status

apivector Vector(Vec3 v) { return rt_vector(v.x, v.y, v.z); }
apicolor Color(Vec3 v) {
  return rt_color(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

[[noreturn]] void Stop(const char* why) {
  fmt::print(stderr, "bench_tachyon: {}\n", why);
  std::exit(kNoSuchPrimitive);
}

void* Texture(SceneHandle handle, const Material& material) {
  apitexture texture{};
  texture.texturefunc = RT_TEXTURE_CONSTANT;
  texture.col = Color(material.color);
  texture.shadowcast = 1;
  texture.diffuse = material.diffuse;
  texture.specular = material.specular;
  texture.opacity = 1;
  void* const made = rt_texture(handle, &texture);
  rt_tex_phong(made, material.specular, material.shine, RT_PHONG_PLASTIC);
  return made;
}

void AddPolygon(SceneHandle handle, void* texture, const Shapes& shapes, const Polygon<double>& p) {
  const Vec3* const corner = &shapes.vertices[p.first_vertex];
  for (std::uint32_t i = 1; i + 1 < p.vertex_count; ++i)  // the scenes' are convex
    rt_tri(handle, texture, Vector(corner[0]), Vector(corner[i]), Vector(corner[i + 1]));
}

void AddTriangle(SceneHandle handle, void* texture, const Shapes& shapes,
                 const Triangle<double>& t) {
  apivector corner[3];
  for (int i = 0; i < 3; ++i) corner[i] = rt_vector(t.corner[i][0], t.corner[i][1], t.corner[i][2]);
  if (t.first_normal == kNoNormals) return rt_tri(handle, texture, corner[0], corner[1], corner[2]);
  const Vec3* const normal = &shapes.normals[t.first_normal];
  rt_stri(handle, texture, corner[0], corner[1], corner[2], Vector(normal[0]), Vector(normal[1]),
          Vector(normal[2]));
}

void AddCone(SceneHandle handle, void* texture, const Cone<double>& c) {
  if (std::abs(c.base_radius - c.apex_radius) > 1e-9 * std::abs(c.base_radius))
    Stop("the scene has cones");
  rt_fcylinder(handle, texture, Vector(c.base), Vector(c.apex - c.base), std::abs(c.base_radius));
}

void AddObject(SceneHandle handle, void* texture, const Shapes& shapes, const Object& object) {
  switch (object.kind) {
    case ShapeKind::kSphere: {
      const Sphere<double>& s = shapes.spheres[object.index];
      return rt_sphere(handle, texture, Vector(s.center), std::abs(s.radius));
    }
    case ShapeKind::kCone:
      return AddCone(handle, texture, shapes.cones[object.index]);
    case ShapeKind::kTriangle:
      return AddTriangle(handle, texture, shapes, shapes.triangles[object.index]);
    case ShapeKind::kPolygon:
      return AddPolygon(handle, texture, shapes, shapes.polygons[object.index]);
    case ShapeKind::kPatch:
      Stop("the scene has patches");
  }
}

void AddCamera(SceneHandle handle, const View& view) {
  const double half = std::tan(view.angle_deg * 3.141592653589793 / 360);
  rt_camera_projection(handle, RT_PROJECTION_PERSPECTIVE);
  rt_camera_position(handle, Vector(view.from), Vector(Normalized(view.at - view.from)),
                     Vector(view.up));
  rt_camera_frustum(handle, half, -half, -half, half);  // its right is our left
  rt_camera_raydepth(handle, 5);
}

void AddLights(SceneHandle handle, const Scene& scene) {
  const auto count = static_cast<double>(scene.lights.size());
  const double scale = std::sqrt(count) / (2 * count);
  for (const Light& light : scene.lights) {
    apitexture texture{};
    texture.col = Color(light.color * scale);
    texture.opacity = 1;
    rt_light(handle, rt_texture(handle, &texture), Vector(light.position), 0.001);
  }
}

double CpuSeconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds of building the grid and drawing.
double Draw(const Scene& scene, int pixels, const char* file) {
  const SceneHandle handle = rt_newscene();
  rt_verbose(handle, 0);
  rt_set_numthreads(handle, 1);
  rt_boundmode(handle, RT_BOUNDING_ENABLED);
  rt_shadermode(handle, RT_SHADER_AUTO);
  rt_phong_shader(handle, RT_SHADER_PHONG);
  rt_resolution(handle, pixels, pixels);
  rt_aspectratio(handle, 1);
  rt_aa_maxsamples(handle, 0);
  rt_image_clamp(handle);
  rt_background(handle, Color(scene.background));
  std::vector<unsigned char> image(static_cast<std::size_t>(pixels) *
                                   static_cast<std::size_t>(pixels) * 3);
  if (file != nullptr) {
    rt_outputfile(handle, file);
    rt_outputformat(handle, RT_FORMAT_PPM);
  } else {
    rt_rawimage_rgb24(handle, image.data());
  }
  AddCamera(handle, scene.view);
  AddLights(handle, scene);
  std::vector<void*> textures;
  for (const Material& material : scene.materials) textures.push_back(Texture(handle, material));
  for (const Object& object : scene.shapes.objects)
    AddObject(handle, textures[object.material], scene.shapes, object);
  const double start = CpuSeconds();
  rt_renderscene(handle);
  const double seconds = CpuSeconds() - start;
  rt_deletescene(handle);
  return seconds;
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  using namespace stipple::raytracer;
  if (argc < 4 || argc > 5) {
    fmt::print(stderr, "usage: bench_tachyon SCENE SIZE PIXELS [F.ppm]\n");
    return 2;
  }
  const Scene scene = LoadScene({.scene = argv[1], .size = std::atol(argv[2])});
  rt_initialize(&argc, &argv);
  const double grid = Draw(scene, 16, nullptr);
  fmt::print("{:.4f}\n", Draw(scene, std::atoi(argv[3]), argc > 4 ? argv[4] : nullptr) - grid);
  rt_finalize();
}
