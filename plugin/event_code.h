// SPDX-License-Identifier: MIT
// The machine code of an event, as the text of an inline assembly. Both compilers insert the same
// text, so what abi.h promises holds for both or for neither. Knows no compiler.
#ifndef STIPPLE_PLUGIN_EVENT_CODE_H
#define STIPPLE_PLUGIN_EVENT_CODE_H

#include <set>
#include <string>
#include <string_view>

namespace stipple::plugin {

/// How a compiler wants an assembly template written.
struct TemplateSyntax {
  std::string_view begin, end;  // around the whole text
  std::string_view percent;     // a literal %
  std::string_view dollar;      // a literal $
  std::string_view token32;     // operand 0, low half
  std::string_view token64;     // operand 0, a 64-bit register
  std::string_view unique;      // a number that differs between any two copies of the text
};

/// One region, as its descriptor names it.
struct RegionText {
  std::string_view name;  // linkage name without clone suffix
  std::string_view file;
  unsigned line;  // 0: unknown
};

/// The region's descriptor, and the load of its slot: operand 0, an output, is the token.
std::string SlotCode(const RegionText& region, const TemplateSyntax& syntax);

/// Appends an enter event unless the token is 0. Operand 0 is the token, in and (early-clobbered)
/// out: what comes out is for the exits. Clobbers rax, rdx, r11 and the flags.
std::string EnterCode(const TemplateSyntax& syntax);

/// Appends a leave event unless the token is 0. Operand 0 is the token, an input. Same clobbers.
std::string LeaveCode(const TemplateSyntax& syntax);

/// The block of the shared object with its constructor and destructor, for file scope (AT&T syntax,
/// not a template). May occur any number of times in a file and in a shared object.
std::string_view ObjectCode();

/// The account of the selection as a section that is not loaded, for file scope (not a template).
std::string AccountCode(const std::set<std::string>& account);

}  // namespace stipple::plugin

#endif
