// SPDX-License-Identifier: MIT
#include "analysis/trace/archive_identity.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "analysis/trace/bytes.h"
#include "analysis/trace/index_file.h"
#include "stipple/format.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

std::int64_t Nanoseconds(const timespec& t) {
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// ~/.cache/stipple, or where the user has it; empty: nowhere.
fs::path CacheDirectory() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return fs::path(cache) / "stipple";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return fs::path(home) / ".cache" / "stipple";
  return {};
}

}  // namespace

ArchiveIdentity IdentityOf(std::span<const std::string> files) {
  // The time of a change has the grain of the kernel's tick.
  constexpr std::int64_t kTickNs = 20'000'000;
  timespec now_time{};
  clock_gettime(CLOCK_REALTIME, &now_time);
  const std::int64_t now = Nanoseconds(now_time);
  ArchiveIdentity identity;
  ByteWriter bytes;
  for (const std::string& path : files) {
    struct stat status = {};
    FileHeader header = {};
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file >= 0) {
      if (fstat(file, &status) != 0) status = {};
      if (pread(file, &header, sizeof(header), 0) != ssize_t{sizeof(header)}) header = {};
      close(file);
    }
    const std::int64_t changed = Nanoseconds(status.st_mtim);
    bytes.PutText(fs::path(path).filename().string());
    bytes.Put(std::int64_t{status.st_size});
    bytes.Put(changed);
    bytes.Put(header.pid);
    bytes.Put(header.start_ticks);
    bytes.Put(header.start_realtime_ns);
    identity.stream_bytes += static_cast<std::uint64_t>(status.st_size);
    if (changed + kTickNs > now) identity.settled = false;
  }
  identity.bytes = bytes.bytes();
  return identity;
}

std::vector<std::string> IndexPlaces(const std::string& archive) {
  std::vector<std::string> places = {fs::path(archive) / kIndexName};
  std::error_code error;
  const fs::path whole = fs::canonical(archive, error);
  const fs::path cache = CacheDirectory();
  if (error || cache.empty()) return places;
  Checksum sum;
  const std::string text = whole.string();
  sum.Add(std::as_bytes(std::span<const char>(text)));
  places.push_back(
      cache / (whole.filename().string() + "." + std::to_string(sum.Sum()) + "." + kIndexName));
  return places;
}

void RemoveUnfinished(const std::string& place) {
  const fs::path path(place);
  const std::string begin = path.filename().string() + ".";
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(path.parent_path(), error)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(begin) || !name.ends_with(".new")) continue;
    const std::string pid = name.substr(begin.size(), name.size() - begin.size() - 4);
    if (!pid.empty() && !fs::exists(fs::path("/proc") / pid, error)) fs::remove(entry, error);
  }
}

}  // namespace stipple
