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
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

// Puts `event` into a block of its own, run if `token` is not 0, between the end of `from` and its
// only successor. Returns the block.
basic_block InsertGuarded(basic_block from, tree token, gimple* event) {
  const edge skip = single_succ_edge(from);
  gimple_stmt_iterator end = gsi_last_bb(from);
  gsi_insert_after(
      &end,
      gimple_build_cond(NE_EXPR, token, build_zero_cst(TREE_TYPE(token)), NULL_TREE, NULL_TREE),
      GSI_NEW_STMT);
  const basic_block block = create_empty_bb(from);
  if (current_loops != nullptr) add_bb_to_loop(block, from->loop_father);
  gimple_stmt_iterator at = gsi_start_bb(block);
  gsi_insert_after(&at, event, GSI_NEW_STMT);

  const edge run = make_edge(from, block, EDGE_TRUE_VALUE);
  run->probability = profile_probability::very_unlikely();
  block->count = from->count.apply_probability(run->probability);
  skip->flags = (skip->flags & ~EDGE_FALLTHRU) | EDGE_FALSE_VALUE;
  skip->probability = run->probability.invert();
  make_single_succ_edge(block, skip->dest, EDGE_FALLTHRU);
  return block;
}

tree InsertEnter(function* fun, Form form) {
  const tree slot = make_ssa_name(long_long_unsigned_type_node);
  const tree entered = make_ssa_name(long_long_unsigned_type_node);
  const tree token = make_ssa_name(long_long_unsigned_type_node);
  // Blocks of their own: the first one may be the head of a loop.
  const basic_block block = split_edge(single_succ_edge(ENTRY_BLOCK_PTR_FOR_FN(fun)));
  const basic_block join = split_edge(single_succ_edge(block));
  gimple_stmt_iterator at = gsi_start_bb(block);
  gsi_insert_after(&at, SlotStatement(fun, slot), GSI_NEW_STMT);
  const basic_block event = InsertGuarded(block, slot, EnterStatement(entered, slot, form));
  gphi* phi = create_phi_node(token, join);
  add_phi_arg(phi, slot, find_edge(block, join), UNKNOWN_LOCATION);
  add_phi_arg(phi, entered, find_edge(event, join), UNKNOWN_LOCATION);
  return token;
}

// The test is of an opaque copy: knowing from the enter how it comes out, the compiler would make
// two of the function.
void InsertLeave(gimple* statement, tree token, Form form) {
  const tree copy = make_ssa_name(long_long_unsigned_type_node);
  gimple_stmt_iterator at = gsi_for_stmt(statement);
  gimple* opaque = OpaqueCopy(copy, token);
  gsi_insert_before(&at, opaque, GSI_SAME_STMT);
  const basic_block from = split_block(gimple_bb(statement), opaque)->src;
  InsertGuarded(from, copy, LeaveStatement(copy, form));
}

void InsertLeaveAtReturns(function* fun, tree token, Form form) {
  std::vector<gimple*> returns;
  edge exit;
  edge_iterator i;
  FOR_EACH_EDGE(exit, i, EXIT_BLOCK_PTR_FOR_FN(fun)->preds) {
    gimple* last = last_stmt(exit->src);
    if (last != nullptr && gimple_code(last) == GIMPLE_RETURN) returns.push_back(last);
  }
  for (gimple* statement : returns) InsertLeave(statement, token, form);
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
  gsi_insert_after(&at, LeaveStatement(token, Form::kCall), GSI_NEW_STMT);
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

void InstrumentGraph(function* fun, Form form) {
  const std::vector<gimple*> escaping =
      flag_exceptions ? EscapingStatements(fun) : std::vector<gimple*>();
  const tree token = InsertEnter(fun, form);
  InsertLeaveAtReturns(fun, token, form);
  if (!escaping.empty()) {
    const eh_landing_pad pad = InsertLandingPad(fun, token);
    for (gimple* statement : escaping) LeadToPad(statement, pad);
  }
  free_dominance_info(fun, CDI_DOMINATORS);
  free_dominance_info(fun, CDI_POST_DOMINATORS);
  if (current_loops != nullptr) loops_state_set(LOOPS_NEED_FIXUP);
}

}  // namespace stipple::plugin
