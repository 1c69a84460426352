// SPDX-License-Identifier: MIT
// Files as bytes: read at once, mapped read-only, and told apart by a hash.
#ifndef STIPPLE_RAYTRACER_SCENE_FILE_BYTES_H
#define STIPPLE_RAYTRACER_SCENE_FILE_BYTES_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace stipple::raytracer {

/// All of a file, which may be a pipe too. It is read, not mapped: a file that somebody shortens
/// meanwhile then gives a message and not a signal.
class FileText {
 public:
  FileText() = default;
  /// Errors: InputError.
  explicit FileText(const std::string& path);

  std::string_view view() const { return {text_.get(), size_}; }

 private:
  std::unique_ptr<char[]> text_;
  std::size_t size_ = 0;
};

/// A file's bytes, read-only, in the page cache that all processes of a computer share.
class MappedFile {
 public:
  MappedFile() = default;
  /// No bytes if the file is empty or cannot be mapped.
  explicit MappedFile(const std::string& path);
  MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  MappedFile& operator=(MappedFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MappedFile();

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

/// A hash of 64 bits that finds every damage within one word of eight bytes and, but for one chance
/// in 2^64, any other. Not for secrets.
///
/// Eight lanes take a word of each block in turn. Every step can be undone, so two inputs that
/// differ in one word of a lane leave different lanes.
class Hash {
 public:
  /// Bytes are taken in blocks of 64; the last block of each call is filled up with zeros.
  void Add(std::span<const std::byte> bytes);
  std::uint64_t Value() const;

  /// Of a file, read once and not kept. Nothing if it is not of the regular kind, which can be read
  /// again, or has fewer bytes than `least`.
  static std::optional<Hash> OfFile(const std::string& path, std::size_t least);

 private:
  using Lanes = std::array<std::uint64_t, 8>;
  static void AddBlock(Lanes& lanes, const std::byte* block);

  Lanes lanes_{1, 2, 3, 4, 5, 6, 7, 8};
  std::uint64_t length_ = 0;
};

}  // namespace stipple::raytracer

#endif
