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

/// For headlines and tables: without return type, parameters, template arguments and unnamed
/// namespaces. "void a::(anonymous namespace)::F<int>(int) const" -> "a::F<..>". Two overloads have
/// the same one.
std::string ShortName(std::string_view demangled);

}  // namespace stipple

#endif
