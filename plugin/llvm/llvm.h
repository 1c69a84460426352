// SPDX-License-Identifier: MIT
// What the files of this folder share. One source for LLVM 14, 16 and 19.
#ifndef STIPPLE_PLUGIN_LLVM_LLVM_H
#define STIPPLE_PLUGIN_LLVM_LLVM_H

#include <string>

#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/Instructions.h"
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

/// Calls in front of which their function has left already.
using TailCalls = llvm::SmallPtrSet<const llvm::CallInst*, 4>;

/// Inserts enter, and leave at each return and before each musttail call. The answer is the token.
llvm::Value* InsertEvents(llvm::Function& function);

/// Inserts a leave where an exception leaves the function, unless by one of `tail_calls`.
void InsertLeaveForExceptions(llvm::Function& function, llvm::Value* token,
                              const TailCalls& tail_calls);

/// Puts the leaves that follow a call in front of it where code generation can make the call a
/// jump, which it could not with a leave behind it.
TailCalls LeaveBeforeTailCalls(llvm::Function& function);

/// Tests each token before its event, so that the event can be moved out of the straight line.
void GuardEvents(llvm::Function& function);

/// Whether the instruction is a leave.
bool IsLeave(const llvm::Instruction& instruction);

}  // namespace stipple::plugin

#endif
