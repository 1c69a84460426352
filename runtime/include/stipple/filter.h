// SPDX-License-Identifier: MIT
// Filter files: which functions to record, in the syntax of Score-P. Read by the plugins (at
// compile time), by runtime/core (at run time) and by the tool (to refuse a broken file before a
// program starts), so it allocates nothing, throws nothing, calls nothing and works on a text in
// memory.
//
//   # a comment, to the end of the line
//   SCOREP_FILE_NAMES_BEGIN
//     EXCLUDE */third_party/*              one or more patterns, separated by white space
//     INCLUDE */third_party/solver.c
//   SCOREP_FILE_NAMES_END
//   SCOREP_REGION_NAMES_BEGIN
//     EXCLUDE *
//     INCLUDE solver::* f(int,\ int)        a blank, # or \ in a name stands behind a backslash
//     EXCLUDE MANGLED _ZN6solver4dumpEv    MANGLED: the linkage name. DEMANGLED: back again
//   SCOREP_REGION_NAMES_END
//
// At first everything is included; rules are applied in order, and the last one that matches
// decides. A function is excluded if its file or its name is. Patterns match the whole name as
// fnmatch() does it (no flags, bytes): `*` (slashes too), `?`, `[a-z]`, `[!a]`, `[[:digit:]]`,
// `\x`. File rules are matched with the file as the compiler was given it; a function whose file is
// not known matches none.
//
// How to use it: call ReadFilter once without room to count the rules and find problems, get memory
// for them, call it again to fill it, then ApplyFilter per function. The rules point into the text.
//
// Demangled names: a region rule without MANGLED is matched with the name as people write it
// (`geometry::Bvh::Build(int)`, `solver::step` of a Fortran module). The caller brings it, and only
// has to if NeedsDemangledNames. The plugins and the tool have demanglers. The runtime has linkage
// names; it turns Fortran's with FilterFortranName, those that begin with _Z with the program's own
// `__cxa_demangle`: a weak reference finds it where libstdc++ (libc++abi) was linked, statically or
// not; dlopen("libstdc++.so.6", RTLD_NOLOAD) and dlsym where a C program opened a C++ library. It
// calls the program's malloc, which is allowed while an object registers, but not with the
// runtime's lock held: the program's malloc may have events of its own. Where there is none, which
// takes a C++ program without C++ runtime, `demangled` is the linkage name and the runtime says so
// once. All others are C or assembly, where both names are the same.
#ifndef STIPPLE_FILTER_H
#define STIPPLE_FILTER_H

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace stipple {

struct FilterRule {
  std::string_view pattern;  // as written, with its backslashes; points into the text
  std::uint32_t line;        // in the text, from 1
  bool of_files;             // else of regions
  bool excludes;             // else includes
  bool mangled;              // of regions: matched with the linkage name
  bool matched;              // set by ApplyFilter: its pattern matched some name
};

/// Why a text is no filter, to be printed as "FILE:LINE: 'WORD' WHAT".
struct FilterProblem {
  std::uint32_t line;  // 0: there is none
  std::string_view word;
  const char* what;
};

/// A function as the rules see it. An empty file is not known.
struct FilterNames {
  std::string_view demangled;
  std::string_view linkage;
  std::string_view file;
};

enum class FilterAnswer {
  kNoRule,    // included, as everything is
  kIncluded,  // an INCLUDE of more than `*` named the function, and nothing excluded it later
  kExcluded,
};

namespace filter_detail {

// Only pointers are read below, and literals bring their lengths: string_view's own comparisons
// call memcmp, its constructor strlen, its substr may throw.
using std::string_view_literals::operator""sv;

inline bool Is(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a.data()[i] != b.data()[i]) return false;
  return true;
}

inline bool IsStar(std::string_view pattern) { return Is(pattern, "*"sv); }

inline bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The character that stands at `at`, behind a backslash if there is one; `at` moves behind it.
inline unsigned char TakeCharacter(const char*& at, const char* end) {
  if (*at == '\\' && at + 1 < end) ++at;
  return static_cast<unsigned char>(*at++);
}

/// Whether `c` is of the class `name` in the C locale; false for a name that is none.
inline bool IsOfClass(std::string_view name, unsigned char c) {
  const bool lower = c >= 'a' && c <= 'z', upper = c >= 'A' && c <= 'Z';
  const bool digit = c >= '0' && c <= '9', graph = c > 0x20 && c < 0x7f;
  const bool blank = c == ' ' || c == '\t';
  const struct {
    std::string_view name;
    bool holds;
  } classes[] = {{"alpha"sv, lower || upper},
                 {"digit"sv, digit},
                 {"alnum"sv, lower || upper || digit},
                 {"upper"sv, upper},
                 {"lower"sv, lower},
                 {"space"sv, blank || (c >= '\n' && c <= '\r')},
                 {"blank"sv, blank},
                 {"punct"sv, graph && !lower && !upper && !digit},
                 {"print"sv, graph || c == ' '},
                 {"graph"sv, graph},
                 {"cntrl"sv, c < 0x20 || c == 0x7f},
                 {"xdigit"sv, digit || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')}};
  for (const auto& row : classes)
    if (Is(row.name, name)) return row.holds;
  return false;
}

/// The end of a class `[:name:]` that begins at `at`, or null.
inline const char* EndOfClass(const char* at, const char* end) {
  if (end - at < 4 || at[0] != '[' || at[1] != ':') return nullptr;
  for (at += 2; at + 1 < end && *at >= 'a' && *at <= 'z';) ++at;
  return at + 1 < end && at[0] == ':' && at[1] == ']' ? at + 2 : nullptr;
}

/// Compares `c` with the bracket expression that begins behind its `[`, at `at`, and moves `at`
/// behind its `]`; leaves `at` alone and answers false if it has none.
inline bool MatchBracket(const char*& at, const char* end, unsigned char c) {
  const char* p = at;
  const bool negated = p < end && (*p == '!' || *p == '^');
  if (negated) ++p;
  bool found = false;
  for (const char* first = p; p < end;) {
    if (*p == ']' && p != first) {
      at = p + 1;
      return found != negated;
    }
    if (const char* behind = EndOfClass(p, end); behind != nullptr) {
      found |= IsOfClass({p + 2, static_cast<std::size_t>(behind - p - 4)}, c);
      p = behind;
      continue;
    }
    const unsigned char low = TakeCharacter(p, end);
    unsigned char high = low;
    if (end - p >= 2 && p[0] == '-' && p[1] != ']') high = TakeCharacter(++p, end);
    found |= low <= c && c <= high;
  }
  return false;
}

/// Whether the pattern's next element, not a `*`, matches `c`; `at` moves behind it if so.
inline bool MatchOne(const char*& at, const char* end, unsigned char c) {
  const char* p = at;
  bool matches = false;
  if (*p == '?') {
    matches = true;
    ++p;
  } else if (*p == '[') {
    const char* behind = ++p;
    matches = MatchBracket(behind, end, c);
    if (behind == p) matches = c == '[';  // never closed: a bracket like any other character
    p = behind;
  } else if (*p == '\\' && p + 1 == end) {
    return false;
  } else {
    matches = TakeCharacter(p, end) == c;
  }
  if (matches) at = p;
  return matches;
}

enum class Block { kNone, kFiles, kRegions };

/// What the words read so far mean for the next one.
struct ReadState {
  Block block;
  bool has_verb, excludes, mangled;
};

/// Takes a keyword. Answers what is wrong with it here, "" if it was fine, null if `word` is none.
inline const char* TakeKeyword(ReadState& state, std::string_view word) {
  const Block begins = Is(word, "SCOREP_FILE_NAMES_BEGIN"sv)     ? Block::kFiles
                       : Is(word, "SCOREP_REGION_NAMES_BEGIN"sv) ? Block::kRegions
                                                                 : Block::kNone;
  const Block ends = Is(word, "SCOREP_FILE_NAMES_END"sv)     ? Block::kFiles
                     : Is(word, "SCOREP_REGION_NAMES_END"sv) ? Block::kRegions
                                                             : Block::kNone;
  if (begins != Block::kNone) {
    if (state.block != Block::kNone) return "stands inside another block";
    state = {begins, false, false, false};
    return "";
  }
  if (ends != Block::kNone) {
    if (state.block != ends) return "ends a block that has not begun";
    state = {Block::kNone, false, false, false};
    return "";
  }
  if (Is(word, "EXCLUDE"sv) || Is(word, "INCLUDE"sv)) {
    if (state.block == Block::kNone)
      return "stands outside SCOREP_FILE_NAMES_BEGIN/END and SCOREP_REGION_NAMES_BEGIN/END";
    state = {state.block, true, word.data()[0] == 'E', false};
    return "";
  }
  if (Is(word, "MANGLED"sv) || Is(word, "DEMANGLED"sv)) {
    if (state.block != Block::kRegions || !state.has_verb)
      return "belongs behind INCLUDE or EXCLUDE of a region block";
    state.mangled = word.data()[0] == 'M';
    return "";
  }
  return nullptr;
}

/// What is wrong with a pattern here, or null.
inline const char* ProblemOfPattern(const ReadState& state, std::string_view word) {
  if (state.block == Block::kNone)
    return "stands outside SCOREP_FILE_NAMES_BEGIN/END and SCOREP_REGION_NAMES_BEGIN/END";
  if (!state.has_verb) return "stands before any INCLUDE or EXCLUDE of its block";
  for (std::size_t i = 0; i < word.size(); ++i)
    if (word.data()[i] == '\0') return "holds a zero byte: this is no text file";
  return nullptr;
}

/// The next word at or behind `at`, which moves behind it; empty at the end. A word ends at a blank
/// or a comment unless escaped; a line's end cannot be escaped. Counts lines.
inline std::string_view NextWord(const char*& at, const char* end, std::uint32_t& line) {
  while (at < end && (IsBlank(*at) || *at == '#')) {
    if (*at == '#') {
      while (at < end && *at != '\n') ++at;
    } else if (*at++ == '\n') {
      ++line;
    }
  }
  const char* begin = at;
  while (at < end && !IsBlank(*at) && *at != '#') {
    if (*at == '\\' && at + 1 < end && at[1] != '\n' && at[1] != '\r') ++at;
    ++at;
  }
  return {begin, static_cast<std::size_t>(at - begin)};
}

/// A backslash at the end of `word` that escapes nothing.
inline bool EndsInLoneBackslash(std::string_view word) {
  std::size_t count = 0;
  while (count < word.size() && word.data()[word.size() - 1 - count] == '\\') ++count;
  return count % 2 == 1;
}

}  // namespace filter_detail

/// Whether the whole of `text` is what `pattern` describes, in time at most the product of their
/// lengths.
inline bool MatchesPattern(std::string_view pattern, std::string_view text) {
  const char* p = pattern.data();
  const char* const pattern_end = p + pattern.size();
  const char* t = text.data();
  const char* const text_end = t + text.size();
  const char* behind_star = nullptr;  // what follows the last star is tried again one further on
  const char* retry = nullptr;
  while (true) {
    if (p < pattern_end && *p == '*') {
      behind_star = ++p;
      retry = t;
    } else if (t == text_end) {
      return p == pattern_end;
    } else if (p < pattern_end &&
               filter_detail::MatchOne(p, pattern_end, static_cast<unsigned char>(*t))) {
      ++t;
    } else if (behind_star == nullptr) {
      return false;
    } else {
      p = behind_star;
      t = ++retry;
    }
  }
}

/// Reads a filter. Returns how many rules it has, of which the first `room` are written to `rules`
/// (null if there is no room); up to the first problem if there is one.
inline std::size_t ReadFilter(std::string_view text, FilterRule* rules, std::size_t room,
                              FilterProblem& problem) {
  problem = {0, {}, nullptr};
  filter_detail::ReadState state{filter_detail::Block::kNone, false, false, false};
  const char* at = text.data();
  const char* const end = at + text.size();
  std::uint32_t line = 1;
  std::size_t count = 0;
  while (true) {
    const std::string_view word = filter_detail::NextWord(at, end, line);
    if (word.empty()) break;
    if (const char* what = filter_detail::TakeKeyword(state, word); what != nullptr) {
      if (*what == '\0') continue;
      problem = {line, word, what};
      return count;
    }
    const char* what = filter_detail::EndsInLoneBackslash(word)
                           ? "ends in a backslash that escapes nothing"
                           : filter_detail::ProblemOfPattern(state, word);
    if (what != nullptr) {
      problem = {line, word, what};
      return count;
    }
    if (count < room)
      rules[count] = {word,           line,          state.block == filter_detail::Block::kFiles,
                      state.excludes, state.mangled, false};
    ++count;
  }
  constexpr std::string_view kFilesEnd = "SCOREP_FILE_NAMES_END";
  constexpr std::string_view kRegionsEnd = "SCOREP_REGION_NAMES_END";
  if (state.block != filter_detail::Block::kNone)
    problem = {line, state.block == filter_detail::Block::kFiles ? kFilesEnd : kRegionsEnd,
               "is missing"};
  return count;
}

/// Applies all rules to a function and marks those that matched.
inline FilterAnswer ApplyFilter(FilterRule* rules, std::size_t count, const FilterNames& names) {
  bool file_excluded = false;
  FilterAnswer answer = FilterAnswer::kNoRule;
  for (FilterRule* rule = rules; rule != rules + count; ++rule) {
    if (rule->of_files && names.file.empty()) continue;
    const std::string_view name = rule->of_files  ? names.file
                                  : rule->mangled ? names.linkage
                                                  : names.demangled;
    if (!MatchesPattern(rule->pattern, name)) continue;
    rule->matched = true;
    if (rule->of_files)
      file_excluded = rule->excludes;
    else if (rule->excludes)
      answer = FilterAnswer::kExcluded;
    else if (!filter_detail::IsStar(rule->pattern))
      answer = FilterAnswer::kIncluded;
    else if (answer == FilterAnswer::kExcluded)
      answer = FilterAnswer::kNoRule;
  }
  return file_excluded ? FilterAnswer::kExcluded : answer;
}

/// Whether any rule looks at `FilterNames::demangled`, but for `*`, which matches whatever it is.
inline bool NeedsDemangledNames(const FilterRule* rules, std::size_t count) {
  for (const FilterRule* rule = rules; rule != rules + count; ++rule)
    if (!rule->of_files && !rule->mangled && !filter_detail::IsStar(rule->pattern)) return true;
  return false;
}

/// gfortran's `__solver_MOD_step` as `solver::step`, in `buffer` of `room` bytes, not terminated.
/// Empty if `linkage_name` is none of those or does not fit; `linkage_name` itself always fits.
inline std::string_view FilterFortranName(std::string_view linkage_name, char* buffer,
                                          std::size_t room) {
  constexpr std::string_view kMod = "_MOD_";
  const char* const begin = linkage_name.data();
  const std::size_t bytes = linkage_name.size();
  if (bytes < 3 + kMod.size() || begin[0] != '_' || begin[1] != '_' || room < bytes) return {};
  std::size_t at = 3;  // a module has a name
  while (at + kMod.size() <= bytes && !filter_detail::Is({begin + at, kMod.size()}, kMod)) ++at;
  if (at + kMod.size() > bytes) return {};
  std::size_t length = 0;
  for (std::size_t i = 2; i < bytes && length < room; ++i) {
    const bool in_mod = i >= at && i < at + kMod.size();
    if (in_mod && i >= at + 2) continue;
    buffer[length++] = in_mod ? ':' : begin[i];
  }
  return {buffer, length};
}

}  // namespace stipple

#endif
