// SPDX-License-Identifier: MIT
#include "raytracer/scene/scene_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

namespace stipple::raytracer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".scene";
constexpr std::string_view kUnfinished = ".part";  // behind a name that mkstemp made
constexpr auto kAbandoned = std::chrono::hours(24);

/// The hash of a whole file, as if its header had 0 where the hash is.
std::uint64_t HashOfFile(std::span<const std::byte> bytes) {
  std::byte first[kHeaderBytes];
  std::ranges::copy(bytes.first(kHeaderBytes), first);
  std::memset(first + offsetof(PackedHeader, hash), 0, sizeof(PackedHeader::hash));
  Hash hash;
  hash.Add(first);
  hash.Add(bytes.subspan(kHeaderBytes));
  return hash.Value();
}

PackedHeader HeaderIn(const MappedFile& file) {
  PackedHeader header;
  if (file.bytes().size() >= sizeof header)
    std::memcpy(&header, file.bytes().data(), sizeof header);
  return header;
}

/// A new file that gets its name when it is complete, and goes away if it never is.
class NewFile {
 public:
  explicit NewFile(const std::string& folder)
      : name_(fmt::format("{}/XXXXXX{}", folder, kUnfinished)),
        number_(mkostemps(name_.data(), static_cast<int>(kUnfinished.size()), O_CLOEXEC)) {}
  ~NewFile() {
    if (number_ < 0) return;
    close(number_);
    if (!name_.empty()) unlink(name_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Writes at `offset`; false if that is not possible.
  bool Write(std::span<const std::byte> bytes, std::uint64_t offset) const {
    while (!bytes.empty()) {
      const ssize_t count = pwrite(number_, bytes.data(), std::min(bytes.size(), kWriteBytes),
                                   static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
    return true;
  }

  bool Finish(std::uint64_t size, const std::string& path) {
    if (ftruncate(number_, static_cast<off_t>(size)) != 0) return false;
    if (rename(name_.c_str(), path.c_str()) != 0) return false;
    name_.clear();
    return true;
  }

 private:
  static constexpr std::size_t kWriteBytes = std::size_t{1} << 26;
  std::string name_;
  int number_;
};

struct KeptFile {
  fs::path path;
  fs::file_time_type used;
  std::uint64_t bytes;
};

/// Removes what was used longest ago until `bytes` more fit, and what crashed programs left.
void MakeRoom(const std::string& folder, std::uint64_t bytes) {
  std::vector<KeptFile> kept;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const KeptFile file{entry.path(), entry.last_write_time(error), entry.file_size(error)};
    if (error) continue;
    if (file.path.extension() == kEnding) kept.push_back(file);
    if (file.path.extension() == kUnfinished &&
        fs::file_time_type::clock::now() - file.used > kAbandoned)
      fs::remove(file.path, error);
  }
  std::ranges::sort(kept, {}, &KeptFile::used);
  std::uint64_t total = bytes;
  for (const KeptFile& file : kept) total += file.bytes;
  for (const KeptFile& file : kept) {
    if (total <= kCacheBytes) return;
    fs::remove(file.path, error);
    total -= file.bytes;
  }
}

/// A kept scene may take half of what is free on its disk.
bool RoomFor(const std::string& folder, std::uint64_t bytes) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  return !error && bytes <= kCacheBytes && bytes <= space.available / 2;
}

template <class Real>
bool WriteScene(BuiltScene<Real>& built, PackedHeader& header, const std::string& path) {
  NewFile file(fs::path(path).parent_path());
  const std::vector<std::span<const std::byte>> parts = PartsOf(built);
  Hash hash;
  std::byte first[kHeaderBytes] = {};
  std::memcpy(first, &header, sizeof header);
  hash.Add(first);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    hash.Add(parts[i]);
    if (!file.Write(parts[i], header.parts[i].offset)) return false;
  }
  header.hash = hash.Value();
  return file.Write(std::as_bytes(std::span(&header, 1)), 0) && file.Finish(header.bytes, path);
}

}  // namespace

std::string CacheFolder() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return fmt::format("{}/stipple", cache);
  const char* const home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return fmt::format("{}/.cache/stipple", home);
  return {};
}

template <class Real>
SceneCache<Real>::SceneCache(const Hash& text, std::string_view choices) {
  const std::string folder = CacheFolder();
  if (folder.empty()) return;
  const std::uint64_t depends_on[] = {LayoutOf<Real>(), text.Value()};
  Hash hash;
  hash.Add(std::as_bytes(std::span(depends_on)));
  hash.Add(std::as_bytes(std::span(choices)));
  key_ = hash.Value();
  path_ = fmt::format("{}/{:016x}{}", folder, key_, kEnding);
}

template <class Real>
std::optional<CachedScene<Real>> SceneCache<Real>::Open(std::string& note) const {
  CachedScene<Real> cached{path_, 0, MappedFile(path_), {}};
  const PackedHeader header = HeaderIn(cached.file);
  const std::span<const std::byte> bytes = cached.file.bytes();
  if (bytes.empty()) return std::nullopt;
  std::optional<BuiltScene<Real>> built = Unpack<Real>(bytes);
  if (!built || header.key != key_ || header.hash != HashOfFile(bytes)) {
    note = fmt::format("{}: damaged; it is made anew", path_);
    return std::nullopt;
  }
  cached.hash = header.hash;
  cached.built = std::move(*built);
  utimensat(AT_FDCWD, path_.c_str(), nullptr, 0);  // used now; what that tells is only when to go
  return cached;
}

template <class Real>
std::optional<CachedScene<Real>> SceneCache<Real>::Keep(BuiltScene<Real>& built) const {
  if (path_.empty() || built.model.objects.size() < kLeastCachedObjects) return std::nullopt;
  const std::string folder = fs::path(path_).parent_path();
  std::error_code error;
  fs::create_directories(folder, error);
  PackedHeader header = HeaderOf(built);
  header.key = key_;
  if (!RoomFor(folder, header.bytes)) return std::nullopt;
  MakeRoom(folder, header.bytes);
  if (!WriteScene(built, header, path_)) return std::nullopt;
  std::optional<CachedScene<Real>> cached = OpenAgain<Real>(path_, header.hash);
  if (cached) built = {};
  return cached;
}

template <class Real>
std::optional<CachedScene<Real>> OpenAgain(const std::string& path, std::uint64_t hash) {
  CachedScene<Real> cached{path, hash, MappedFile(path), {}};
  std::optional<BuiltScene<Real>> built = Unpack<Real>(cached.file.bytes());
  if (!built || HeaderIn(cached.file).hash != hash) return std::nullopt;
  cached.built = std::move(*built);
  return cached;
}

template class SceneCache<float>;
template class SceneCache<double>;
template std::optional<CachedScene<float>> OpenAgain(const std::string&, std::uint64_t);
template std::optional<CachedScene<double>> OpenAgain(const std::string&, std::uint64_t);

}  // namespace stipple::raytracer
