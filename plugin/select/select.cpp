// SPDX-License-Identifier: MIT
#include "plugin/select/select.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace stipple::plugin {
namespace {

bool StartsWithAny(std::string_view name, std::initializer_list<std::string_view> prefixes) {
  return std::ranges::any_of(prefixes, [&](std::string_view p) { return name.starts_with(p); });
}

// Thunks, thread-local wrappers, and what runs a file's constructors and destructors.
bool IsCompilersOwn(std::string_view linkage_name) {
  return StartsWithAny(
      linkage_name,
      {"_ZTh", "_ZTv", "_ZTc", "_ZTW", "_ZTH", "_GLOBAL__", "__cxx_global_", "__tcf_",
       "_Z41__static_initialization_and_destruction_0", "__static_initialization_and_destruction_0",
       "__clang_call_terminate", "__tls_init"});
}

// Without debug information LLVM does not know where a template came from, but its name tells.
bool IsInNamespaceStd(std::string_view linkage_name) {
  return StartsWithAny(linkage_name, {"_ZSt", "_ZNSt", "_ZNKSt", "_ZNSa", "_ZNSs", "_ZNKSs",
                                      "_ZNSo", "_ZNSi", "_ZNSd", "_ZNKSa", "_ZN9__gnu_cxx"});
}

// Fortran has no attribute with which the module stipple (stipple.f90) could say it itself.
bool IsManualEvent(std::string_view linkage_name) {
  return linkage_name.starts_with("__stipple_MOD_");
}

struct ReasonSpec {
  bool instruments;
  std::string_view text;
};
constexpr ReasonSpec kReasons[] = {
    // as in Reason
    {false, "forbidden by attribute"},
    {false, "made by the compiler"},
    {false, "named by exclude-function-list"},
    {true, "asked for by attribute"},
    {true, "named by include-function-list"},
    {false, "file named by exclude-file-list"},
    {false, "excluded by filter-file"},
    {true, "included by filter-file"},
    {false, "system header"},
    {false, "trivial"},
    {true, "nothing speaks against it"},
};

const ReasonSpec& SpecOf(Reason reason) { return kReasons[static_cast<std::size_t>(reason)]; }

// A field of the account: no tab, no line end, no zero.
std::string Field(std::string_view text) {
  std::string field;
  for (const char c : text) {
    if (c == '\\') field += '\\';
    if (c == '\t' || c == '\n' || c == '\0')
      field += c == '\t' ? "\\t" : c == '\n' ? "\\n" : "\\0";
    else
      field += c;
  }
  return field;
}

std::string Join(std::initializer_list<std::string_view> fields) {
  std::string text;
  for (const std::string_view field : fields) {
    if (!text.empty()) text += '\t';
    text += Field(field);
  }
  return text;
}

// FNV-1a of what makes two functions the same one to the runtime.
std::string IdentityOf(std::string_view name, std::string_view file, unsigned line) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : Join({name, file, std::to_string(line)}))
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

std::string_view RegionName(const FunctionFacts& facts) {
  std::string_view name = facts.linkage_name;
  if (!name.empty() && name.front() == '\1') name.remove_prefix(1);  // LLVM: given by an asm label
  return WithoutCloneSuffix(name);
}

}  // namespace

std::optional<std::string> Selection::ReadFilterFile() {
  const std::string& path = options_.filter_file;
  if (path.empty()) return std::nullopt;
  const auto failed = [&path](int error) {
    return "stipple: filter-file " + path + ": " + std::strerror(error);
  };
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return failed(errno);
  char buffer[4096];
  filter_text_.clear();
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
    filter_text_.append(buffer, n);
  const int error = std::ferror(file) != 0 ? errno : 0;
  std::fclose(file);
  if (error != 0) return failed(error);

  FilterProblem problem;
  filter_.resize(ReadFilter(filter_text_, nullptr, 0, problem));
  ReadFilter(filter_text_, filter_.data(), filter_.size(), problem);
  if (problem.line == 0) return std::nullopt;
  return path + ":" + std::to_string(problem.line) + ": '" + std::string(problem.word) + "' " +
         problem.what;
}

bool Selection::OccursIn(const NameList& list, std::string_view a, std::string_view b) {
  bool occurs = false;
  for (const std::string& part : list) {
    if (a.find(part) == a.npos && b.find(part) == b.npos) continue;
    matched_.insert(&part);
    occurs = true;
  }
  return occurs;
}

FilterAnswer Selection::Filtered(const FunctionFacts& facts) {
  std::string buffer = facts.linkage_name;
  const std::string_view linkage = RegionName(facts);
  const std::string_view fortran = FilterFortranName(linkage, buffer.data(), buffer.size());
  return ApplyFilter(filter_.data(), filter_.size(),
                     {fortran.empty() ? facts.name : fortran, linkage, facts.file});
}

Reason Selection::ReasonOf(const FunctionFacts& facts) {
  // All of them are asked, whichever decides: a list entry that names a function is no mistake.
  const bool excluded = OccursIn(options_.exclude_functions, facts.name, facts.linkage_name);
  const bool included = OccursIn(options_.include_functions, facts.name, facts.linkage_name);
  const bool file_excluded = OccursIn(options_.exclude_files, facts.file, {});
  const FilterAnswer filtered = Filtered(facts);

  if (facts.wish == Wish::kNever || IsManualEvent(facts.linkage_name))
    return Reason::kAttributeNever;
  if (facts.artificial || IsCompilersOwn(facts.linkage_name)) return Reason::kArtificial;
  if (excluded) return Reason::kExcludedFunction;
  if (facts.wish == Wish::kAlways) return Reason::kAttributeAlways;
  if (included) return Reason::kIncludedFunction;
  if (file_excluded) return Reason::kExcludedFile;
  if (filtered == FilterAnswer::kExcluded) return Reason::kFilterExcluded;
  if (filtered == FilterAnswer::kIncluded) return Reason::kFilterIncluded;
  const bool in_system = facts.in_system_header || IsInNamespaceStd(facts.linkage_name);
  if (in_system && !options_.system_headers) return Reason::kSystemHeader;
  const bool loops = facts.has_loop && !options_.ignore_loops;
  const bool is_short = facts.instructions < options_.instruction_threshold;
  return is_short && !loops && !facts.makes_calls ? Reason::kTrivial : Reason::kDefault;
}

Answer Selection::Select(const FunctionFacts& facts) {
  const Reason reason = ReasonOf(facts);
  const std::string_view name = RegionName(facts);
  const std::string identity = IdentityOf(name, facts.file, facts.line);
  if (SpecOf(reason).instruments)
    account_.insert(Join({"in:", identity}));
  else
    account_.insert(
        Join({"out:", identity, Text(reason), name, std::to_string(facts.line), facts.file}));
  return {SpecOf(reason).instruments, reason};
}

std::string Selection::Note() const {
  std::string given = options_.filter_file;
  for (const NameList* list :
       {&options_.exclude_functions, &options_.exclude_files, &options_.include_functions}) {
    for (const std::string& part : *list) given += (given.empty() ? "" : ", ") + part;
  }
  const bool any = !matched_.empty() || std::ranges::any_of(filter_, &FilterRule::matched);
  if (given.empty() || account_.empty() || any) return "";
  return "stipple: note: nothing in this file matches " + given;
}

void Selection::AddRules() {
  const auto add = [this](std::string_view where, std::string_view text, bool matched) {
    account_.insert(Join({"rule:", where, text, matched ? "matched" : "unmatched"}));
  };
  const auto add_list = [&](std::string_view where, const NameList& list) {
    for (const std::string& part : list) add(where, part, matched_.contains(&part));
  };
  add_list("exclude-function-list", options_.exclude_functions);
  add_list("exclude-file-list", options_.exclude_files);
  add_list("include-function-list", options_.include_functions);
  for (const FilterRule& rule : filter_)
    add(options_.filter_file + ":" + std::to_string(rule.line), rule.pattern, rule.matched);
}

const std::set<std::string>& Selection::Account() {
  if (!account_.empty()) AddRules();
  return account_;
}

std::string_view Text(Reason reason) { return SpecOf(reason).text; }

std::string_view WithoutCloneSuffix(std::string_view linkage_name) {
  const std::size_t dot = linkage_name.find('.');
  // An outlined parallel region is code of its own, and a leading dot is a name.
  if (dot == std::string_view::npos || dot == 0 || linkage_name.substr(dot).starts_with("._omp_fn"))
    return linkage_name;
  return linkage_name.substr(0, dot);
}

}  // namespace stipple::plugin
