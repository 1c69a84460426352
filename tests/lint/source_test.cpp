// SPDX-License-Identifier: MIT
// Rules of style that reading the text can check: licence line, short functions, nothing imported
// by headers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = STIPPLE_SOURCE_DIR;
constexpr std::size_t kLongestFunction = 60;

// Longer functions and why.
const std::map<std::string, std::string> kLongFunctions = {
    {"analysis/trace/scan.h:ScanSome", "the reader's hot loop; its state stays in registers"}};

std::vector<std::string> FilesEndingIn(const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  for (const char* part : {"plugin", "runtime", "raytracer", "analysis", "tests"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / part)) {
      if (std::ranges::find(extensions, entry.path().extension().string()) != extensions.end())
        files.push_back(fs::relative(entry.path(), kRoot));
    }
  }
  std::ranges::sort(files);
  return files;
}

std::vector<std::string> Lines(const std::string& file) {
  std::ifstream in(kRoot / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// A body at column 0, as clang-format lays it out: from the line that begins its declaration to
/// its closing brace. `name` is the word before the first parenthesis.
struct Body {
  std::string name;
  std::size_t begin, end;  // lines, from 0
};

std::vector<Body> FunctionsOf(const std::vector<std::string>& lines) {
  static const std::regex not_a_function(
      "^(namespace|extern \"C\"|class|struct|union|enum|template|#|//|\\}|[A-Z_]+\\().*");
  static const std::regex name("([A-Za-z_0-9:~]+)\\(");
  std::vector<Body> bodies;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    if (!line.empty() && line[0] != ' ' && line[0] != '}') begin = i;
    if (line != "}") continue;
    std::smatch match;
    const std::string& first = lines[begin];
    if (!std::regex_match(first, not_a_function) && std::regex_search(first, match, name))
      bodies.push_back({match[1], begin, i});
  }
  return bodies;
}

TEST(Style, FunctionsAreShort) {
  std::size_t count = 0;
  for (const std::string& file : FilesEndingIn({".cpp", ".c", ".h"})) {
    for (const Body& body : FunctionsOf(Lines(file))) {
      ++count;
      if (!kLongFunctions.contains(file + ":" + body.name)) {
        EXPECT_LE(body.end - body.begin + 1, kLongestFunction)
            << file << ":" << body.begin + 1 << " " << body.name;
      }
    }
  }
  EXPECT_GT(count, 300U) << "the search found too little to be true";
}

TEST(Style, EverySourceNamesItsLicence) {
  for (const std::string& file :
       FilesEndingIn({".cpp", ".c", ".h", ".def", ".S", ".sh", ".f", ".f90"})) {
    const std::vector<std::string> lines = Lines(file);
    const auto end =
        lines.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, lines.size()));
    const bool found = std::any_of(lines.begin(), end, [](const std::string& line) {
      return line.find("SPDX-License-Identifier: MIT") != std::string::npos;
    });
    EXPECT_TRUE(found) << file << " has no line 'SPDX-License-Identifier: MIT' at its top";
  }
}

// clang 14 cannot compile GCC 12's subranges, so no algorithm of std::ranges that returns one.
TEST(Style, NothingThatClang14CannotCompile) {
  static const std::regex kSubrange(
      "ranges::(unique|remove|remove_if|partition|stable_partition|equal_range|rotate|search|"
      "find_end|subrange)\\b");
  for (const std::string& file : FilesEndingIn({".cpp", ".h"})) {
    for (const std::string& line : Lines(file))
      EXPECT_FALSE(std::regex_search(line, kSubrange)) << file << ": " << line;
  }
}

// lint_headers relies on it.
TEST(Style, ASourceIncludesItsOwnHeaderFirst) {
  for (const std::string& file : FilesEndingIn({".cpp"})) {
    const fs::path header = fs::path(file).replace_extension(".h");
    if (!fs::exists(kRoot / header)) continue;
    const std::vector<std::string> lines = Lines(file);
    const auto first = std::ranges::find_if(
        lines, [](const std::string& line) { return line.starts_with("#include"); });
    ASSERT_NE(first, lines.end()) << file;
    EXPECT_NE(first->find(header.filename().string() + '"'), std::string::npos)
        << file << " begins with " << *first;
  }
}

TEST(Style, HeadersImportNoNames) {
  for (const std::string& file : FilesEndingIn({".h"})) {
    for (const std::string& line : Lines(file))
      EXPECT_EQ(line.find("using namespace"), std::string::npos) << file << ": " << line;
  }
}

}  // namespace
