// SPDX-License-Identifier: MIT
// Late, when the function is optimised, each event goes behind a test of its token, into a block
// that the compiler moves out of the straight line. Not earlier: in the hundred passes before, an
// event is one statement of straight code, which costs less time to compile and hides less.
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

std::vector<gimple*> Events(function* fun) {
  std::vector<gimple*> events;
  basic_block block;
  FOR_EACH_BB_FN(block, fun) {
    for (gimple_stmt_iterator i = gsi_start_bb(block); !gsi_end_p(i); gsi_next(&i))
      if (IsEnter(gsi_stmt(i)) || IsLeave(gsi_stmt(i))) events.push_back(gsi_stmt(i));
  }
  return events;
}

struct Detour {
  edge run, skip;  // into the event's block; around it
};

// Gives `event` a block of its own, run if `token` is not 0.
Detour Guard(gimple* event, tree token) {
  gimple_stmt_iterator at = gsi_for_stmt(event);
  gsi_prev(&at);
  const basic_block before = gimple_bb(event);
  const edge run = split_block(before, gsi_end_p(at) ? nullptr : gsi_stmt(at));
  const edge back = split_block(run->dest, event);
  gimple_stmt_iterator end = gsi_last_bb(before);
  gsi_insert_after(
      &end,
      gimple_build_cond(NE_EXPR, token, build_zero_cst(TREE_TYPE(token)), NULL_TREE, NULL_TREE),
      GSI_NEW_STMT);

  const edge skip = make_edge(before, back->dest, EDGE_FALSE_VALUE);
  run->flags = (run->flags & ~EDGE_FALLTHRU) | EDGE_TRUE_VALUE;
  run->probability = profile_probability::very_unlikely();
  skip->probability = run->probability.invert();
  run->dest->count = before->count.apply_probability(run->probability);
  return {run, skip};
}

void GuardEnter(gimple* event) {
  gasm* assembly = as_a<gasm*>(event);
  const tree slot = TokenIn(event);
  const tree token = TREE_VALUE(gimple_asm_output_op(assembly, 0));
  const tree entered = make_ssa_name(long_long_unsigned_type_node, event);
  TREE_VALUE(gimple_asm_output_op(assembly, 0)) = entered;
  update_stmt(event);
  const Detour detour = Guard(event, slot);
  gphi* phi = create_phi_node(token, detour.skip->dest);
  add_phi_arg(phi, slot, detour.skip, UNKNOWN_LOCATION);
  add_phi_arg(phi, entered, single_succ_edge(detour.run->dest), UNKNOWN_LOCATION);
}

// The test is of an opaque copy: knowing from the enter how it comes out, the compiler would make
// two of the function.
void GuardLeave(gimple* event) {
  const tree copy = make_ssa_name(long_long_unsigned_type_node);
  gimple_stmt_iterator at = gsi_for_stmt(event);
  gsi_insert_before(&at, OpaqueCopy(copy, TokenIn(event)), GSI_SAME_STMT);
  TREE_VALUE(gimple_asm_input_op(as_a<gasm*>(event), 0)) = copy;
  update_stmt(event);
  Guard(event, copy);
}

// An exception is rare and dear: no test around the leave of its landing pad.
bool AfterException(gimple* event) {
  const basic_block block = gimple_bb(event);
  edge in;
  edge_iterator i;
  FOR_EACH_EDGE(in, i, block->preds)
  if ((in->flags & EDGE_EH) != 0) return true;
  return false;
}

}  // namespace

void ForgetGraph(function* fun) {
  free_dominance_info(fun, CDI_DOMINATORS);
  free_dominance_info(fun, CDI_POST_DOMINATORS);
  if (current_loops != nullptr) loops_state_set(LOOPS_NEED_FIXUP);
}

bool GuardEvents(function* fun) {
  const std::vector<gimple*> events = Events(fun);
  for (gimple* event : events) {
    if (IsEnter(event))
      GuardEnter(event);
    else if (!AfterException(event))
      GuardLeave(event);
  }
  if (!events.empty()) ForgetGraph(fun);
  return !events.empty();
}

}  // namespace stipple::plugin
