// SPDX-License-Identifier: MIT
#include "plugin/select/select.h"

#include <algorithm>

namespace stipple::plugin {
namespace {

bool OccursIn(std::string_view name, const NameList& list) {
  return std::ranges::any_of(
      list, [&](const std::string& part) { return name.find(part) != std::string_view::npos; });
}

bool Matches(const FunctionFacts& facts, const NameList& list) {
  return OccursIn(facts.name, list) || OccursIn(facts.linkage_name, list);
}

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

constexpr bool kInstruments[] = {
    false, false, false, true, true, false, false, false, true,
};

Reason ReasonOf(const FunctionFacts& facts, const Options& options) {
  if (facts.wish == Wish::kNever) return Reason::kAttributeNever;
  if (facts.artificial || IsCompilersOwn(facts.linkage_name)) return Reason::kArtificial;
  if (Matches(facts, options.exclude_functions)) return Reason::kExcludedFunction;
  if (facts.wish == Wish::kAlways) return Reason::kAttributeAlways;
  if (Matches(facts, options.include_functions)) return Reason::kIncludedFunction;
  if (OccursIn(facts.file, options.exclude_files)) return Reason::kExcludedFile;
  if (facts.in_system_header || IsInNamespaceStd(facts.linkage_name)) return Reason::kSystemHeader;
  const bool trivial =
      facts.instructions < options.instruction_threshold && !facts.has_loop && !facts.makes_calls;
  return trivial ? Reason::kTrivial : Reason::kDefault;
}

}  // namespace

Answer Select(const FunctionFacts& facts, const Options& options) {
  const Reason reason = ReasonOf(facts, options);
  return {kInstruments[static_cast<std::size_t>(reason)], reason};
}

std::string_view Text(Reason reason) {
  switch (reason) {
    case Reason::kAttributeNever:
      return "an attribute forbids it";
    case Reason::kArtificial:
      return "the compiler made it";
    case Reason::kExcludedFunction:
      return "exclude-function-list names it";
    case Reason::kAttributeAlways:
      return "an attribute asks for it";
    case Reason::kIncludedFunction:
      return "include-function-list names it";
    case Reason::kExcludedFile:
      return "exclude-file-list names its file";
    case Reason::kSystemHeader:
      return "its file is a system header";
    case Reason::kTrivial:
      return "shorter than instruction-threshold, no loop, no call";
    case Reason::kDefault:
      return "nothing speaks against it";
  }
  return "";
}

std::string_view WithoutCloneSuffix(std::string_view linkage_name) {
  const std::size_t dot = linkage_name.find('.');
  // An outlined parallel region is code of its own, and a leading dot is a name.
  if (dot == std::string_view::npos || dot == 0 || linkage_name.substr(dot).starts_with("._omp_fn"))
    return linkage_name;
  return linkage_name.substr(0, dot);
}

}  // namespace stipple::plugin
