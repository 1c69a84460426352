// SPDX-License-Identifier: MIT
#include "raytracer/scene/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

constexpr std::size_t kMostRead = std::size_t{1} << 26;      // at once; some systems refuse 2^31
constexpr std::size_t kHashedAtOnce = std::size_t{1} << 18;  // a multiple of Hash's block
constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;        // odd, so that it has an inverse

/// An open file, closed at the end.
struct Descriptor {
  explicit Descriptor(const std::string& path) : number(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  std::size_t Size() const {
    struct stat status;
    return fstat(number, &status) == 0 && S_ISREG(status.st_mode)
               ? static_cast<std::size_t>(status.st_size)
               : 0;
  }
  /// Reads until `place` is full or the file ends. Returns the bytes read, or what went wrong in
  /// errno and nothing.
  std::optional<std::size_t> Read(std::span<char> place) const {
    std::size_t size = 0;
    while (size < place.size()) {
      const ssize_t count =
          read(number, place.data() + size, std::min(place.size() - size, kMostRead));
      if (count == 0) break;
      if (count > 0) size += static_cast<std::size_t>(count);
      if (count < 0 && errno != EINTR) return std::nullopt;
    }
    return size;
  }

  int number;
};

}  // namespace

FileText::FileText(const std::string& path) {
  const Descriptor file(path);
  if (file.number < 0)
    throw InputError(path, 0, fmt::format("cannot be read: {}", std::strerror(errno)));
  // One byte more than the file has, so that its end is met without growing.
  std::size_t room = file.Size() + 1;
  for (;;) {
    auto more = std::make_unique_for_overwrite<char[]>(room);
    std::copy_n(text_.get(), size_, more.get());
    text_ = std::move(more);
    const std::optional<std::size_t> count = file.Read({text_.get() + size_, room - size_});
    if (!count) throw InputError(path, 0, fmt::format("cannot be read: {}", std::strerror(errno)));
    size_ += *count;
    if (size_ < room) return;
    room = 2 * room + kHashedAtOnce;
  }
}

std::optional<Hash> Hash::OfFile(const std::string& path, std::size_t least) {
  const Descriptor file(path);
  if (file.number < 0 || file.Size() < std::max(least, std::size_t{1})) return std::nullopt;
  const auto part = std::make_unique_for_overwrite<char[]>(kHashedAtOnce);
  Hash hash;
  for (;;) {
    const std::optional<std::size_t> count = file.Read({part.get(), kHashedAtOnce});
    if (!count) return std::nullopt;
    hash.Add(std::as_bytes(std::span(part.get(), *count)));
    if (*count < kHashedAtOnce) return hash;
  }
}

MappedFile::MappedFile(const std::string& path) {
  const Descriptor file(path);
  const std::size_t size = file.number >= 0 ? file.Size() : 0;
  if (size == 0) return;
  const void* const memory = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.number, 0);
  if (memory != MAP_FAILED) bytes_ = {static_cast<const std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void Hash::AddBlock(Lanes& lanes, const std::byte* block) {
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    std::uint64_t word;
    std::memcpy(&word, block + 8 * i, 8);
    lanes[i] = std::rotl((lanes[i] ^ word) * kFactor, 29);
  }
}

void Hash::Add(std::span<const std::byte> bytes) {
  Lanes lanes = lanes_;  // a local copy stays in registers
  constexpr std::size_t kBlock = sizeof lanes;
  std::size_t at = 0;
  for (; at + kBlock <= bytes.size(); at += kBlock) AddBlock(lanes, bytes.data() + at);
  if (at < bytes.size()) {
    std::byte last[kBlock] = {};
    std::ranges::copy(bytes.subspan(at), last);
    AddBlock(lanes, last);
  }
  lanes_ = lanes;
  length_ += (bytes.size() + kBlock - 1) / kBlock * kBlock;
}

std::uint64_t Hash::Value() const {
  std::uint64_t value = length_;
  for (const std::uint64_t lane : lanes_) {
    value = (value ^ lane) * kFactor;
    value ^= value >> 32;
  }
  return value;
}

}  // namespace stipple::raytracer
