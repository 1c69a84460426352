// SPDX-License-Identifier: MIT
// Linkage names as people write them.
#ifndef STIPPLE_ANALYSIS_TRACE_DEMANGLE_H
#define STIPPLE_ANALYSIS_TRACE_DEMANGLE_H

#include <string>
#include <string_view>

namespace stipple {

/// "_ZN3FooC2Ei" -> "Foo::Foo(int)", "__solver_MOD_step" -> "solver::step", "work.constprop.0" ->
/// "work"; any other name as it is.
std::string Demangle(std::string_view linkage_name);

}  // namespace stipple

#endif
