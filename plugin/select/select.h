// SPDX-License-Identifier: MIT
// Which functions get events, and the account of it that goes into the object file. Knows no
// compiler: the plugins collect facts, the rules are here, so that both answer alike.
#ifndef STIPPLE_PLUGIN_SELECT_SELECT_H
#define STIPPLE_PLUGIN_SELECT_SELECT_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "plugin/select/options.h"
#include "stipple/filter.h"

namespace stipple::plugin {

/// What the source says about a function by attribute.
enum class Wish { kNone, kAlways, kNever };

/// What a compiler knows of one function at the position where events go in.
struct FunctionFacts {
  std::string name;          // demangled
  std::string linkage_name;  // as the linker sees it, with any clone suffix
  std::string file;          // as the compiler was given it
  unsigned line = 0;         // 0: not known
  unsigned instructions = 0;
  bool has_loop = false;
  bool makes_calls = false;
  bool in_system_header = false;
  bool artificial = false;  // nobody wrote it
  Wish wish = Wish::kNone;  // no_instrument_function, xray_always_instrument, ...
};

/// The rule that decided.
enum class Reason {
  kAttributeNever,
  kArtificial,
  kExcludedFunction,
  kAttributeAlways,
  kIncludedFunction,
  kExcludedFile,
  kFilterExcluded,
  kFilterIncluded,
  kSystemHeader,
  kTrivial,
  kDefault,
};

struct Answer {
  bool instrument;
  Reason reason;
};

/// The rule in a few words, as `stipple flags --explain` prints it: "system header".
std::string_view Text(Reason reason);

/// The selection of one compilation, and its account.
class Selection {
 public:
  /// `options` must live as long, and not change once a function was selected.
  explicit Selection(const Options& options) : options_(options) {}

  /// Reads the filter file, if the options name one. Answers what is wrong with it: one line.
  std::optional<std::string> ReadFilterFile();

  /// The first rule that applies decides; their order is that of `Reason`.
  Answer Select(const FunctionFacts& facts);

  /// One line for the user if lists or filter were given and name nothing that was seen, else
  /// empty.
  std::string Note() const;

  /// The account: what was left out and why, which functions got events, which list entries and
  /// filter rules matched. Texts without zero bytes, each once, in no order; empty if no function
  /// was seen. Each stands for itself, so that a linker may merge those of all files;
  /// docs/architecture.md says how to read them.
  const std::set<std::string>& Account();

 private:
  Reason ReasonOf(const FunctionFacts& facts);
  /// The first text of the list that occurs in one of the names; all that do are noted.
  bool OccursIn(const NameList& list, std::string_view a, std::string_view b);
  FilterAnswer Filtered(const FunctionFacts& facts);
  void AddRules();

  const Options& options_;
  std::string filter_text_;
  std::vector<FilterRule> filter_;        // points into filter_text_
  std::set<const std::string*> matched_;  // entries of the options' lists
  std::set<std::string> account_;
};

/// The linkage name without what a compiler appends to clones, parts and coroutine bodies
/// (`_Z1fi.constprop.0`, `_Z2cov.resume`), so that both compilers name a region alike.
std::string_view WithoutCloneSuffix(std::string_view linkage_name);

}  // namespace stipple::plugin

#endif
