// SPDX-License-Identifier: MIT
#include "raytracer/render/ray_package.h"

#include <array>

namespace stipple::raytracer {
namespace {

enum Flag : std::uint8_t {
  kToLight = 1,
  kFirst = 2,
  kFromEye = 4,  // point and number stand for the line
  kMet = 8,      // an object, so far
  kSmooth = 16,  // whose normals differ
  kInMedia = 32,
  kPassed = 64
};

// A component of a colour has less than 43 bits and a sign: see kBrightest.
constexpr std::size_t kColorBytes = 6;
static_assert(kBrightest * static_cast<double>(kFixedOne) < 0x1p47);

/// Writes where there is room for a ray.
class Writer {
 public:
  explicit Writer(std::byte* place) : next_(place) {}

  template <class Thing>
  void Put(const Thing& thing) {
    std::memcpy(next_, &thing, sizeof thing);
    next_ += sizeof thing;
  }
  void PutColor(std::int64_t color) {
    std::memcpy(next_, &color, kColorBytes);
    next_ += kColorBytes;
  }
  void PutPassed(const PassedRanks& passed) {
    Put(static_cast<std::uint8_t>(passed.ranks().size()));
    for (const std::uint16_t rank : passed.ranks()) Put(rank);
  }
  std::byte* end() const { return next_; }

 private:
  std::byte* next_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : next_(bytes.data()) {}

  template <class Thing>
  Thing Take() {
    Thing thing;
    std::memcpy(&thing, next_, sizeof thing);
    next_ += sizeof thing;
    return thing;
  }
  std::int64_t TakeColor() {
    std::uint64_t bits = 0;
    std::memcpy(&bits, next_, kColorBytes);
    next_ += kColorBytes;
    constexpr unsigned kAbove = 64 - 8 * kColorBytes;
    return static_cast<std::int64_t>(bits << kAbove) >> kAbove;  // with its sign
  }
  void TakePassed(PassedRanks& passed) {
    for (auto left = Take<std::uint8_t>(); left > 0; --left) passed.Add(Take<std::uint16_t>());
  }

 private:
  const std::byte* next_;
};

template <class Real>
std::uint8_t FlagsOf(const Traveller<Real>& ray) {
  const bool met = !ray.to_light && ray.object != kNoObject;
  const Vec<Real>&face = ray.normals.face, &shading = ray.normals.shading;
  const bool smooth = std::memcmp(&face, &shading, sizeof face) != 0;
  return static_cast<std::uint8_t>(
      (ray.to_light ? kToLight : 0) | (ray.first ? kFirst : 0) | (ray.eye_ray != 0 ? kFromEye : 0) |
      (met ? kMet : 0) | (met && smooth ? kSmooth : 0) | (ray.media.count != 0 ? kInMedia : 0) |
      (ray.passed.ranks().empty() ? 0 : kPassed));
}

template <class Real>
void TakeMet(Reader& from, bool smooth, Traveller<Real>& ray) {
  ray.t = from.Take<Real>();
  ray.object = from.Take<std::uint32_t>();
  ray.material = from.Take<std::uint32_t>();
  ray.normals.face = from.Take<Vec<Real>>();
  ray.normals.shading = smooth ? from.Take<Vec<Real>>() : ray.normals.face;
}

template <class Real>
void TakeLine(Reader& from, Traveller<Real>& ray) {
  ray.ray = from.Take<Ray<Real>>();
  if (ray.to_light) {
    ray.t = from.Take<Real>();
    ray.gain.red = from.TakeColor();
    ray.gain.green = from.TakeColor();
    ray.gain.blue = from.TakeColor();
  } else {
    ray.throughput = from.Take<Real>();
    ray.depth = from.Take<std::uint8_t>();
  }
}

}  // namespace

template <class Real>
std::size_t RayPackage<Real>::MostBytes(std::size_t rays) {
  return sizeof(PackageHeader) + rays * sizeof(Traveller<Real>);
}

template <class Real>
void RayPackage<Real>::Add(const Traveller<Real>& ray) {
  const std::uint8_t flags = FlagsOf(ray);
  std::array<std::byte, sizeof ray> place;
  Writer to(place.data());
  to.Put(flags);
  to.Put(ray.point);
  to.Put(ray.seen);
  if ((flags & kPassed) != 0) to.PutPassed(ray.passed);
  if ((flags & kFromEye) != 0) {
    to.Put(ray.eye_ray);
  } else {
    to.Put(ray.ray);
    if (ray.to_light) {
      to.Put(ray.t);
      to.PutColor(ray.gain.red);
      to.PutColor(ray.gain.green);
      to.PutColor(ray.gain.blue);
    } else {
      to.Put(ray.throughput);
      to.Put(ray.depth);
    }
  }
  if ((flags & kMet) != 0) {
    to.Put(ray.t);
    to.Put(ray.object);
    to.Put(ray.material);
    to.Put(ray.normals.face);
    if ((flags & kSmooth) != 0) to.Put(ray.normals.shading);
  }
  if ((flags & kInMedia) != 0) to.Put(ray.media);
  bytes_.insert(bytes_.end(), place.data(), to.end());
  ++header_.rays;
}

template <class Real>
PackageHeader Unpack(std::span<const std::byte> bytes, const RankTracer<Real>& tracer,
                     std::vector<Traveller<Real>>& rays) {
  Reader from(bytes);
  const auto header = from.Take<PackageHeader>();
  rays.clear();
  for (std::uint32_t i = 0; i < header.rays; ++i) {
    Traveller<Real>& ray = rays.emplace_back();
    const auto flags = from.Take<std::uint8_t>();
    ray.to_light = (flags & kToLight) != 0;
    ray.first = (flags & kFirst) != 0;
    ray.point = from.Take<RasterPoint>();
    ray.seen = from.Take<std::uint16_t>();
    if ((flags & kPassed) != 0) from.TakePassed(ray.passed);
    ray.arrived = true;
    if ((flags & kFromEye) != 0) {
      ray.eye_ray = from.Take<std::uint16_t>();
      ray.ray = tracer.EyeRay(ray.point, ray.eye_ray - 1U);
    } else {
      TakeLine(from, ray);
    }
    if ((flags & kMet) != 0) TakeMet(from, (flags & kSmooth) != 0, ray);
    if ((flags & kInMedia) != 0) ray.media = from.Take<PackedMedia>();
  }
  return header;
}

template class RayPackage<float>;
template class RayPackage<double>;
template PackageHeader Unpack(std::span<const std::byte>, const RankTracer<float>&,
                              std::vector<Traveller<float>>&);
template PackageHeader Unpack(std::span<const std::byte>, const RankTracer<double>&,
                              std::vector<Traveller<double>>&);

}  // namespace stipple::raytracer
