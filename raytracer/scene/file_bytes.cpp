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

constexpr std::size_t kReadBytes = std::size_t{1} << 26;  // at once; some systems refuse 2^31
constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;     // odd, so that it has an inverse

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
  int number;
};

}  // namespace

std::string ReadFile(const std::string& path) {
  const Descriptor file(path);
  std::string text;
  // One byte more than the file has, so that its end is met without growing.
  text.resize(file.number >= 0 ? file.Size() + 1 : 1);
  std::size_t size = 0;
  for (;;) {
    if (size == text.size()) text.resize(size + kReadBytes);
    const ssize_t count =
        read(file.number, text.data() + size, std::min(text.size() - size, kReadBytes));
    if (count == 0) break;
    if (count > 0) size += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR)
      throw InputError(path, 0, fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  text.resize(size);
  return text;
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
