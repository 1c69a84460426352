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
#include "cfganal.h"
#include "cfgcleanup.h"
#include "tree-ssa-alias.h"
#include "tree-ssa-operands.h"
#include "tree-into-ssa.h"
#include "tree-dfa.h"
#include "rtl.h"
#include "memmodel.h"
#include "tm_p.h"
#include "calls.h"
#include "target.h"
// clang-format on

// As in tree-ssa-live.h, which includes a header that GCC does not install.
typedef hash_map<int_hash<unsigned int, -1U>, unsigned int> live_vars_map;
extern vec<bitmap_head> compute_live_vars(struct function*, live_vars_map*);
extern bitmap live_vars_at_stmt(vec<bitmap_head>&, live_vars_map*, gimple*);
extern void destroy_live_vars(vec<bitmap_head>&);

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

/// Whether the statement is one of those, and the token that goes into it.
bool IsEnter(gimple* statement);
bool IsLeave(gimple* statement);
tree TokenIn(gimple* event);

/// `copy` = `token`, in a way that the compiler cannot see through.
gimple* OpaqueCopy(tree copy, tree token);

/// To be called when the graph has changed: what GCC has concluded from it is no longer true.
void ForgetGraph(function* fun);

/// Inserts the events at either position.
void InstrumentGraph(function* fun, Form form);     // after inlining: SSA, exceptions lowered
void InstrumentSequence(function* fun, Form form);  // as written: one GIMPLE_BIND

/// Puts the leaves that only a return separates from a call that GCC will make a jump before that
/// call, which without them is one. Returns whether the graph changed. Runs just before pass
/// `tailc`.
bool LeaveBeforeTailCalls(function* fun);

/// Takes the calls that are marked as jumps and have a leave behind them for calls again: GCC would
/// drop what follows them.
void KeepLeavesAfterCalls(function* fun);

/// Puts each event behind a test of its token, in a block off the straight line. Returns whether
/// there was any.
bool GuardEvents(function* fun);

}  // namespace stipple::plugin

#endif
