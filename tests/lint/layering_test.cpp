// SPDX-License-Identifier: MIT
// Arrows between the parts point one way: every #include in the tree is held against the table
// below.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// A folder, what it may include of this tree besides itself, and which libraries' headers.
struct PartRule {
  std::string folder;
  std::vector<std::string> parts;  // folders or single headers, relative to the root
  std::vector<std::string>
      libraries;  // prefixes of <...> includes that are not the standard library, libc or Linux
};

const std::string kAbi = "runtime/include/stipple/abi.h";
const std::string kFormat = "runtime/include/stipple/format.h";
const std::string kUser = "runtime/include/stipple/user.h";
const std::string kFilter = "runtime/include/stipple/filter.h";

// The longest folder that holds a file rules it.
const std::vector<PartRule> kRules = {
    {"runtime/include", {}, {}},
    {"plugin/select", {kFilter}, {}},
    {"plugin", {kAbi}, {}},
    {"plugin/gcc", {kAbi, "plugin/select", "plugin"}, {"gcc-plugin.h", "*gcc"}},
    {"plugin/llvm", {kAbi, "plugin/select", "plugin"}, {"llvm/", "clang/"}},
    {"runtime/core", {kAbi, kFormat, kUser, kFilter}, {}},
    {"runtime/system", {kAbi, kFormat, "runtime/core"}, {}},
    {"runtime/unwind", {kFormat}, {"libunwind"}},
    {"runtime/mpi", {kFormat, "runtime/core"}, {"mpi.h"}},
    {"raytracer", {kUser}, {"mpi.h", "png.h", "fmt/", "nlohmann/", "CLI/"}},
    {"raytracer/geometry", {"raytracer", kUser}, {"embree", "hwy/"}},
    {"raytracer/image", {"raytracer", kUser}, {"png.h", "OpenEXR/", "fmt/"}},
    {"raytracer/simulate", {"raytracer", kUser}, {"simgrid/", "smpi/", "mpi.h", "fmt/"}},
    {"analysis/trace", {kFormat}, {"fmt/", "zstd.h", "elfutils/", "dwarf.h"}},
    {"analysis/stats", {kFormat, "analysis/trace"}, {"fmt/"}},
    {"analysis/views", {"analysis/stats", "analysis/trace"}, {"fmt/", "vtk", "librsvg/", "cairo"}},
    {"analysis/report",
     {"analysis/views", "analysis/stats", "analysis/trace", kFormat},
     {"fmt/", "nlohmann/"}},
    {"analysis/exchange",
     {"analysis/report", "analysis/views", "analysis/stats", "analysis/trace", kFormat},
     {"fmt/", "nlohmann/", "otf2/"}},
    {"analysis/exemplar",
     {"analysis/exchange", "analysis/report", "analysis/views", "analysis/stats", "analysis/trace"},
     {"fmt/", "nlohmann/"}},
    {"analysis/tools",
     {"analysis/exemplar", "analysis/exchange", "analysis/report", "analysis/stats",
      "analysis/trace", kFormat, kFilter},
     {"fmt/", "nlohmann/", "CLI/"}},
};

const fs::path kRoot = STIPPLE_SOURCE_DIR;

const PartRule* RuleOf(const std::string& file) {
  const PartRule* best = nullptr;
  for (const PartRule& rule : kRules) {
    if (file.starts_with(rule.folder + "/") &&
        (best == nullptr || rule.folder.size() > best->folder.size())) {
      best = &rule;
    }
  }
  return best;
}

std::vector<std::string> SourceFiles() {
  std::vector<std::string> files;
  for (const char* part : {"plugin", "runtime", "raytracer", "analysis"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / part)) {
      const std::string extension = entry.path().extension();
      if (extension == ".h" || extension == ".cpp" || extension == ".c" || extension == ".def") {
        files.push_back(fs::relative(entry.path(), kRoot));
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

std::vector<std::string> Lines(const fs::path& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The file of this tree that `name`, included from `file`, means; empty if it is none of ours.
std::string Resolve(const std::string& file, const std::string& name) {
  const fs::path from = fs::path(file).parent_path();
  for (const fs::path& base : {from, fs::path(""), fs::path("runtime/include"), fs::path("runtime"),
                               fs::path("raytracer"), fs::path("analysis"), fs::path("plugin")}) {
    const fs::path candidate = (base / name).lexically_normal();
    if (fs::is_regular_file(kRoot / candidate)) return candidate;
  }
  return {};
}

bool Allowed(const PartRule& rule, const std::string& target) {
  if (target.starts_with(rule.folder + "/")) return true;
  return std::ranges::any_of(rule.parts, [&](const std::string& part) {
    return target == part || target.starts_with(part + "/");
  });
}

/// Headers of libraries, as against the standard library, libc and Linux. GCC's own plugin headers
/// have plain names and are only on the path of plugin/gcc, so they need no row.
bool IsLibrary(const std::string& name) {
  static const std::regex kPattern(
      "(mpi\\.h|png\\.h|OpenEXR/.*|fmt/.*|nlohmann/.*|CLI/.*|vtk.*|llvm/.*|clang/.*|embree.*|hwy/.*|"
      "simgrid/.*|smpi/.*|otf2/.*|zstd\\.h|elfutils/.*|libunwind.*|gcc-plugin\\.h)");
  return std::regex_match(name, kPattern);
}

struct Include {
  std::string file;
  std::string name;
};

std::vector<Include> AllIncludes() {
  static const std::regex kInclude("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"].*");
  std::vector<Include> includes;
  for (const std::string& file : SourceFiles()) {
    for (const std::string& line : Lines(kRoot / file)) {
      std::smatch match;
      if (std::regex_match(line, match, kInclude)) includes.push_back({file, match[1]});
    }
  }
  return includes;
}

TEST(Layering, EveryIncludeIsAllowedByTheTable) {
  const std::vector<Include> includes = AllIncludes();
  ASSERT_GT(includes.size(), 100u) << "the walk found too little to be true";
  for (const Include& include : includes) {
    const PartRule* rule = RuleOf(include.file);
    ASSERT_NE(rule, nullptr) << include.file << " lies in no part of the table";
    const std::string target = Resolve(include.file, include.name);
    if (!target.empty()) {
      EXPECT_TRUE(Allowed(*rule, target)) << include.file << " may not include " << target;
    } else if (IsLibrary(include.name)) {
      const bool known = std::ranges::any_of(rule->libraries, [&](const std::string& library) {
        return include.name.starts_with(library);
      });
      EXPECT_TRUE(known) << include.file << " may not include <" << include.name << ">";
    }
  }
}

TEST(Layering, NoCycles) {
  std::map<std::string, std::set<std::string>> graph;
  for (const Include& include : AllIncludes()) {
    const std::string target = Resolve(include.file, include.name);
    if (!target.empty()) graph[include.file].insert(target);
  }
  // Strikes out files that include nothing left over; what remains includes itself.
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& [file, targets] : graph) {
      changed |= std::erase_if(targets, [&](const std::string& target) {
                   return graph.find(target) == graph.end() || graph[target].empty();
                 }) > 0;
    }
  }
  for (const auto& [file, targets] : graph)
    EXPECT_TRUE(targets.empty()) << file << " is in a cycle";
}

TEST(Layout, FilesAreShort) {
  // Tables of data may be longer: rows, not logic.
  const std::set<std::string> tables = {"runtime/mpi/calls.def"};
  for (const std::string& file : SourceFiles()) {
    if (!tables.contains(file)) {
      EXPECT_LE(Lines(kRoot / file).size(), 600u) << file;
    }
  }
}

TEST(Layout, TheRootHoldsOnlyWhatIsListed) {
  const std::set<std::string> known = {"CMakeLists.txt",
                                       "CMakePresets.json",
                                       "CONTRIBUTING.md",
                                       "LICENSE",
                                       "README.md",
                                       "analysis",
                                       "cmake",
                                       "docs",
                                       "packages.txt",
                                       "plugin",
                                       "raytracer",
                                       "run",
                                       "runtime",
                                       "tests",
                                       "build"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(".") || name.starts_with("demo.")) continue;
    EXPECT_TRUE(known.contains(name)) << name << " does not belong in the root";
  }
}

}  // namespace
