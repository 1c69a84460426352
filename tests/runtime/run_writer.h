// SPDX-License-Identifier: MIT
// Runs the traced program of the core's tests in a fresh archive.
#ifndef STIPPLE_TESTS_RUNTIME_RUN_WRITER_H
#define STIPPLE_TESTS_RUNTIME_RUN_WRITER_H

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace stipple_test {

/// A directory of its own, removed at the end.
class Directory {
 public:
  Directory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "stipple-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~Directory() { std::filesystem::remove_all(path_); }
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

struct RunResult {
  int status;  // of the shell: 128 + signal for a killed program
  std::string output;
  std::string errors;
};

inline std::string ReadAll(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs `writer ARGUMENTS` with STIPPLE_ARCHIVE=`archive` (empty: unset); `before` is a shell
/// command that goes first, as "ulimit -f 1;".
inline RunResult RunWriter(const std::string& archive, const std::string& arguments,
                           const std::string& before = "") {
  const Directory scratch;
  const std::string out = scratch.path() + "/out", err = scratch.path() + "/err";
  const std::string variable =
      archive.empty() ? "unset STIPPLE_ARCHIVE; " : "export STIPPLE_ARCHIVE='" + archive + "'; ";
  // Every event, unless `before` sets another clock.
  const std::string command = "{ " + variable + "export STIPPLE_CLOCK=exact; " + before + " " + STIPPLE_WRITER + " " + arguments +
                              " >" + out + " 2>" + err + "; } 2>/dev/null; exit $?";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), ReadAll(out),
          ReadAll(err)};
}

}  // namespace stipple_test

#endif
