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
#include <limits>
#include <memory>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

constexpr std::size_t kMostRead = std::size_t{1} << 26;  // at once; some systems refuse 2^31
// Multiples of Hash's block.
constexpr std::size_t kHashedAtOnce = std::size_t{1} << 18;
constexpr std::size_t kWindow = std::size_t{1} << 16;
constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;  // odd, so that it has an inverse

/// Reads until `place` is full or the file ends. Returns the bytes read, or what went wrong in
/// errno and nothing.
std::optional<std::size_t> ReadFully(int file, std::span<char> place) {
  std::size_t size = 0;
  while (size < place.size()) {
    const ssize_t count = read(file, place.data() + size, std::min(place.size() - size, kMostRead));
    if (count == 0) break;
    if (count > 0) size += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) return std::nullopt;
  }
  return size;
}

/// An open file, closed at the end.
struct Descriptor {
  explicit Descriptor(const std::string& path) : number(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool Regular() const {
    struct stat status;
    return fstat(number, &status) == 0 && S_ISREG(status.st_mode);
  }
  std::size_t Size() const {
    struct stat status;
    return fstat(number, &status) == 0 && S_ISREG(status.st_mode)
               ? static_cast<std::size_t>(status.st_size)
               : 0;
  }

  int number;
};

}  // namespace

Text::Text(const std::string& path, std::string_view all) : path_(path), window_(all) {
  if (path.empty()) return;
  Descriptor file(path);
  if (file.number < 0)
    throw InputError(path, 0, fmt::format("cannot be read: {}", std::strerror(errno)));
  behind_ = file.Regular() ? file.Size() : std::numeric_limits<std::size_t>::max() / 2;
  file_ = std::exchange(file.number, -1);
  Move(0);
}

Text::~Text() { Close(); }

void Text::Close() {
  if (file_ >= 0) close(file_);
  file_ = -1;
}

void Text::Move(std::size_t first) {
  window_.remove_prefix(first);
  if (WindowReachesEnd()) return;
  const std::size_t kept = window_.size();
  std::ranges::copy(window_, shown_.begin());
  // As much again, so that what does not fit into a window is not copied often.
  const std::size_t more = std::max(kWindow, kept / kWindow * kWindow);
  shown_.resize(kept + more);
  const std::span<char> place(shown_.data() + kept, more);
  const std::optional<std::size_t> count = ReadFully(file_, place);
  if (!count) throw InputError(path_, 0, fmt::format("cannot be read: {}", std::strerror(errno)));
  hash_.Add(std::as_bytes(place.first(*count)));
  window_ = {shown_.data(), kept + *count};
  read_ += *count;
  behind_ -= std::min(behind_, *count);
  if (*count < more) Close(), behind_ = 0;
}

std::optional<Hash> Hash::OfFile(const std::string& path, std::size_t least) {
  const Descriptor file(path);
  if (file.number < 0 || file.Size() < std::max(least, std::size_t{1})) return std::nullopt;
  const auto part = std::make_unique_for_overwrite<char[]>(kHashedAtOnce);
  Hash hash;
  for (;;) {
    const std::optional<std::size_t> count = ReadFully(file.number, {part.get(), kHashedAtOnce});
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
