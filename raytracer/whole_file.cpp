// SPDX-License-Identifier: MIT
#include "raytracer/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "raytracer/errors.h"

namespace stipple::raytracer {

namespace fs = std::filesystem;

void WriteWhole(const std::string& path, const std::function<void(const std::string&)>& write) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(path, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) return write(path);
  const fs::path folder = fs::path(path).parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK) != 0) return write(path);
  const std::string unfinished = path + ".unfinished";
  try {
    write(unfinished);
  } catch (...) {
    fs::remove(unfinished, error);
    throw;
  }
  if (std::rename(unfinished.c_str(), path.c_str()) != 0)
    throw InputError(path, 0, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace stipple::raytracer
