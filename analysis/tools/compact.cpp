// SPDX-License-Identifier: MIT
// stipple compact: makes an archive smaller, without losing a bit of it.
#include "analysis/trace/compact.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "analysis/stats/number.h"
#include "analysis/tools/command.h"
#include "analysis/tools/new_archive.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/progress.h"
#include "analysis/trace/input_error.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

std::string Bytes(std::uint64_t bytes) { return FormatBytes(static_cast<double>(bytes)); }

std::string Headline(const std::string& archive, const CompactResult& result) {
  if (result.streams == 0 && result.left_alone.empty())
    return fmt::format("{}: {}, compacted already\n", archive, Bytes(result.bytes_before));
  std::string text = fmt::format("{}: {} before, {} after", archive, Bytes(result.bytes_before),
                                 Bytes(result.bytes_after));
  if (result.events != 0)
    text +=
        fmt::format("; {}, {:.2f} bytes each", FormatCount(result.events, "event"),
                    static_cast<double>(result.event_bytes) / static_cast<double>(result.events));
  return text + "\n";
}

/// A directory for the compacted archive, which must be new.
void MakeDirectory(const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error)) throw InputError(path, "exists; -o names a new archive");
  fs::create_directories(path, error);
  if (error) throw InputError(path, error.message());
}

}  // namespace

void SayLeftAlone(const CompactResult& result) {
  constexpr std::size_t kMost = 3;
  const std::size_t count = result.left_alone.size();
  for (std::size_t i = 0; i < std::min(kMost, count); ++i)
    fmt::print(stderr, "stipple: not compacted: {}: {}\n", result.left_alone[i].file_name,
               result.left_alone[i].why);
  if (count > kMost) fmt::print(stderr, "stipple: and {} others\n", count - kMost);
  if (result.stopped) fmt::print(stderr, "stipple: compacting was interrupted\n");
}

int RunCompact(const Arguments& arguments) {
  CommandOptions app(
      "Make an archive smaller. Nothing is lost, and every command reads it as before.", "compact");
  std::string archive;
  std::string output;
  app.Add({"A", "", "the archive", true}, archive);
  app.Add({"-o", "B", "write a new archive and leave A as it is"}, output);
  if (!app.Parse(arguments)) return 0;
  archive = WithoutSlash(archive);
  if (!fs::is_directory(archive))
    throw InputError(archive, "is not an archive (no such directory)");
  if (!output.empty()) MakeDirectory(output);
  ProgressLine progress;
  const CompactResult result =
      CompactArchive(archive, output.empty() ? archive : output, StopOnSignals(), progress.meter());
  progress.Stop();
  WriteOut(Headline(output.empty() ? archive : output, result));
  SayLeftAlone(result);
  if (result.stopped) return 128 + SIGINT;
  return result.left_alone.empty() ? 0 : 1;
}

}  // namespace stipple
