// SPDX-License-Identifier: MIT
// Each kind of shape is one Embree geometry, in what Embree knows best: spheres as sphere points,
// cones as linear curves without caps, triangles, and polygons of four convex corners as quads.
// Other polygons and patches are user geometry: Embree calls back for them, one ray and one
// primitive at a time.
#include "raytracer/geometry/embree_kernel.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "raytracer/errors.h"
#include "raytracer/geometry/patch.h"

namespace stipple::raytracer {
namespace {

/// Embree leaves out whatever reaches farther than this (its FLT_LARGE).
constexpr double kFarthest = 1.8e18;

[[noreturn]] void Refuse(const std::string& problem) {
  throw UsageError("--kernel embree: " + problem);
}

/// Releases Embree's reference-counted objects.
struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Numbers of the geometries in the scene.
enum GeometryNumber : unsigned {
  kSpheres,
  kCones,
  kTriangles,
  kQuads,
  kPolygons,
  kPatches,
  kGeometries
};

/// The ray as it was asked, for callbacks: they compute in the model's kind of number.
template <class Real>
struct Context {
  RTCIntersectContext embree;  // first: callbacks are handed a pointer to it
  const Ray<Real>* ray;

  explicit Context(const Ray<Real>& asked) : ray(&asked) { rtcInitIntersectContext(&embree); }
};

template <class Real>
RTCRay EmbreeRay(const Ray<Real>& ray, Real max_t) {
  const auto number = [](Real x) { return static_cast<float>(x); };
  RTCRay made;
  made.org_x = number(ray.origin.x);
  made.org_y = number(ray.origin.y);
  made.org_z = number(ray.origin.z);
  made.tnear = 0;
  made.dir_x = number(ray.direction.x);
  made.dir_y = number(ray.direction.y);
  made.dir_z = number(ray.direction.z);
  made.time = 0;
  made.tfar = number(max_t);
  made.mask = ~0U;
  made.id = 0;
  made.flags = 0;
  return made;
}

/// Bounds in float, rounded outwards.
void SetBounds(const Bounds& box, RTCBounds& bounds) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const auto below = [](double x) { return std::nextafter(static_cast<float>(x), -kFar); };
  const auto above = [](double x) { return std::nextafter(static_cast<float>(x), kFar); };
  bounds.lower_x = below(box.low.x);
  bounds.lower_y = below(box.low.y);
  bounds.lower_z = below(box.low.z);
  bounds.upper_x = above(box.high.x);
  bounds.upper_y = above(box.high.y);
  bounds.upper_z = above(box.high.z);
}

/// `rtcNewDevice` on one thread: ranks share a node's cores, and builds are compared by CPU time.
Owned<RTCDevice> NewDevice() {
  Owned<RTCDevice> device(rtcNewDevice("threads=1,set_affinity=0"));
  if (device == nullptr)
    Refuse("Embree cannot start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  return device;
}

template <class Real>
class EmbreeKernel final : public Kernel<Real> {
 public:
  explicit EmbreeKernel(const Model<Real>& model)
      : model_(model), device_(NewDevice()), scene_(rtcNewScene(device_.get())) {
    rtcSetDeviceErrorFunction(device_.get(), KeepMessage, &error_);
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
    SortObjects();
    AddSpheres();
    AddCones();
    AddTriangles();
    AddQuads();
    AddOwn<kPolygons>();
    AddOwn<kPatches>();
    rtcCommitScene(scene_.get());
    if (!error_.empty()) Refuse(error_);
    rtcSetDeviceErrorFunction(device_.get(), nullptr, nullptr);
  }

  [[gnu::noinline]] Hit<Real> Intersect(const Ray<Real>& ray, TestCounts&) const override {
    return IntersectWithin(ray, std::numeric_limits<Real>::infinity());
  }

  [[gnu::noinline]] Hit<Real> IntersectAgain(const Ray<Real>& ray, Real farthest, TestCounts&,
                                             Repeats&) const override {
    // What is exactly so far counts, too.
    constexpr float kForever = std::numeric_limits<float>::infinity();
    const float reach = std::nextafter(static_cast<float>(farthest), kForever);
    return IntersectWithin(ray, static_cast<Real>(reach));
  }

  [[gnu::noinline]] bool Occluded(const Ray<Real>& ray, Real max_t, TestCounts&) const override {
    Context<Real> context(ray);
    RTCRay asked = EmbreeRay(ray, max_t);
    rtcOccluded1(scene_.get(), &context.embree, &asked);
    return asked.tfar < 0;  // minus infinity: found
  }

  Real Rounding() const override { return std::numeric_limits<float>::epsilon(); }

  RTCScene scene() const { return scene_.get(); }
  bool HasUserGeometry() const {
    return !objects_[kPolygons].empty() || !objects_[kPatches].empty();
  }

  /// What Embree found, in our words.
  Hit<Real> HitOf(float t, unsigned geometry, unsigned primitive, float u, float v) const {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return {};
    return {t, objects_[geometry][primitive], u, v};
  }

 private:
  Hit<Real> IntersectWithin(const Ray<Real>& ray, Real farthest) const {
    Context<Real> context(ray);
    RTCRayHit found;
    found.ray = EmbreeRay(ray, farthest);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context.embree, &found);
    const RTCHit& hit = found.hit;
    return HitOf(found.ray.tfar, hit.geomID, hit.primID, hit.u, hit.v);
  }

  static void KeepMessage(void* kept, RTCError, const char* text) {
    auto& message = *static_cast<std::string*>(kept);
    if (message.empty()) message = text;
  }

  /// Object numbers by geometry; an object's position in its list is its primitive number.
  void SortObjects() {
    for (std::uint32_t number = 0; number < model_.objects.size(); ++number)
      objects_[GeometryOf(model_.objects[number])].push_back(number);
  }

  GeometryNumber GeometryOf(const Object& object) const {
    switch (object.kind) {
      case ShapeKind::kSphere:
        return kSpheres;
      case ShapeKind::kCone:
        return kCones;
      case ShapeKind::kTriangle:
        return kTriangles;
      case ShapeKind::kPolygon:
        return IsConvexQuad(model_.PolygonAt(object.index)) ? kQuads : kPolygons;
      case ShapeKind::kPatch:
        break;
    }
    return kPatches;
  }

  bool IsConvexQuad(const Polygon<Real>& polygon) const {
    if (polygon.vertex_count != 4) return false;
    const auto vertex = [&](std::uint32_t i) {
      return model_.vertices[polygon.first_vertex + i % 4];
    };
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec<Real> corner = Cross(vertex(i + 1) - vertex(i), vertex(i + 2) - vertex(i + 1));
      if (!(Dot(corner, polygon.normal) > 0)) return false;
    }
    return true;
  }

  /// Where the model holds the primitive `i` of a geometry.
  std::uint32_t SlotOf(GeometryNumber geometry, std::size_t i) const {
    return model_.objects[objects_[geometry][i]].index;
  }

  Owned<RTCGeometry> NewGeometry(RTCGeometryType type) const {
    Owned<RTCGeometry> geometry(rtcNewGeometry(device_.get(), type));
    if (geometry == nullptr) Refuse(error_);
    return geometry;
  }

  void Attach(const Owned<RTCGeometry>& geometry, GeometryNumber number) const {
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene_.get(), geometry.get(), number);
  }

  template <class Element>
  Element* NewBuffer(const Owned<RTCGeometry>& geometry, RTCBufferType type, RTCFormat format,
                     std::size_t count) const {
    void* const buffer =
        rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, sizeof(Element), count);
    if (buffer == nullptr) Refuse(error_);
    return static_cast<Element*>(buffer);
  }

  /// A coordinate or radius as Embree keeps it.
  static float Stored(Real number) {
    if (!(std::abs(number) < kFarthest)) Refuse("an object lies farther out than Embree can hold");
    return static_cast<float>(number);
  }

  using Point = std::array<float, 3>;
  using Ball = std::array<float, 4>;  // centre, radius
  static Point StoredPoint(Vec<Real> p) { return {Stored(p.x), Stored(p.y), Stored(p.z)}; }
  static Ball StoredBall(Vec<Real> p, Real radius) {
    return {Stored(p.x), Stored(p.y), Stored(p.z), std::abs(Stored(radius))};
  }

  void AddSpheres() {
    const std::size_t count = objects_[kSpheres].size();
    if (count == 0) return;
    const auto geometry = NewGeometry(RTC_GEOMETRY_TYPE_SPHERE_POINT);
    Ball* const balls = NewBuffer<Ball>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, count);
    for (std::size_t i = 0; i < count; ++i) {
      const Sphere<Real> sphere = model_.SphereAt(SlotOf(kSpheres, i));
      balls[i] = StoredBall(sphere.center, sphere.radius);
    }
    Attach(geometry, kSpheres);
  }

  /// A segment that claims to have neighbours at both ends has no caps there.
  void AddCones() {
    const std::size_t count = objects_[kCones].size();
    if (count == 0) return;
    const auto geometry = NewGeometry(RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
    Ball* const ends =
        NewBuffer<Ball>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 2 * count);
    auto* const first_ends =
        NewBuffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, count);
    auto* const flags =
        NewBuffer<std::uint8_t>(geometry, RTC_BUFFER_TYPE_FLAGS, RTC_FORMAT_UCHAR, count);
    for (std::size_t i = 0; i < count; ++i) {
      const Cone<Real> cone = model_.ConeAt(SlotOf(kCones, i));
      ends[2 * i] = StoredBall(cone.base, cone.base_radius);
      ends[2 * i + 1] = StoredBall(cone.apex, cone.apex_radius);
      first_ends[i] = static_cast<std::uint32_t>(2 * i);
      flags[i] = RTC_CURVE_FLAG_NEIGHBOR_LEFT | RTC_CURVE_FLAG_NEIGHBOR_RIGHT;
    }
    Attach(geometry, kCones);
  }

  /// Makes room for the corners of all faces and numbers them in order.
  Point* NewCorners(const Owned<RTCGeometry>& geometry, RTCFormat face_format, std::size_t faces,
                    std::size_t corners_of_one) const {
    const std::size_t count = faces * corners_of_one;
    void* const indices =
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, face_format,
                                corners_of_one * sizeof(std::uint32_t), faces);
    if (indices == nullptr) Refuse(error_);
    for (std::uint32_t i = 0; i < count; ++i) static_cast<std::uint32_t*>(indices)[i] = i;
    return NewBuffer<Point>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, count);
  }

  void AddTriangles() {
    const std::size_t count = objects_[kTriangles].size();
    if (count == 0) return;
    const auto geometry = NewGeometry(RTC_GEOMETRY_TYPE_TRIANGLE);
    Point* const corners = NewCorners(geometry, RTC_FORMAT_UINT3, count, 3);
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle<Real> triangle = model_.TriangleAt(SlotOf(kTriangles, i));
      for (std::size_t j = 0; j < 3; ++j) {
        const Real(&c)[3] = triangle.corner[j];
        corners[3 * i + j] = StoredPoint({c[0], c[1], c[2]});
      }
    }
    Attach(geometry, kTriangles);
  }

  void AddQuads() {
    const std::size_t count = objects_[kQuads].size();
    if (count == 0) return;
    const auto geometry = NewGeometry(RTC_GEOMETRY_TYPE_QUAD);
    Point* const corners = NewCorners(geometry, RTC_FORMAT_UINT4, count, 4);
    for (std::size_t i = 0; i < count; ++i) {
      const Polygon<Real> polygon = model_.PolygonAt(SlotOf(kQuads, i));
      for (std::size_t j = 0; j < 4; ++j)
        corners[4 * i + j] = StoredPoint(model_.vertices[polygon.first_vertex + j]);
    }
    Attach(geometry, kQuads);
  }

  /// Shapes that Embree asks us about.
  template <GeometryNumber kNumber>
  void AddOwn() {
    const std::size_t count = objects_[kNumber].size();
    if (count == 0) return;
    const auto geometry = NewGeometry(RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry.get(), this);
    rtcSetGeometryBoundsFunction(geometry.get(), BoundsCallback<kNumber>, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), IntersectCallback<kNumber>);
    rtcSetGeometryOccludedFunction(geometry.get(), OccludedCallback<kNumber>);
    Attach(geometry, kNumber);
  }

  /// The points whose hull holds the shape.
  template <GeometryNumber kNumber>
  std::span<const Vec<Real>> HullOf(std::uint32_t primitive) const {
    if constexpr (kNumber == kPatches) return model_.patches[SlotOf(kPatches, primitive)].control;
    const Polygon<Real> polygon = model_.PolygonAt(SlotOf(kPolygons, primitive));
    return {model_.vertices.data() + polygon.first_vertex, polygon.vertex_count};
  }

  template <GeometryNumber kNumber>
  PatchHit<Real> Meet(std::uint32_t primitive, const Ray<Real>& ray, float max_t) const {
    if constexpr (kNumber == kPatches)
      return IntersectPatch(model_.patches[SlotOf(kPatches, primitive)], ray, Real{max_t});
    const Polygon<Real> polygon = model_.PolygonAt(SlotOf(kPolygons, primitive));
    return {IntersectPolygon(polygon, model_.OutlineOf(polygon), ray), 0, 0};
  }

  template <GeometryNumber kNumber>
  static void BoundsCallback(const RTCBoundsFunctionArguments* arguments) {
    const auto& kernel = *static_cast<const EmbreeKernel*>(arguments->geometryUserPtr);
    Bounds box;
    for (const Vec<Real>& p : kernel.template HullOf<kNumber>(arguments->primID))
      box.Include(
          Vec3{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    SetBounds(box, *arguments->bounds_o);
  }

  /// Both kinds of question: where the asked ray meets the shape.
  template <GeometryNumber kNumber, class Arguments>
  static PatchHit<Real> Meet(const Arguments* arguments, float max_t) {
    const auto& kernel = *static_cast<const EmbreeKernel*>(arguments->geometryUserPtr);
    const Ray<Real>& ray = *reinterpret_cast<const Context<Real>*>(arguments->context)->ray;
    return kernel.template Meet<kNumber>(arguments->primID, ray, max_t);
  }

  template <GeometryNumber kNumber>
  static void IntersectCallback(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    auto& found = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);  // N is 1
    const PatchHit<Real> hit = Meet<kNumber>(arguments, found.ray.tfar);
    if (!(static_cast<float>(hit.t) < found.ray.tfar)) return;
    found.ray.tfar = static_cast<float>(hit.t);
    found.hit.geomID = arguments->geomID;
    found.hit.primID = arguments->primID;
    found.hit.u = static_cast<float>(hit.u);
    found.hit.v = static_cast<float>(hit.v);
  }

  template <GeometryNumber kNumber>
  static void OccludedCallback(const RTCOccludedFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);  // N is 1
    if (static_cast<float>(Meet<kNumber>(arguments, ray.tfar).t) < ray.tfar)
      ray.tfar = -std::numeric_limits<float>::infinity();
  }

  const Model<Real>& model_;
  std::string error_;  // Embree's first complaint during the build
  Owned<RTCDevice> device_;
  Owned<RTCScene> scene_;
  std::array<std::vector<std::uint32_t>, kGeometries> objects_;
};

/// Embree's types and questions for packets of a width.
struct Eight {
  static constexpr unsigned kWidth = 8;
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static constexpr auto kIntersect = rtcIntersect8;
  static constexpr auto kOccluded = rtcOccluded8;
};
struct Sixteen {
  static constexpr unsigned kWidth = 16;
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static constexpr auto kIntersect = rtcIntersect16;
  static constexpr auto kOccluded = rtcOccluded16;
};

template <class Packet>
class PacketsOf final : public EmbreePackets {
 public:
  PacketsOf(const Model<double>& model, bool coherent) : kernel_(model), coherent_(coherent) {
    if (kernel_.HasUserGeometry()) Refuse("no packets of rays with polygons or patches");
  }

  void Intersect(std::span<const Ray<double>> rays, std::span<Hit<double>> hits) const override {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    RTCIntersectContext context = NewContext();
    for (std::size_t begin = 0; begin < rays.size(); begin += kWidth) {
      const auto asked = rays.subspan(begin, std::min<std::size_t>(kWidth, rays.size() - begin));
      alignas(64) typename Packet::RayHits found;
      Valid valid{};
      for (unsigned lane = 0; lane < asked.size(); ++lane) {
        SetLane(found.ray, lane, asked[lane], kEndless, valid);
        found.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        found.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
      }
      Packet::kIntersect(valid.lanes, kernel_.scene(), &context, &found);
      for (unsigned i = 0; i < asked.size(); ++i)
        hits[begin + i] = kernel_.HitOf(found.ray.tfar[i], found.hit.geomID[i], found.hit.primID[i],
                                        found.hit.u[i], found.hit.v[i]);
    }
  }

  void Occluded(std::span<const Ray<double>> rays, std::span<const double> max_t,
                std::span<std::uint8_t> hidden) const override {
    RTCIntersectContext context = NewContext();
    for (std::size_t begin = 0; begin < rays.size(); begin += kWidth) {
      const auto asked = rays.subspan(begin, std::min<std::size_t>(kWidth, rays.size() - begin));
      alignas(64) typename Packet::Rays packet;
      Valid valid{};
      for (unsigned lane = 0; lane < asked.size(); ++lane)
        SetLane(packet, lane, asked[lane], max_t[begin + lane], valid);
      Packet::kOccluded(valid.lanes, kernel_.scene(), &context, &packet);
      for (unsigned i = 0; i < asked.size(); ++i) hidden[begin + i] = packet.tfar[i] < 0 ? 1 : 0;
    }
  }

 private:
  static constexpr unsigned kWidth = Packet::kWidth;

  /// -1 for lanes that hold a ray, 0 for those of the last packet that do not.
  struct alignas(64) Valid {
    int lanes[kWidth];
  };

  RTCIntersectContext NewContext() const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent_) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
  }

  static void SetLane(typename Packet::Rays& packet, unsigned lane, const Ray<double>& ray,
                      double max_t, Valid& valid) {
    const RTCRay one = EmbreeRay(ray, max_t);
    packet.org_x[lane] = one.org_x;
    packet.org_y[lane] = one.org_y;
    packet.org_z[lane] = one.org_z;
    packet.tnear[lane] = one.tnear;
    packet.dir_x[lane] = one.dir_x;
    packet.dir_y[lane] = one.dir_y;
    packet.dir_z[lane] = one.dir_z;
    packet.time[lane] = one.time;
    packet.tfar[lane] = one.tfar;
    packet.mask[lane] = one.mask;
    packet.id[lane] = one.id;
    packet.flags[lane] = one.flags;
    valid.lanes[lane] = -1;
  }

  EmbreeKernel<double> kernel_;
  bool coherent_;
};

}  // namespace

template <class Real>
std::unique_ptr<Kernel<Real>> MakeEmbreeKernel(const Model<Real>& model) {
  return std::make_unique<EmbreeKernel<Real>>(model);
}

std::unique_ptr<EmbreePackets> MakeEmbreePackets(const Model<double>& model, int width,
                                                 bool coherent) {
  if (width == 8) return std::make_unique<PacketsOf<Eight>>(model, coherent);
  if (width == 16) return std::make_unique<PacketsOf<Sixteen>>(model, coherent);
  Refuse("no packets of " + std::to_string(width) + " rays");
}

template std::unique_ptr<Kernel<float>> MakeEmbreeKernel(const Model<float>&);
template std::unique_ptr<Kernel<double>> MakeEmbreeKernel(const Model<double>&);

}  // namespace stipple::raytracer
