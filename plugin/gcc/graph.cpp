// SPDX-License-Identifier: MIT
// Events after inlining: the function is a control-flow graph in SSA form, exceptions are edges.
//
// Enter stands on the edge from the entry block, leave before each return. For exceptions there is
// one more exit: a cleanup region around everything, whose landing pad leaves and resumes. It has
// to become the outer region of all that are there: the unwinder's table of a function whose
// handlers do not match the exception is made from the outermost region, and without this the
// exception would pass by the landing pad. Everything that can leave the function by an exception
// gets an edge to that pad: statements that throw and have no handler, and the resume of a handler
// that gives the exception back.
//
// What is inserted here is straight code; place.cpp finishes it when GCC has optimised the
// function.
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

// On an edge of its own: the first block may be the head of a loop.
tree InsertEnter(function* fun) {
  const tree slot = make_ssa_name(long_long_unsigned_type_node);
  const tree token = make_ssa_name(long_long_unsigned_type_node);
  const basic_block block = split_edge(single_succ_edge(ENTRY_BLOCK_PTR_FOR_FN(fun)));
  gimple_stmt_iterator at = gsi_start_bb(block);
  gsi_insert_after(&at, SlotStatement(fun, slot), GSI_NEW_STMT);
  gsi_insert_after(&at, EnterStatement(token, slot), GSI_NEW_STMT);
  return token;
}

void InsertLeaveAtReturns(function* fun, tree token) {
  edge exit;
  edge_iterator i;
  FOR_EACH_EDGE(exit, i, EXIT_BLOCK_PTR_FOR_FN(fun)->preds) {
    gimple_stmt_iterator last = gsi_last_bb(exit->src);
    if (!gsi_end_p(last) && gimple_code(gsi_stmt(last)) == GIMPLE_RETURN)
      gsi_insert_before(&last, LeaveStatement(token), GSI_SAME_STMT);
  }
}

bool Escapes(function* fun, gimple* statement) {
  if (gimple_code(statement) == GIMPLE_RESX) return lookup_stmt_eh_lp(statement) == 0;
  return gimple_code(statement) != GIMPLE_ASM && stmt_can_throw_external(fun, statement);
}

std::vector<gimple*> EscapingStatements(function* fun) {
  std::vector<gimple*> statements;
  basic_block block;
  FOR_EACH_BB_FN(block, fun) {
    for (gimple_stmt_iterator i = gsi_start_bb(block); !gsi_end_p(i); gsi_next(&i))
      if (Escapes(fun, gsi_stmt(i))) statements.push_back(gsi_stmt(i));
  }
  return statements;
}

eh_region OutermostCleanup(function* fun) {
  const eh_region others = fun->eh->region_tree;
  const eh_region cleanup = gen_eh_region_cleanup(nullptr);
  cleanup->next_peer = nullptr;
  cleanup->inner = others;
  for (eh_region region = others; region != nullptr; region = region->next_peer)
    region->outer = cleanup;
  return cleanup;
}

eh_landing_pad InsertLandingPad(function* fun, tree token) {
  const eh_region cleanup = OutermostCleanup(fun);
  const eh_landing_pad pad = gen_eh_landing_pad(cleanup);
  pad->post_landing_pad = create_artificial_label(UNKNOWN_LOCATION);
  EH_LANDING_PAD_NR(pad->post_landing_pad) = pad->index;

  const basic_block block = create_empty_bb(EXIT_BLOCK_PTR_FOR_FN(fun)->prev_bb);
  block->count = profile_count::zero();
  if (current_loops != nullptr) add_bb_to_loop(block, current_loops->tree_root);
  gimple_stmt_iterator at = gsi_start_bb(block);
  gsi_insert_after(&at, gimple_build_label(pad->post_landing_pad), GSI_NEW_STMT);
  gsi_insert_after(&at, LeaveStatement(token), GSI_NEW_STMT);
  gsi_insert_after(&at, gimple_build_resx(cleanup->index), GSI_NEW_STMT);
  return pad;
}

// A statement with a landing pad ends its block.
void LeadToPad(gimple* statement, eh_landing_pad pad) {
  const basic_block block = gimple_bb(statement);
  if (gimple_code(statement) != GIMPLE_RESX && gsi_stmt(gsi_last_bb(block)) != statement)
    split_block(block, statement);
  add_stmt_to_eh_lp(statement, pad->index);
  make_eh_edges(statement);
  edge out;
  edge_iterator i;
  FOR_EACH_EDGE(out, i, block->succs) {
    if ((out->flags & EDGE_EH) == 0) continue;
    out->probability = gimple_code(statement) == GIMPLE_RESX ? profile_probability::always()
                                                             : profile_probability::never();
  }
}

}  // namespace

void InstrumentGraph(function* fun) {
  const std::vector<gimple*> escaping =
      flag_exceptions && options.exceptions ? EscapingStatements(fun) : std::vector<gimple*>();
  const tree token = InsertEnter(fun);
  InsertLeaveAtReturns(fun, token);
  if (!escaping.empty()) {
    const eh_landing_pad pad = InsertLandingPad(fun, token);
    for (gimple* statement : escaping) LeadToPad(statement, pad);
  }
  ForgetGraph(fun);
}

}  // namespace stipple::plugin
