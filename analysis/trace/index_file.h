// SPDX-License-Identifier: MIT
// A file of named sections, each an array of plain values, mapped when it is read: what is saved
// beside an archive. Nothing in it is trusted before its checksum was compared; a file that is not
// as it was written is no file. It is written beside its place and renamed, so that a reader finds
// all of it or nothing.
//
//   file    := IndexHeader, { section, zeros to 64 bytes }, { IndexEntry }
//   checked := the header's checksum covers the header and the entries, each entry's its section
#ifndef STIPPLE_ANALYSIS_TRACE_INDEX_FILE_H
#define STIPPLE_ANALYSIS_TRACE_INDEX_FILE_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "analysis/trace/array.h"
#include "analysis/trace/stream.h"

namespace stipple {

struct IndexHeader {
  std::uint64_t magic = 0;
  std::uint32_t version = 0;
  std::uint32_t entries = 0;
  std::uint64_t bytes = 0;       // of the file
  std::uint64_t entries_at = 0;  // offset
  std::uint64_t checksum = 0;    // of this with a checksum of 0, and of the entries
};

struct IndexEntry {
  char name[24] = {};
  std::uint64_t item_bytes = 0;
  std::uint64_t offset = 0;
  std::uint64_t items = 0;
  std::uint64_t checksum = 0;
};

/// Takes bytes in pieces of any size; equal bytes give equal sums.
class Checksum {
 public:
  void Add(std::span<const std::byte> bytes);
  std::uint64_t Sum() const;

 private:
  void Block(const std::byte* block);
  static constexpr std::size_t kBlock = 32;
  std::uint64_t lanes_[4] = {1, 2, 3, 4};
  std::byte rest_[kBlock] = {};
  std::size_t in_rest_ = 0;
  std::uint64_t bytes_ = 0;
};

/// An index that was found sound.
class IndexFile : public std::enable_shared_from_this<IndexFile> {
 public:
  /// Null: there is none, or it is not sound, or another version wrote it.
  static std::shared_ptr<const IndexFile> Open(const std::string& path);

  /// The section, as it lies in the file; nothing if there is none or its items are not T.
  template <class T>
  std::optional<Array<T>> Get(std::string_view name) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const IndexEntry* entry = Find(name, sizeof(T));
    if (entry == nullptr) return std::nullopt;
    const auto* items = reinterpret_cast<const T*>(file_.bytes().data() + entry->offset);
    return Array<T>(std::span<const T>(items, entry->items), shared_from_this());
  }
  /// The same of bytes; empty if there is none.
  std::string_view Bytes(std::string_view name) const;

 private:
  explicit IndexFile(MappedFile file) : file_(std::move(file)) {}
  bool ReadEntries(int file);
  const IndexEntry* Find(std::string_view name, std::size_t item_bytes) const;

  MappedFile file_;
  std::vector<IndexEntry> entries_;
  std::map<std::string_view, const IndexEntry*> by_name_;
};

/// Writes an index. What goes wrong (no room, no permission) is told by Finish, and leaves no file.
class IndexWriter {
 public:
  explicit IndexWriter(std::string path);
  ~IndexWriter();
  IndexWriter(const IndexWriter&) = delete;
  IndexWriter& operator=(const IndexWriter&) = delete;

  template <class T>
  void Add(std::string_view name, std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T>);
    static_assert(alignof(T) <= 64);
    Begin(name, sizeof(T));
    Append(std::as_bytes(items));
    End();
  }
  void AddBytes(std::string_view name, std::string_view bytes) {
    Add(name, std::span<const char>(bytes.data(), bytes.size()));
  }
  /// A section in pieces.
  void Begin(std::string_view name, std::size_t item_bytes);
  void Append(std::span<const std::byte> bytes);
  void End();
  /// Puts the file in its place. False: there is none.
  bool Finish();

 private:
  void Write(std::span<const std::byte> bytes);

  std::string path_;
  std::string temporary_;
  int file_ = -1;
  bool failed_ = false;
  std::uint64_t at_ = 0;
  std::vector<IndexEntry> entries_;
  Checksum section_;
};

}  // namespace stipple

#endif
