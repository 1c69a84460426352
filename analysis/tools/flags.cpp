// SPDX-License-Identifier: MIT
// stipple flags: what makes a compiler trace.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>

#include "analysis/tools/command.h"
#include "analysis/tools/options.h"
#include "analysis/tools/process.h"
#include "analysis/tools/selection_account.h"
#include "analysis/trace/input_error.h"
#include "analysis/trace/stream.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// The program file that would run, links resolved; empty if there is none.
fs::path FileOf(const std::string& program) {
  std::error_code error;
  if (program.find('/') != std::string::npos) return fs::canonical(program, error);
  const char* path = std::getenv("PATH");
  std::istringstream directories(path == nullptr ? "" : path);
  for (std::string directory; std::getline(directories, directory, ':');) {
    const fs::path file = fs::path(directory.empty() ? "." : directory) / program;
    if (access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file, error))
      return fs::canonical(file, error);
  }
  return {};
}

/// Folder of the plugin, from where distributions keep compilers: x86_64-linux-gnu-g++-12,
/// llvm-14/bin/clang. Wrappers ask for every file they compile, and to run a compiler takes longer
/// than all else; a plugin says so itself when it is not the compiler's. Empty: not to be seen.
std::string FolderByName(const fs::path& file) {
  static const std::regex gcc("(^|.*-)(gcc|g\\+\\+|gfortran)-([0-9]+)");
  static const std::regex llvm(".*/llvm-([0-9]+)/bin/clang(\\+\\+)?(-[0-9]+)?");
  std::smatch match;
  const std::string name = file.filename();
  if (std::regex_match(name, match, gcc)) return "gcc-" + match[3].str();
  if (std::regex_match(file.native(), match, llvm)) return "llvm-" + match[1].str();
  return {};
}

/// Folder of the compiler's plugin: "gcc-12", "llvm-14". Asks the compiler, so that a wrapper
/// (mpicxx) answers for the one behind it.
std::string FolderOf(const std::string& compiler) {
  if (std::string folder = FolderByName(FileOf(compiler)); !folder.empty()) return folder;
  const std::optional<std::string> version = OutputOf({compiler, "--version"});
  if (!version)
    throw InputError("stipple flags", "'" + compiler + " --version' cannot be run: no compiler?");
  std::smatch match;
  static const std::regex clang("clang version ([0-9]+)");
  if (std::regex_search(*version, match, clang)) return fmt::format("llvm-{}", match[1].str());
  if (version->find("Free Software Foundation") == std::string::npos)
    throw InputError("stipple flags", "'" + compiler + "' is neither GCC nor clang");
  // "g++ (Debian 12.2.0-14) 12.2.0"
  static const std::regex number("^[^\\n]* ([0-9]+)\\.[0-9.]+( [^\\n]*)?\\n");
  if (std::regex_search(*version, match, number)) return fmt::format("gcc-{}", match[1].str());
  throw InputError("stipple flags", "'" + compiler + "' does not tell its version");
}

/// Folders that hold a plugin, sorted.
std::vector<std::string> KnownFolders() {
  std::vector<std::string> folders;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(LibraryDirectory(), error))
    if (fs::exists(entry.path() / "stipple.so")) folders.push_back(entry.path().filename());
  std::ranges::sort(folders);
  return folders;
}

fs::path PluginOf(const std::string& compiler) {
  const std::string folder = FolderOf(compiler);
  fs::path plugin = fs::path(LibraryDirectory()) / folder / "stipple.so";
  if (plugin.native().find_first_of(" \t") != std::string::npos)
    throw InputError(LibraryDirectory(), "flags cannot name a path with a space in it");
  if (fs::exists(plugin)) return plugin;
  std::string known;
  for (const std::string& name : KnownFolders()) known.append(" ").append(name);
  throw InputError("stipple flags",
                   fmt::format("no plugin for {} ({}); there are plugins for:{}; with "
                               "-finstrument-functions every compiler does",
                               compiler, folder, known.empty() ? " none" : known));
}

std::string FlagsOf(const fs::path& plugin, bool link, bool is_static) {
  const bool gcc = plugin.parent_path().filename().string().starts_with("gcc-");
  std::string flags;
  if (gcc) {  // with -flto functions are compiled, and instrumented, when linking
    flags = fmt::format("-fplugin={}", plugin.string());
  } else if (!link) {
    // clang forgets files and lines unless asked for debug information or remarks. -g... would
    // replace the user's own -g; remarks of passes named so, of which there are none, change no
    // byte of the object.
    flags = fmt::format(
        "-fplugin={0} -fpass-plugin={0} -Rpass=stipple -Wno-unused-command-line-argument",
        plugin.string());
  }
  if (is_static)
    flags += fmt::format(
        "{}-Wl,-u,stipple_register,-u,stipple_record_mark,-u,__cyg_profile_func_enter -L{} "
        "-lstipple",
        flags.empty() ? "" : " ", LibraryDirectory());
  return flags;
}

/// What the plugin left out of OBJECT, and why.
std::string ExplanationOf(const std::string& object) {
  const std::optional<MappedFile> file = MappedFile::Open(object);
  if (!file) throw InputError(object, "cannot be read");
  SelectionAccount account;
  switch (ReadAccount(file->bytes(), account)) {
    case AccountProblem::kNotElf:
      throw InputError(object, "is no object file, library or program for x86-64");
    case AccountProblem::kThinArchive:
      throw InputError(object, "is a thin archive, which holds no objects; name those");
    case AccountProblem::kNone:
      break;
  }
  if (account.empty())
    throw InputError(object,
                     "does not say what was instrumented: it was built without the plugin, has no "
                     "functions of its own, or was compiled with GCC's -flto, where functions are "
                     "selected when linking: name the program");
  return Explain(account);
}

}  // namespace

int RunFlags(const Arguments& arguments) {
  CommandOptions app(
      "Print the flags that make a compiler trace, or say that there is no plugin for it.",
      "flags");
  std::string compiler;
  std::string object;
  bool link = false;
  bool is_static = false;
  app.Add({"COMPILER", "", "g++, clang++, mpicxx, gfortran, ..."}, compiler);
  app.Add({"--link", "", "what linking needs: with -flto, or --static"}, link);
  app.Add({"--static", "", "with --link: for -static", false, "--link"}, is_static);
  app.Add(
      {"--explain", "OBJECT", "say what was left out of an object, library or program, and why"},
      object);
  if (!app.Parse(arguments)) return 0;
  if (object.empty() == compiler.empty())
    throw InputError("stipple flags", "takes either COMPILER or --explain OBJECT");
  if (!object.empty()) {
    WriteOut(ExplanationOf(object));
    return 0;
  }
  WriteOut(FlagsOf(PluginOf(compiler), link, is_static) + "\n");
  return 0;
}

}  // namespace stipple
