// SPDX-License-Identifier: MIT
// What the plugins wrote into object files about the functions they left out (docs/architecture.md,
// "The account of the selection"), read back from objects, archives of objects, libraries and
// programs.
#ifndef STIPPLE_ANALYSIS_TOOLS_SELECTION_ACCOUNT_H
#define STIPPLE_ANALYSIS_TOOLS_SELECTION_ACCOUNT_H

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace stipple {

struct LeftOutFunction {
  std::string reason;
  std::string name;  // linkage name
  std::string file;
  std::string line;  // "0": not known
};

/// The account of any number of objects. The same function in several of them counts once, and as
/// instrumented if it is so in any.
struct SelectionAccount {
  std::set<std::string> instrumented;               // identities
  std::map<std::string, LeftOutFunction> left_out;  // by identity
  /// List entries and filter rules, by place and text; whether they matched anything.
  std::map<std::pair<std::string, std::string>, bool> rules;

  bool empty() const { return instrumented.empty() && left_out.empty(); }
};

enum class AccountProblem { kNone, kNotElf, kThinArchive };

/// Adds to `account` what `file` holds: an ELF file or an archive of them. Any bytes are safe; what
/// does not lie within them is skipped.
AccountProblem ReadAccount(std::span<const std::byte> file, SelectionAccount& account);

/// For people: a sentence, the functions that were left out, sorted, and the rules without effect.
std::string Explain(const SelectionAccount& account);

}  // namespace stipple

#endif
