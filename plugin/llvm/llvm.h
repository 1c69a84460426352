// SPDX-License-Identifier: MIT
// What the files of this folder share. One source for LLVM 14, 16 and 19.
#ifndef STIPPLE_PLUGIN_LLVM_LLVM_H
#define STIPPLE_PLUGIN_LLVM_LLVM_H

#include <string>

#include "llvm/IR/Function.h"
#include "plugin/event_code.h"
#include "plugin/select/select.h"

namespace stipple::plugin {

/// What select/ wants to know of a function.
FunctionFacts FactsOf(const llvm::Function& function);

/// What the descriptor says of the function. Without debug information (-g, -gline-tables-only) the
/// file is the one being compiled and the line 0.
struct OwnedRegion {
  std::string name, file;
  unsigned line;
  RegionText text() const { return {name, file, line}; }
};
OwnedRegion RegionOf(const llvm::Function& function);

/// Inserts enter, and leave at each exit: return, exception, and before a musttail call.
void Instrument(llvm::Function& function, Form form);

}  // namespace stipple::plugin

#endif
