// SPDX-License-Identifier: MIT
// Leaves before tail calls.
//
// A call that is followed by nothing but the return becomes a jump, and a program may rely on it:
// millions of calls in a row, in the space of one. A leave between call and return would end that.
// So, just before GCC looks for such calls (pass `tailc`), this looks for those that only leaves
// separate from the return, by GCC's own conditions, and puts the leaves before the call: the visit
// ends where the function's frame does. Such a call must not lead to a landing pad that leaves
// again. Functions inlined as written bring their own leaves: any number may stand in a row.
//
// The way from call to return is shared with others as a rule, so the call gets a return of its
// own. GCC's conditions are repeated here (tree-tailcall.cc, calls.cc) since they are not
// offered as a function; where this is the more careful of the two, the leave stays behind the
// call.
#include <optional>
#include <utility>

#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

// From a call to the return that follows.
struct Tail {
  std::vector<tree> tokens;      // of the leaves on the way
  std::vector<gassign*> copies;  // of the call's result
  tree result = NULL_TREE;       // as it is called in the end
  gimple* end = nullptr;         // the return
};

// Names of values at a join, as they were on the way that was taken.
using Names = hash_map<tree, tree>;

tree Before(Names& names, tree value) {
  tree* known = value == NULL_TREE ? nullptr : names.get(value);
  return known == nullptr ? value : *known;
}

void PassJoin(Names& names, edge taken) {
  for (gphi_iterator i = gsi_start_phis(taken->dest); !gsi_end_p(i); gsi_next(&i)) {
    const tree value = Before(names, PHI_ARG_DEF_FROM_EDGE(i.phi(), taken));
    names.put(PHI_RESULT(i.phi()), value);
  }
}

bool DoesNothing(gimple* statement) {
  const auto code = gimple_code(statement);
  return code == GIMPLE_LABEL || code == GIMPLE_NOP || code == GIMPLE_PREDICT ||
         is_gimple_debug(statement) || gimple_clobber_p(statement);
}

// No code comes of it, as GCC has it: `process_assignment`.
bool IsPlainCopy(gassign* copy) {
  const tree to = gimple_assign_lhs(copy), from = gimple_assign_rhs1(copy);
  if (!gimple_assign_cast_p(copy))
    return get_gimple_rhs_class(gimple_assign_rhs_code(copy)) == GIMPLE_SINGLE_RHS &&
           (is_gimple_reg(to) || auto_var_in_fn_p(to, current_function_decl));
  return TYPE_MODE(TREE_TYPE(to)) == TYPE_MODE(TREE_TYPE(from)) &&
         !(INTEGRAL_TYPE_P(TREE_TYPE(to)) && !type_has_mode_precision_p(TREE_TYPE(to)));
}

bool Pass(gimple* statement, Names& names, Tail& tail) {
  if (DoesNothing(statement)) return true;
  if (IsLeave(statement)) {
    tail.tokens.push_back(Before(names, TokenIn(statement)));
    return true;
  }
  auto* copy = dyn_cast<gassign*>(statement);
  if (copy == nullptr || tail.result == NULL_TREE || !IsPlainCopy(copy) ||
      Before(names, gimple_assign_rhs1(copy)) != tail.result)
    return false;
  tail.copies.push_back(copy);
  tail.result = gimple_assign_lhs(copy);
  return true;
}

bool Returns(greturn* statement, Names& names, const Tail& tail) {
  const tree value = gimple_return_retval(statement);
  return value == NULL_TREE || Before(names, value) == tail.result ||
         (tail.result == NULL_TREE && is_empty_type(TREE_TYPE(value)));
}

// The way on, if there is no other but by exception.
edge OnlyWayOn(basic_block block) {
  edge way = nullptr, out;
  edge_iterator i;
  FOR_EACH_EDGE(out, i, block->succs) {
    if ((out->flags & EDGE_EH) != 0) continue;
    if (way != nullptr || (out->flags & EDGE_ABNORMAL) != 0) return nullptr;
    way = out;
  }
  return way == nullptr || way->dest->index == EXIT_BLOCK ? nullptr : way;
}

std::optional<Tail> TailOf(gcall* call) {
  constexpr int kMostBlocks = 32;  // a loop that does nothing has no end
  Tail tail;
  Names names;
  tail.result = gimple_call_lhs(call);
  gimple_stmt_iterator at = gsi_for_stmt(call);
  gsi_next(&at);
  for (int blocks = 0; blocks < kMostBlocks; ++blocks) {
    const basic_block block = blocks == 0 ? gimple_bb(call) : gsi_bb(at);
    for (; !gsi_end_p(at); gsi_next(&at)) {
      if (auto* end = dyn_cast<greturn*>(gsi_stmt(at))) {
        if (!Returns(end, names, tail) || tail.tokens.empty()) return std::nullopt;
        tail.end = end;
        return tail;
      }
      if (!Pass(gsi_stmt(at), names, tail)) return std::nullopt;
    }
    const edge way = OnlyWayOn(block);
    if (way == nullptr) return std::nullopt;
    PassJoin(names, way);
    at = gsi_start_bb(way->dest);
  }
  return std::nullopt;
}

// Whether an exception of the call meets as many leaves (or none: exceptions=off), and nothing else
// on its way out.
bool ExceptionOnlyLeaves(function* fun, gimple* call, std::size_t leaves) {
  const int pad = lookup_stmt_eh_lp(call);
  if (pad <= 0) return pad == 0;
  basic_block block = label_to_block(fun, get_eh_landing_pad_from_number(pad)->post_landing_pad);
  for (std::size_t met = 0; block != nullptr;) {
    for (gimple_stmt_iterator i = gsi_start_bb(block); !gsi_end_p(i); gsi_next(&i)) {
      if (IsLeave(gsi_stmt(i)))
        ++met;
      else if (gimple_code(gsi_stmt(i)) != GIMPLE_RESX && !DoesNothing(gsi_stmt(i)))
        return false;
    }
    if (met > leaves) return false;
    if (EDGE_COUNT(block->succs) == 0) return met == leaves || met == 0;
    block = single_succ_p(block) ? single_succ(block) : nullptr;
  }
  return false;
}

// Stack that the arguments take beyond what goes in registers.
HOST_WIDE_INT StackBytes(tree type, tree decl, const std::vector<tree>& arguments) {
  CUMULATIVE_ARGS sum;
  INIT_CUMULATIVE_ARGS(sum, type, NULL_RTX, decl, int(arguments.size()));
  const cumulative_args_t all = pack_cumulative_args(&sum);
  HOST_WIDE_INT bytes = 0;
  for (const tree argument : arguments) {
    const function_arg_info info(TREE_TYPE(argument), true);
    if (targetm.calls.function_arg(all, info) == NULL_RTX)
      bytes += (int_size_in_bytes(TREE_TYPE(argument)) + 7) & ~HOST_WIDE_INT(7);
    targetm.calls.function_arg_advance(all, info);
  }
  return bytes;
}

bool ArgumentsFit(gcall* call) {
  std::vector<tree> out, in;
  bool hidden_length = false;  // of a Fortran string, which not every caller passes (GCC PR90329)
  for (unsigned i = 0; i < gimple_call_num_args(call); ++i) out.push_back(gimple_call_arg(call, i));
  for (tree p = DECL_ARGUMENTS(current_function_decl); p != NULL_TREE; p = DECL_CHAIN(p)) {
    in.push_back(p);
    hidden_length = hidden_length || DECL_HIDDEN_STRING_LENGTH(p);
  }
  const HOST_WIDE_INT needed = StackBytes(gimple_call_fntype(call), gimple_call_fndecl(call), out);
  if (needed == 0) return true;
  return !hidden_length &&
         needed <= StackBytes(TREE_TYPE(current_function_decl), current_function_decl, in);
}

// The target's own conditions, asked as if the call were being expanded.
bool TargetAgrees(gcall* call) {
  const tree type = gimple_call_fntype(call), function = gimple_call_fn(call);
  const tree value = TREE_TYPE(type), own = TREE_TYPE(DECL_RESULT(current_function_decl));
  if (aggregate_value_p(value, type)) return false;
  if (!VOID_TYPE_P(own) && TYPE_MODE(own) != TYPE_MODE(value)) return false;
  std::vector<tree> arguments;
  for (unsigned i = 0; i < gimple_call_num_args(call); ++i)
    arguments.push_back(gimple_call_arg(call, i));
  const tree expression =
      build_call_array(value, function, int(arguments.size()), arguments.data());
  return targetm.function_ok_for_sibcall(gimple_call_fndecl(call), expression);
}

bool FunctionMayJumpOut(function* fun) {
  if (fun->stdarg || fun->calls_alloca || fun->calls_setjmp || fun->calls_eh_return) return false;
  for (tree p = DECL_ARGUMENTS(fun->decl); p != NULL_TREE; p = DECL_CHAIN(p))
    if (TREE_ADDRESSABLE(p)) return false;
  return true;
}

// Local variables that are still there at the call and that it may reach.
bool ReachesLocals(function* fun, gcall* call) {
  live_vars_map numbers;
  std::vector<tree> reached;
  unsigned i;
  tree variable;
  FOR_EACH_LOCAL_DECL(fun, i, variable) {
    if (TREE_CODE(variable) == PARM_DECL || !auto_var_in_fn_p(variable, fun->decl) ||
        !may_be_aliased(variable) ||
        !(ref_maybe_used_by_stmt_p(call, variable, false) ||
          call_may_clobber_ref_p(call, variable, false)))
      continue;
    if (!VAR_P(variable)) return true;
    numbers.put(DECL_UID(variable), unsigned(reached.size()));
    reached.push_back(variable);
  }
  if (reached.empty()) return false;
  vec<bitmap_head> live = compute_live_vars(fun, &numbers);
  bitmap at_call = live_vars_at_stmt(live, &numbers, call);
  const bool any = !bitmap_empty_p(at_call);
  BITMAP_FREE(at_call);
  destroy_live_vars(live);
  return any;
}

bool IsTailCall(function* fun, gcall* call) {
  if (gimple_call_internal_p(call)) return false;
  const tree callee = gimple_call_fndecl(call), result = gimple_call_lhs(call);
  // What is built in calls nothing of ours: its time belongs to the caller.
  if (callee != NULL_TREE && fndecl_built_in_p(callee)) return false;
  if (callee != NULL_TREE && decl_function_context(callee) == fun->decl) return false;
  if ((gimple_call_flags(call) & (ECF_NORETURN | ECF_RETURNS_TWICE)) != 0) return false;
  if (result != NULL_TREE && !is_gimple_reg(result) && !auto_var_in_fn_p(result, fun->decl))
    return false;
  const tree own = DECL_RESULT(fun->decl);
  if (own != NULL_TREE && may_be_aliased(own) && ref_maybe_used_by_stmt_p(call, own, false))
    return false;
  return TargetAgrees(call) && ArgumentsFit(call) && !ReachesLocals(fun, call);
}

// A return of the call's own, with what the call's result went through.
basic_block ReturnOf(function* fun, gcall* call, const Tail& tail) {
  const basic_block block = create_empty_bb(gimple_bb(call));
  block->count = gimple_bb(call)->count;
  if (current_loops != nullptr) add_bb_to_loop(block, current_loops->tree_root);
  gimple_stmt_iterator at = gsi_start_bb(block);
  tree value = gimple_call_lhs(call);
  for (gassign* copy : tail.copies) {
    tree to = gimple_assign_lhs(copy);
    if (TREE_CODE(to) == SSA_NAME) to = make_ssa_name(TREE_TYPE(to));
    gsi_insert_after(&at, gimple_build_assign(to, gimple_assign_rhs_code(copy), value),
                     GSI_NEW_STMT);
    value = to;
  }
  if (gimple_return_retval(as_a<greturn*>(tail.end)) == NULL_TREE) value = NULL_TREE;
  gsi_insert_after(&at, gimple_build_return(value), GSI_NEW_STMT);
  gimple_set_location(gsi_stmt(at), gimple_location(tail.end));
  make_single_succ_edge(block, EXIT_BLOCK_PTR_FOR_FN(fun), 0);
  return block;
}

void Move(function* fun, gcall* call, const Tail& tail) {
  gimple_stmt_iterator at = gsi_for_stmt(call);
  for (const tree token : tail.tokens)
    gsi_insert_before(&at, LeaveStatement(token, Form::kCall), GSI_SAME_STMT);
  const basic_block block = gimple_bb(call);
  if (remove_stmt_from_eh_lp(call)) gimple_purge_dead_eh_edges(block);
  if (gsi_stmt(gsi_last_bb(block)) != call) split_block(block, call);
  remove_edge(single_succ_edge(block));
  make_single_succ_edge(block, ReturnOf(fun, call, tail), EDGE_FALLTHRU);
}

std::vector<gcall*> Calls(function* fun) {
  std::vector<gcall*> calls;
  basic_block block;
  FOR_EACH_BB_FN(block, fun) {
    for (gimple_stmt_iterator i = gsi_start_bb(block); !gsi_end_p(i); gsi_next(&i))
      if (auto* call = dyn_cast<gcall*>(gsi_stmt(i))) calls.push_back(call);
  }
  return calls;
}

}  // namespace

bool LeaveBeforeTailCalls(function* fun) {
  const bool may = FunctionMayJumpOut(fun);
  // All are chosen before one is moved: liveness cannot be asked of a graph with unreachable blocks.
  std::vector<std::pair<gcall*, Tail>> chosen;
  for (gcall* call : Calls(fun)) {
    const bool promised = gimple_call_tail_p(call);  // the front end did, for a coroutine
    if (!may && !promised) continue;
    const std::optional<Tail> tail = TailOf(call);
    if (!tail || !ExceptionOnlyLeaves(fun, call, tail->tokens.size())) continue;
    if (promised || IsTailCall(fun, call)) chosen.emplace_back(call, *tail);
  }
  if (chosen.empty()) return false;
  for (const auto& [call, tail] : chosen) Move(fun, call, tail);
  ForgetGraph(fun);
  delete_unreachable_blocks();
  maybe_remove_unreachable_handlers();
  mark_virtual_operands_for_renaming(fun);
  return true;
}

void KeepLeavesAfterCalls(function* fun) {
  for (gcall* call : Calls(fun))
    if (gimple_call_tail_p(call) && TailOf(call)) gimple_call_set_tail(call, false);
}

}  // namespace stipple::plugin
