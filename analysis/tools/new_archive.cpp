// SPDX-License-Identifier: MIT
#include "analysis/tools/new_archive.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "analysis/tools/command.h"
#include "analysis/tools/process.h"
#include "analysis/tools/progress.h"
#include "analysis/trace/archive_identity.h"
#include "analysis/trace/input_error.h"

namespace stipple {

namespace fs = std::filesystem;

namespace {

/// Only streams (and what commands of ours left beside them) make an archive that may be removed.
bool LooksLikeArchive(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(path, error))) return false;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (!entry.is_regular_file() ||
        (entry.path().extension() != ".stream" && entry.path().extension() != kUnfinishedStream &&
         !entry.path().filename().string().starts_with(kIndexName)))
      return false;
  return !error;
}

}  // namespace

std::string WithoutSlash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

bool MakeArchive(const std::string& path, bool overwrite) {
  std::error_code absent;
  std::error_code error;
  if (fs::exists(fs::symlink_status(path, absent))) {
    if (!overwrite) throw InputError(path, "exists; --overwrite replaces it, -o names another");
    if (!LooksLikeArchive(path))
      throw InputError(path, "is not an archive, so --overwrite leaves it alone");
    fs::remove_all(path, error);
  }
  if (!error) fs::create_directories(path, error);
  if (error) fmt::print(stderr, "stipple: nothing is recorded: {}: {}\n", path, error.message());
  return !error;
}

void CompactNew(const std::string& archive) {
  try {
    ProgressLine progress;
    CompactResult result = CompactArchive(archive, archive, StopOnSignals(), progress.meter());
    progress.Stop();
    SayLeftAlone(result);
  } catch (const std::exception& e) {
    fmt::print(stderr, "stipple: not compacted: {}\n", e.what());
  }
}

}  // namespace stipple
