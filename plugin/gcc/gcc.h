// SPDX-License-Identifier: MIT
// GCC's own headers, in the one order that works, and what the files of this folder share.
#ifndef STIPPLE_PLUGIN_GCC_GCC_H
#define STIPPLE_PLUGIN_GCC_GCC_H

// The standard headers come first: GCC's forbid malloc and friends from there on.
#include <cxxabi.h>

#include <string>
#include <string_view>
#include <vector>

#include "plugin/event_code.h"
#include "plugin/select/select.h"

// GCC's headers do not pass our warnings.
#pragma GCC system_header

// clang-format off
#include "gcc-plugin.h"
#include "plugin-version.h"
#include "tree.h"
#include "tree-pass.h"
#include "context.h"
#include "function.h"
#include "basic-block.h"
#include "gimple.h"
#include "gimple-iterator.h"
#include "gimple-walk.h"
#include "gimplify.h"
#include "ssa.h"
#include "tree-eh.h"
#include "tree-cfg.h"
#include "cfghooks.h"
#include "cfgloop.h"
#include "except.h"
#include "cgraph.h"
#include "attribs.h"
#include "diagnostic.h"
#include "langhooks.h"
#include "output.h"
#include "stringpool.h"
#include "builtins.h"
#include "dominance.h"
// clang-format on

namespace stipple::plugin {

/// What the command line asked for; one compiler process compiles one file.
extern Options options;

/// What select/ wants to know of the function being compiled; its body is a control-flow graph or
/// still a GIMPLE sequence.
FunctionFacts FactsOf(function* fun);

/// What the descriptor says of the function.
struct OwnedRegion {
  std::string name, file;
  unsigned line;
  RegionText text() const { return {name, file, line}; }
};
OwnedRegion RegionOf(function* fun);

/// The parts of an event, each a statement that the inliner counts as one instruction. Tokens are
/// 64-bit variables or SSA names.
gimple* SlotStatement(function* fun, tree token);
gimple* EnterStatement(tree token_out, tree token_in, Form form);
gimple* LeaveStatement(tree token, Form form);

/// `copy` = `token`, in a way that the compiler cannot see through.
gimple* OpaqueCopy(tree copy, tree token);

/// Inserts the events at either position.
void InstrumentGraph(function* fun, Form form);     // after inlining: SSA, exceptions lowered
void InstrumentSequence(function* fun, Form form);  // as written: one GIMPLE_BIND

}  // namespace stipple::plugin

#endif
