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

tree Operand(const char* constraint, tree value) {
  return build_tree_list(build_tree_list(NULL_TREE, build_string(strlen(constraint), constraint)),
                         value);
}

gimple* Statement(const std::string& code, tree output, tree input) {
  vec<tree, va_gc>*inputs = nullptr, *outputs = nullptr, *clobbers = nullptr;
  if (output != NULL_TREE) vec_safe_push(outputs, Operand("=&r", output));
  if (input != NULL_TREE) vec_safe_push(inputs, Operand("r", input));
  for (const char* name : {"rax", "rdx", "r11", "cc"})
    vec_safe_push(clobbers, build_tree_list(NULL_TREE, build_string(strlen(name), name)));
  gasm* statement =
      gimple_build_asm_vec(ggc_strdup(code.c_str()), inputs, outputs, clobbers, nullptr);
  // Volatile orders events among each other and to calls; nothing else of the program is held back.
  gimple_asm_set_volatile(statement, true);
  gimple_asm_set_inline(statement, true);
  if (output != NULL_TREE && TREE_CODE(output) == SSA_NAME) SSA_NAME_DEF_STMT(output) = statement;
  return statement;
}

}  // namespace

gimple* EnterStatement(function* fun, tree token) {
  return Statement(EnterCode(RegionOf(fun).text(), kSyntax), token, NULL_TREE);
}

gimple* LeaveStatement(tree token) { return Statement(LeaveCode(kSyntax), NULL_TREE, token); }

}  // namespace stipple::plugin
