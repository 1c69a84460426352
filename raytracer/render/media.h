// SPDX-License-Identifier: MIT
// Which transparent objects a ray is inside of. NFF cannot say what surrounds an object, and its
// rule takes air; between water and the glass that holds it that bends rays by up to 18 degrees too
// much. Here objects may overlap, and where they do the one with the highest priority counts
// (Schmidt, Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools
// 7(2), 2002).
#ifndef STIPPLE_RAYTRACER_RENDER_MEDIA_H
#define STIPPLE_RAYTRACER_RENDER_MEDIA_H

#include <algorithm>
#include <array>
#include <cstdint>

#include "raytracer/render/shading.h"

namespace stipple::raytracer {

inline constexpr std::size_t kMostMedia = 8;

/// The same by number of material, for messages.
struct PackedMedia {
  std::array<std::uint32_t, kMostMedia> inside{};
  std::uint32_t count = 0;
};

/// The media around a point, by material; air if there is none. More than `kMostMedia` inside each
/// other are forgotten: the outermost counts as air.
template <class Real>
class Media {
 public:
  using Material = ShadedMaterial<Real>;

  Media() = default;
  Media(const PackedMedia& packed, const Material* materials) : count_(packed.count) {
    for (std::size_t i = 0; i < count_; ++i) inside_[i] = materials + packed.inside[i];
  }
  PackedMedia Packed(const Material* materials) const {
    PackedMedia packed;
    for (std::size_t i = 0; i < count_; ++i)
      packed.inside[i] = static_cast<std::uint32_t>(inside_[i] - materials);
    packed.count = static_cast<std::uint32_t>(count_);
    return packed;
  }

  void Enter(const Material& medium) {
    if (count_ == kMostMedia) {
      std::move(inside_.begin() + 1, inside_.end(), inside_.begin());
      --count_;
    }
    inside_[count_++] = &medium;
  }
  void Leave(const Material& medium) {
    const auto end = inside_.begin() + count_;
    const auto found = std::find(inside_.begin(), end, &medium);
    if (found == end) return;  // the eye stood inside
    std::move(found + 1, end, found);
    --count_;
  }

  /// Is a surface of `medium` one that does not count, as a medium of higher priority is on both
  /// sides? Then these become the media behind it.
  bool Passes(const Material& medium, bool leaving) {
    if (medium.priority <= 0) return false;
    Media behind = *this;
    if (leaving) behind.Leave(medium);
    const Material* const top = behind.Top();
    if (top == nullptr || top->priority <= medium.priority) return false;
    if (!leaving) behind.Enter(medium);
    *this = behind;
    return true;
  }

  /// Of the media here the one that counts; null in air.
  const Material* Top() const {
    const Material* top = nullptr;
    for (std::size_t i = 0; i < count_; ++i)
      if (top == nullptr || inside_[i]->priority > top->priority) top = inside_[i];
    return top;
  }

 private:
  std::array<const Material*, kMostMedia> inside_{};
  std::size_t count_ = 0;
};

/// For scenes whose media do not overlap.
struct OnlyAir {};

}  // namespace stipple::raytracer

#endif
