// SPDX-License-Identifier: MIT
// Which functions get events. Knows no compiler: the plugins collect facts, the rules are here, so
// that both answer alike.
#ifndef STIPPLE_PLUGIN_SELECT_SELECT_H
#define STIPPLE_PLUGIN_SELECT_SELECT_H

#include <string>
#include <string_view>

#include "plugin/select/options.h"

namespace stipple::plugin {

/// What the source says about a function by attribute.
enum class Wish { kNone, kAlways, kNever };

/// What a compiler knows of one function at the position where events go in.
struct FunctionFacts {
  std::string name;          // demangled
  std::string linkage_name;  // as the linker sees it, with any clone suffix
  std::string file;          // as the compiler was given it
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
  kSystemHeader,
  kTrivial,
  kDefault,
};

struct Answer {
  bool instrument;
  Reason reason;
};

/// The first rule that applies decides; their order is that of `Reason`.
Answer Select(const FunctionFacts& facts, const Options& options);

/// The rule in words: "its file is a system header".
std::string_view Text(Reason reason);

/// The linkage name without what a compiler appends to clones, parts and coroutine bodies
/// (`_Z1fi.constprop.0`, `_Z2cov.resume`), so that both compilers name a region alike.
std::string_view WithoutCloneSuffix(std::string_view linkage_name);

}  // namespace stipple::plugin

#endif
