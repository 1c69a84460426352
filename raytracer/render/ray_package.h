// SPDX-License-Identifier: MIT
// Rays in a message, one behind the other, each in as few bytes as tell all that the receiver
// cannot find out itself: of an eye ray its point and number, for everybody knows the camera; what
// was met only where something was. Numbers keep all their bits, so that no picture depends on who
// sent what to whom.
#ifndef STIPPLE_RAYTRACER_RENDER_RAY_PACKAGE_H
#define STIPPLE_RAYTRACER_RENDER_RAY_PACKAGE_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "raytracer/render/travel.h"

namespace stipple::raytracer {

/// Before the rays of a package.
struct PackageHeader {
  std::uint32_t rays = 0;
  std::uint32_t worked_off = 0;  // packages of the receiver's
};

template <class Real>
class RayPackage {
 public:
  RayPackage() : bytes_(sizeof(PackageHeader)) {}

  void Add(const Traveller<Real>& ray);
  std::size_t rays() const { return header_.rays; }
  /// As it is sent.
  std::span<const std::byte> Ready(std::uint32_t worked_off) {
    header_.worked_off = worked_off;
    std::memcpy(bytes_.data(), &header_, sizeof header_);
    return bytes_;
  }

  /// A package of so many rays has no more bytes than this.
  static std::size_t MostBytes(std::size_t rays);

 private:
  PackageHeader header_;
  std::vector<std::byte> bytes_;
};

/// What RayPackage::Ready gave, on the receiving rank; `rays` are replaced.
template <class Real>
PackageHeader Unpack(std::span<const std::byte> bytes, const RankTracer<Real>& tracer,
                     std::vector<Traveller<Real>>& rays);

}  // namespace stipple::raytracer

#endif
