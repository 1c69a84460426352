// SPDX-License-Identifier: MIT
// What the compiler knows of a function, in the words of select/.
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

bool HasAttribute(tree decl, const char* name) {
  return lookup_attribute(name, DECL_ATTRIBUTES(decl)) != NULL_TREE;
}

// DECL_NO_INSTRUMENT_FUNCTION_ENTRY_EXIT is no help: without -finstrument-functions it is set for
// every function.
Wish WishOf(tree decl) {
  if (HasAttribute(decl, "no_instrument_function")) return Wish::kNever;
  if (HasAttribute(decl, "xray_never_instrument")) return Wish::kNever;
  if (HasAttribute(decl, "xray_always_instrument")) return Wish::kAlways;
  return Wish::kNone;
}

bool IsCall(gimple* statement) {
  if (!is_gimple_call(statement) || gimple_call_internal_p(statement)) return false;
  const tree callee = gimple_call_fndecl(statement);
  return callee == NULL_TREE || !fndecl_built_in_p(callee) || !is_inexpensive_builtin(callee);
}

bool IsInstruction(gimple* statement) {
  switch (gimple_code(statement)) {
    case GIMPLE_LABEL:
    case GIMPLE_NOP:
    case GIMPLE_PREDICT:
    case GIMPLE_DEBUG:
    case GIMPLE_BIND:
    case GIMPLE_TRY:
      return false;
    default:
      return !gimple_clobber_p(statement);
  }
}

void Count(gimple* statement, FunctionFacts& facts) {
  if (IsInstruction(statement)) ++facts.instructions;
  if (IsCall(statement)) facts.makes_calls = true;
}

void CountGraph(function* fun, FunctionFacts& facts) {
  basic_block block;
  FOR_EACH_BB_FN(block, fun) {
    for (gimple_stmt_iterator i = gsi_start_bb(block); !gsi_end_p(i); gsi_next(&i))
      Count(gsi_stmt(i), facts);
  }
  facts.has_loop = mark_dfs_back_edges(fun);
}

struct Walk {
  explicit Walk(FunctionFacts* of) : facts(of) {}
  FunctionFacts* facts;
  hash_set<tree> labels;  // passed so far: a jump to one of them goes back
};

void NoteJump(Walk& walk, tree label) {
  if (label != NULL_TREE && walk.labels.contains(label)) walk.facts->has_loop = true;
}

tree CountInSequence(gimple_stmt_iterator* at, bool* handled, walk_stmt_info* info) {
  Walk& walk = *static_cast<Walk*>(info->info);
  gimple* statement = gsi_stmt(*at);
  *handled = false;
  Count(statement, *walk.facts);
  if (auto* label = dyn_cast<glabel*>(statement)) {
    walk.labels.add(gimple_label_label(label));
  } else if (gimple_code(statement) == GIMPLE_GOTO) {
    NoteJump(walk, gimple_goto_dest(statement));
  } else if (auto* cond = dyn_cast<gcond*>(statement)) {
    NoteJump(walk, gimple_cond_true_label(cond));
    NoteJump(walk, gimple_cond_false_label(cond));
  }
  return NULL_TREE;
}

void CountSequence(function* fun, FunctionFacts& facts) {
  Walk walk(&facts);
  walk_stmt_info info = {};
  info.info = &walk;
  walk_gimple_seq(gimple_body(fun->decl), CountInSequence, nullptr, &info);
}

std::string LinkageName(tree decl) {
  const char* name = IDENTIFIER_POINTER(DECL_ASSEMBLER_NAME(decl));
  return name[0] == '*' ? name + 1 : name;  // a star: given by an asm label, take it as it is
}

std::string Demangled(const std::string& linkage_name) {
  char* text = abi::__cxa_demangle(linkage_name.c_str(), nullptr, nullptr, nullptr);
  if (text == nullptr) return linkage_name;
  std::string demangled(text);
  free(text);
  return demangled;
}

}  // namespace

FunctionFacts FactsOf(function* fun) {
  FunctionFacts facts;
  facts.linkage_name = LinkageName(fun->decl);
  facts.name = Demangled(std::string(WithoutCloneSuffix(facts.linkage_name)));
  const OwnedRegion region = RegionOf(fun);
  facts.file = region.file;
  facts.line = region.line;
  facts.in_system_header = DECL_IN_SYSTEM_HEADER(fun->decl);
  // The `main` that gfortran puts around the main program.
  facts.artificial = lang_GNU_Fortran() && facts.linkage_name == "main";
  facts.wish = WishOf(fun->decl);
  if (fun->cfg != nullptr)
    CountGraph(fun, facts);
  else
    CountSequence(fun, facts);
  return facts;
}

OwnedRegion RegionOf(function* fun) {
  const expanded_location place = expand_location(DECL_SOURCE_LOCATION(fun->decl));
  return {std::string(WithoutCloneSuffix(LinkageName(fun->decl))),
          place.file == nullptr ? "" : place.file, place.line < 0 ? 0U : unsigned(place.line)};
}

}  // namespace stipple::plugin
