// SPDX-License-Identifier: MIT
// An event as a GIMPLE statement.
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {
namespace {

// {a|b} gives a under AT&T syntax and b under -masm=intel, where a register is printed without its
// percent sign.
constexpr TemplateSyntax kSyntax = {
    .begin = "{|.att_syntax prefix\n}",
    .end = "{|\t.intel_syntax noprefix\n}",
    .percent = "%%",
    .dollar = "$",
    .token32 = "{%k0|%%%k0}",
    .token64 = "{%q0|%%%q0}",
    .unique = "%=",
};

const std::string& EnterText() {
  static const std::string text = EnterCode(kSyntax);
  return text;
}

const std::string& LeaveText() {
  static const std::string text = LeaveCode(kSyntax);
  return text;
}

// By content: with link-time optimisation another process made the statement.
bool HasText(gimple* statement, const std::string& text) {
  const auto* assembly = dyn_cast<gasm*>(statement);
  return assembly != nullptr && gimple_asm_volatile_p(assembly) &&
         text == gimple_asm_string(assembly);
}

tree Text(std::string_view text) { return build_string(unsigned(text.size()), text.data()); }

tree Operand(const char* constraint, tree value) {
  return build_tree_list(build_tree_list(NULL_TREE, Text(constraint)), value);
}

// `in` and `out` share a register if both are given.
gimple* Statement(const std::string& code, tree out, tree in, bool clobbers_registers) {
  vec<tree, va_gc>*inputs = nullptr, *outputs = nullptr, *clobbers = nullptr;
  if (out != NULL_TREE) vec_safe_push(outputs, Operand("=&r", out));
  if (in != NULL_TREE) vec_safe_push(inputs, Operand(out == NULL_TREE ? "r" : "0", in));
  if (clobbers_registers) {
    for (const char* name : {"rax", "rdx", "r11", "cc"})
      vec_safe_push(clobbers, build_tree_list(NULL_TREE, Text(name)));
  }
  gasm* statement =
      gimple_build_asm_vec(ggc_strdup(code.c_str()), inputs, outputs, clobbers, nullptr);
  // Volatile orders events among each other and to calls; nothing else of the program is held back.
  gimple_asm_set_volatile(statement, true);
  gimple_asm_set_inline(statement, true);
  if (out != NULL_TREE && TREE_CODE(out) == SSA_NAME) SSA_NAME_DEF_STMT(out) = statement;
  return statement;
}

}  // namespace

gimple* SlotStatement(function* fun, tree token) {
  return Statement(SlotCode(RegionOf(fun).text(), kSyntax), token, NULL_TREE, false);
}

gimple* EnterStatement(tree token_out, tree token_in) {
  return Statement(EnterText(), token_out, token_in, true);
}

gimple* LeaveStatement(tree token) { return Statement(LeaveText(), NULL_TREE, token, true); }

bool IsEnter(gimple* statement) { return HasText(statement, EnterText()); }

bool IsLeave(gimple* statement) { return HasText(statement, LeaveText()); }

tree TokenIn(gimple* event) { return TREE_VALUE(gimple_asm_input_op(as_a<gasm*>(event), 0)); }

gimple* OpaqueCopy(tree copy, tree token) { return Statement("", copy, token, false); }

}  // namespace stipple::plugin
