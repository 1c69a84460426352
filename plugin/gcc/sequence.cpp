// SPDX-License-Identifier: MIT
// Events before inlining, while a function is still as written: enter, then the body inside
// try/finally. Lowering does the rest, exceptions included.
#include "plugin/gcc/gcc.h"

namespace stipple::plugin {

void InstrumentSequence(function* fun) {
  gimple_seq body = gimple_body(fun->decl);
  gbind* bind = as_a<gbind*>(gimple_seq_first_stmt(body));
  const tree token = create_tmp_var(long_long_unsigned_type_node, "stipple_token");

  gimple_seq leave = nullptr;
  gimple_seq_add_stmt(&leave, LeaveStatement(token));
  if (!options.exceptions) {  // only where the function returns
    geh_else* by_way = gimple_build_eh_else(leave, nullptr);
    leave = nullptr;
    gimple_seq_add_stmt(&leave, by_way);
  }
  gimple_seq guarded = nullptr;
  gimple_seq_add_stmt(&guarded, SlotStatement(fun, token));
  gimple_seq_add_stmt(&guarded, EnterStatement(token, token));
  gimple_seq_add_stmt(&guarded,
                      gimple_build_try(gimple_bind_body(bind), leave, GIMPLE_TRY_FINALLY));
  gimple_bind_set_body(bind, guarded);
}

}  // namespace stipple::plugin
