// SPDX-License-Identifier: MIT
#include "raytracer/scene/packed_scene.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>

#include "raytracer/scene/file_bytes.h"

namespace stipple::raytracer {
namespace {

constexpr std::uint64_t kMagic = 0x317463735f707473;  // "stp_sct1" where the low byte comes first

template <class T>
std::span<const std::byte> BytesOf(const T& array) {
  return std::as_bytes(std::span(array.data(), array.size()));
}

/// Looks at a part as an array of T; false if its size is no multiple of one element's.
template <class T>
bool LookAt(std::span<const std::byte> block, const PackedHeader::Part& part,
            std::span<const T>& elements) {
  if (part.bytes % sizeof(T) != 0) return false;
  elements = {reinterpret_cast<const T*>(block.data() + part.offset), part.bytes / sizeof(T)};
  return true;
}

/// Does the header describe parts that lie one behind the other within the block?
bool Sound(const PackedHeader& header, std::size_t block_bytes, std::size_t part_count) {
  if (header.magic != kMagic || header.bytes != block_bytes || header.part_count != part_count)
    return false;
  std::uint64_t free = kHeaderBytes;
  for (std::size_t i = 0; i < part_count; ++i) {
    const auto& [offset, bytes] = header.parts[i];
    if (offset % 64 != 0 || offset < free || offset > block_bytes || bytes > block_bytes - offset)
      return false;
    free = offset + bytes;
  }
  return true;
}

/// Lights, materials and the arrays of the model.
template <class Real>
std::size_t PartCount() {
  std::size_t count = 2;
  Model<Real>().ForEachArray([&](const auto&) { ++count; });
  return count;
}

}  // namespace

template <class Real>
std::uint64_t LayoutOf() {
  constexpr std::string_view kSources = STIPPLE_MODEL_SOURCES;  // a hash, made by CMake
  Hash hash;
  hash.Add(std::as_bytes(std::span(kSources)));
  std::vector<std::size_t> sizes{sizeof(Real), std::numeric_limits<Real>::digits, sizeof(Light),
                                 sizeof(Material), sizeof(PackedHeader)};
  Model<Real>().ForEachArray([&]<class Elements>(const Elements&) {
    sizes.push_back(sizeof(typename Elements::Element));
  });
  hash.Add(std::as_bytes(std::span(sizes)));
  return hash.Value();
}

template <class Real>
std::vector<std::span<const std::byte>> PartsOf(BuiltScene<Real>& built) {
  std::vector parts{BytesOf(built.scene.lights), BytesOf(built.scene.materials)};
  built.model.ForEachArray([&](const auto& array) { parts.push_back(BytesOf(array)); });
  return parts;
}

template <class Real>
PackedHeader HeaderOf(BuiltScene<Real>& built) {
  PackedHeader header;
  // Padding, too, is part of what is stored and compared.
  std::memset(static_cast<void*>(&header), 0, sizeof header);
  header.magic = kMagic;
  header.layout = LayoutOf<Real>();
  header.background = built.scene.background;
  header.view = built.scene.view;
  header.bytes = kHeaderBytes;
  for (const std::span<const std::byte> part : PartsOf(built)) {
    header.parts[header.part_count++] = {header.bytes, part.size()};
    header.bytes += (part.size() + 63) / 64 * 64;
  }
  return header;
}

template <class Real>
void PackInto(std::byte* block, BuiltScene<Real>& built) {
  const PackedHeader header = HeaderOf(built);
  std::memcpy(block, &header, sizeof header);
  const PackedHeader::Part* part = header.parts;
  const auto copy = [&](const auto& array) {
    std::byte* const place = block + (part++)->offset;
    std::ranges::copy(BytesOf(array), place);
    return place;
  };
  copy(built.scene.lights);
  copy(built.scene.materials);
  built.model.ForEachArray([&]<class T>(Array<T>& array) {
    const auto* const elements = reinterpret_cast<const T*>(copy(array));
    array = Array<T>(std::span(elements, array.size()));
  });
}

template <class Real>
std::optional<BuiltScene<Real>> Unpack(std::span<const std::byte> block) {
  PackedHeader header;
  if (block.size() < kHeaderBytes) return std::nullopt;
  std::memcpy(&header, block.data(), sizeof header);
  if (!Sound(header, block.size(), PartCount<Real>()) || header.layout != LayoutOf<Real>())
    return std::nullopt;
  BuiltScene<Real> built;
  built.scene.background = header.background;
  built.scene.view = header.view;
  std::span<const Light> lights;
  std::span<const Material> materials;
  bool fits = LookAt(block, header.parts[0], lights) && LookAt(block, header.parts[1], materials);
  built.scene.lights.assign(lights.begin(), lights.end());
  built.scene.materials.assign(materials.begin(), materials.end());
  const PackedHeader::Part* part = header.parts + 2;
  built.model.ForEachArray([&]<class T>(Array<T>& array) {
    std::span<const T> elements;
    fits = LookAt(block, *part++, elements) && fits;
    array = Array<T>(elements);
  });
  if (!fits) return std::nullopt;
  return built;
}

#define STIPPLE_PACKED_SCENE(Real)                                             \
  template std::uint64_t LayoutOf<Real>();                                     \
  template std::vector<std::span<const std::byte>> PartsOf(BuiltScene<Real>&); \
  template PackedHeader HeaderOf(BuiltScene<Real>&);                           \
  template void PackInto(std::byte*, BuiltScene<Real>&);                       \
  template std::optional<BuiltScene<Real>> Unpack(std::span<const std::byte>)

STIPPLE_PACKED_SCENE(float);
STIPPLE_PACKED_SCENE(double);
STIPPLE_PACKED_SCENE(long double);
#undef STIPPLE_PACKED_SCENE

}  // namespace stipple::raytracer
