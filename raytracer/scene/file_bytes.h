// SPDX-License-Identifier: MIT
// Files as bytes: read a window at a time, mapped read-only, and told apart by a hash.
#ifndef STIPPLE_RAYTRACER_SCENE_FILE_BYTES_H
#define STIPPLE_RAYTRACER_SCENE_FILE_BYTES_H

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stipple::raytracer {

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

/// A text as one who reads it from beginning to end sees it: through a window that moves on. A file
/// may be a pipe. It is read, not mapped: a file that somebody shortens meanwhile then gives a
/// message and not a signal.
class Text {
 public:
  /// Errors: InputError.
  static Text OfFile(const std::string& path) { return Text(path, {}); }
  static Text InMemory(std::string_view all) { return Text({}, all); }
  ~Text();
  Text(const Text&) = delete;
  Text& operator=(const Text&) = delete;

  std::string_view window() const { return window_; }
  bool WindowReachesEnd() const { return file_ < 0; }
  /// The window begins at what was its byte `first`, and reaches farther than before if the text
  /// does. Errors: InputError.
  void Move(std::size_t first);
  /// Bytes that follow the window, if that is known, or more.
  std::size_t MostBytesBehind() const { return behind_; }
  /// Of a file: of what has come into the window so far, and its size.
  const Hash& hash() const { return hash_; }
  std::size_t bytes_read() const { return read_; }

 private:
  Text(const std::string& path, std::string_view all);
  void Close();

  std::string path_;
  int file_ = -1;
  std::size_t behind_ = 0, read_ = 0;
  std::vector<char> shown_;
  std::string_view window_;
  Hash hash_;
};

}  // namespace stipple::raytracer

#endif
