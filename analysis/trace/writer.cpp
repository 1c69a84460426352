// SPDX-License-Identifier: MIT
// The kernel knows who has a file open for writing, by descriptor or by mapping: it grants a read
// lease only if nobody has. That holds whatever became of process numbers (used again, or of a
// container that sees others), and ends with the process, however it ends. The lease is given back
// at once. Where there are no leases (network file systems, another user's file) the process of the
// stream's name is asked for, if it is one of this computer.
#include "analysis/trace/writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// By the name HOSTNAME.PID.START.stream.
Writer WriterByName(const std::string& name) {
  std::array<char, 65> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) return Writer::kUnknown;
  const std::string own = std::string(host.data()) + ".";
  if (!name.starts_with(own)) return Writer::kUnknown;
  const std::string pid = name.substr(own.size(), name.find('.', own.size()) - own.size());
  const fs::path process = fs::path("/proc") / pid;
  std::error_code error;
  if (pid.empty() || !fs::exists(process, error)) return Writer::kGone;
  std::ifstream maps(process / "maps");
  const std::string text{std::istreambuf_iterator<char>(maps), {}};
  return text.empty() || text.find("/" + name) != std::string::npos ? Writer::kThere
                                                                    : Writer::kGone;
}

}  // namespace

Writer WriterOf(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return Writer::kUnknown;
  const int error = fcntl(file, F_SETLEASE, F_RDLCK) == 0 ? 0 : errno;
  if (error == 0) fcntl(file, F_SETLEASE, F_UNLCK);
  close(file);
  if (error == 0) return Writer::kGone;
  return error == EAGAIN ? Writer::kThere : WriterByName(fs::path(path).filename());
}

}  // namespace stipple
