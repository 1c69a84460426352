// SPDX-License-Identifier: MIT
#include "analysis/trace/index_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "analysis/trace/parallel.h"

namespace stipple {
namespace {

constexpr std::uint64_t kMagic = 0x7864'6e69'7074'7300;  // "\0stpindx"
// Another number whenever a section means something else, or something is computed otherwise.
constexpr std::uint32_t kVersion = 2;
constexpr std::uint64_t kAlign = 64;
constexpr std::uint64_t kMostEntries = 1 << 20;
constexpr std::uint64_t kPieceBytes = 1 << 20;

constexpr std::uint64_t kOdd1 = 0x9E3779B185EBCA87;
constexpr std::uint64_t kOdd2 = 0xC2B2AE3D27D4EB4F;

std::uint64_t Round(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * kOdd2, 31) * kOdd1;
}

template <class T>
std::span<const std::byte> BytesOf(const T& value) {
  return std::as_bytes(std::span<const T>(&value, 1));
}

std::uint64_t ChecksumOf(IndexHeader header, std::span<const IndexEntry> entries) {
  header.checksum = 0;
  Checksum sum;
  sum.Add(BytesOf(header));
  sum.Add(std::as_bytes(entries));
  return sum.Sum();
}

/// Reads all of `to` at `offset`; through read, so that no page of it becomes resident.
bool ReadAt(int file, std::uint64_t offset, std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t got = pread(file, to.data(), to.size(), static_cast<off_t>(offset));
    if (got <= 0) return false;
    to = to.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return true;
}

bool IsAsWritten(int file, const IndexEntry& entry) {
  std::vector<std::byte> buffer(std::min(kPieceBytes, entry.items * entry.item_bytes));
  Checksum sum;
  for (std::uint64_t at = 0, bytes = entry.items * entry.item_bytes; at < bytes;) {
    const std::span<std::byte> piece(buffer.data(), std::min(kPieceBytes, bytes - at));
    if (!ReadAt(file, entry.offset + at, piece)) return false;
    sum.Add(piece);
    at += piece.size();
  }
  return sum.Sum() == entry.checksum;
}

}  // namespace

void Checksum::Block(const std::byte* block) {
  std::array<std::uint64_t, 4> words;
  std::memcpy(words.data(), block, sizeof(words));
  for (std::size_t i = 0; i < 4; ++i) lanes_[i] = Round(lanes_[i], words[i]);
}

void Checksum::Add(std::span<const std::byte> bytes) {
  bytes_ += bytes.size();
  if (in_rest_ != 0) {
    const std::size_t more = std::min(kBlock - in_rest_, bytes.size());
    std::memcpy(rest_ + in_rest_, bytes.data(), more);
    in_rest_ += more;
    bytes = bytes.subspan(more);
    if (in_rest_ < kBlock) return;
    Block(rest_);
    in_rest_ = 0;
  }
  for (; bytes.size() >= kBlock; bytes = bytes.subspan(kBlock)) Block(bytes.data());
  if (!bytes.empty()) std::memcpy(rest_, bytes.data(), bytes.size());
  in_rest_ = bytes.size();
}

std::uint64_t Checksum::Sum() const {
  Checksum last = *this;
  std::memset(last.rest_ + in_rest_, 0, kBlock - in_rest_);
  last.Block(last.rest_);
  std::uint64_t sum = bytes_;
  for (const std::uint64_t lane : last.lanes_) sum = Round(sum ^ lane, lane >> 29);
  return sum ^ (sum >> 32);
}

bool IndexFile::ReadEntries(int file) {
  const std::uint64_t bytes = file_.bytes().size();
  IndexHeader header;
  if (!ReadAt(file, 0, std::as_writable_bytes(std::span(&header, 1)))) return false;
  if (header.magic != kMagic || header.version != kVersion || header.bytes != bytes ||
      header.entries > kMostEntries || header.entries_at > bytes ||
      header.entries * sizeof(IndexEntry) != bytes - header.entries_at)
    return false;
  entries_.resize(header.entries);
  if (!ReadAt(file, header.entries_at, std::as_writable_bytes(std::span(entries_)))) return false;
  if (ChecksumOf(header, entries_) != header.checksum) return false;
  std::vector<char> sound(entries_.size());
  ForEachIndex(entries_.size(), [&](std::size_t i) {
    const IndexEntry& e = entries_[i];
    sound[i] = e.item_bytes != 0 && e.offset % kAlign == 0 && e.offset <= bytes &&
               e.items <= (bytes - e.offset) / e.item_bytes && IsAsWritten(file, e);
  });
  for (IndexEntry& e : entries_) e.name[sizeof(e.name) - 1] = 0;
  for (const IndexEntry& e : entries_) by_name_.try_emplace(std::string_view(e.name), &e);
  return std::ranges::count(sound, 0) == 0;
}

std::shared_ptr<const IndexFile> IndexFile::Open(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return nullptr;
  std::optional<MappedFile> mapped = MappedFile::Open(path);
  std::shared_ptr<IndexFile> index;
  if (mapped) index.reset(new IndexFile(std::move(*mapped)));
  const bool sound = index != nullptr && index->ReadEntries(file);
  close(file);
  return sound ? index : nullptr;
}

const IndexEntry* IndexFile::Find(std::string_view name, std::size_t item_bytes) const {
  const auto entry = by_name_.find(name);
  return entry != by_name_.end() && entry->second->item_bytes == item_bytes ? entry->second
                                                                            : nullptr;
}

std::string_view IndexFile::Bytes(std::string_view name) const {
  const IndexEntry* entry = Find(name, 1);
  if (entry == nullptr) return {};
  return {reinterpret_cast<const char*>(file_.bytes().data()) + entry->offset, entry->items};
}

IndexWriter::IndexWriter(std::string path)
    : path_(std::move(path)), temporary_(path_ + "." + std::to_string(getpid()) + ".new") {
  file_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  failed_ = file_ < 0;
  const IndexHeader room;
  Write(BytesOf(room));
}

IndexWriter::~IndexWriter() {
  if (file_ < 0) return;
  close(file_);
  unlink(temporary_.c_str());
}

void IndexWriter::Write(std::span<const std::byte> bytes) {
  while (!failed_ && !bytes.empty()) {
    const ssize_t done = write(file_, bytes.data(), bytes.size());
    if (done <= 0) {
      failed_ = true;
      return;
    }
    at_ += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void IndexWriter::Begin(std::string_view name, std::size_t item_bytes) {
  constexpr std::array<std::byte, kAlign> kZeros{};
  Write(std::span(kZeros).first((kAlign - at_ % kAlign) % kAlign));
  IndexEntry entry;
  if (name.size() >= sizeof(entry.name)) failed_ = true;
  std::memcpy(entry.name, name.data(), std::min(name.size(), sizeof(entry.name) - 1));
  entry.item_bytes = item_bytes;
  entry.offset = at_;
  entries_.push_back(entry);
  section_ = {};
}

void IndexWriter::Append(std::span<const std::byte> bytes) {
  section_.Add(bytes);
  Write(bytes);
}

void IndexWriter::End() {
  IndexEntry& entry = entries_.back();
  entry.items = (at_ - entry.offset) / entry.item_bytes;
  entry.checksum = section_.Sum();
}

bool IndexWriter::Finish() {
  if (failed_) return false;
  constexpr std::array<std::byte, kAlign> kZeros{};
  Write(std::span(kZeros).first((kAlign - at_ % kAlign) % kAlign));
  IndexHeader header;
  header.magic = kMagic;
  header.version = kVersion;
  header.entries = static_cast<std::uint32_t>(entries_.size());
  header.entries_at = at_;
  Write(std::as_bytes(std::span<const IndexEntry>(entries_)));
  header.bytes = at_;
  header.checksum = ChecksumOf(header, entries_);
  if (failed_ || pwrite(file_, &header, sizeof(header), 0) != ssize_t{sizeof(header)}) return false;
  if (rename(temporary_.c_str(), path_.c_str()) != 0) return false;
  close(file_);
  file_ = -1;
  return true;
}

}  // namespace stipple
