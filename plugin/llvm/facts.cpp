// SPDX-License-Identifier: MIT
// What the compiler knows of a function, in the words of select/.
#include "llvm/Analysis/CFG.h"
#include "llvm/Demangle/Demangle.h"
#include "llvm/IR/DebugInfoMetadata.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "plugin/llvm/llvm.h"

namespace stipple::plugin {
namespace {

// clang knows no_instrument_function but tells only its own -finstrument-functions; annotate() of
// the same name reaches us.
bool IsAnnotated(const llvm::Function& function, llvm::StringRef text) {
  const llvm::GlobalVariable* all =
      function.getParent()->getGlobalVariable("llvm.global.annotations");
  if (all == nullptr || !all->hasInitializer()) return false;
  const auto* entries = llvm::dyn_cast<llvm::ConstantArray>(all->getInitializer());
  if (entries == nullptr) return false;
  for (const llvm::Use& use : entries->operands()) {
    const auto* entry = llvm::dyn_cast<llvm::ConstantStruct>(use.get());
    if (entry == nullptr || entry->getOperand(0)->stripPointerCasts() != &function) continue;
    const auto* note =
        llvm::dyn_cast<llvm::GlobalVariable>(entry->getOperand(1)->stripPointerCasts());
    if (note == nullptr || !note->hasInitializer()) continue;
    const auto* chars = llvm::dyn_cast<llvm::ConstantDataArray>(note->getInitializer());
    if (chars != nullptr && chars->isCString() && chars->getAsCString() == text) return true;
  }
  return false;
}

Wish WishOf(const llvm::Function& function) {
  const llvm::StringRef xray = function.getFnAttribute("function-instrument").getValueAsString();
  if (xray == "xray-never" || IsAnnotated(function, "xray_never_instrument") ||
      IsAnnotated(function, "no_instrument_function"))
    return Wish::kNever;
  if (xray == "xray-always" || IsAnnotated(function, "xray_always_instrument"))
    return Wish::kAlways;
  return Wish::kNone;
}

bool IsInstruction(const llvm::Instruction& instruction) {
  const auto* intrinsic = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction);
  return !llvm::isa<llvm::PHINode>(instruction) &&
         (intrinsic == nullptr ||
          !(llvm::isa<llvm::DbgInfoIntrinsic>(intrinsic) || intrinsic->isLifetimeStartOrEnd() ||
            intrinsic->isAssumeLikeIntrinsic()));
}

bool IsCall(const llvm::Instruction& instruction) {
  const auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
  return call != nullptr && !call->isInlineAsm() && !llvm::isa<llvm::IntrinsicInst>(call);
}

bool HasLoop(const llvm::Function& function) {
  llvm::SmallVector<std::pair<const llvm::BasicBlock*, const llvm::BasicBlock*>, 8> backward;
  llvm::FindFunctionBackedges(function, backward);
  return !backward.empty();
}

// There is no flag for it in the IR; this is where compilers and distributions keep them.
bool IsSystemPath(llvm::StringRef file) {
  for (const char* start : {"/usr/include/", "/usr/lib/", "/usr/lib64/"}) {
    if (file.substr(0, llvm::StringRef(start).size()) == start) return true;
  }
  return false;
}

}  // namespace

FunctionFacts FactsOf(const llvm::Function& function) {
  FunctionFacts facts;
  facts.linkage_name = function.getName().str();
  const OwnedRegion region = RegionOf(function);
  facts.name = llvm::demangle(region.name);
  facts.file = region.file;
  facts.line = region.line;
  facts.in_system_header = IsSystemPath(facts.file);
  facts.has_loop = HasLoop(function);
  facts.wish = WishOf(function);
  for (const llvm::BasicBlock& block : function) {
    for (const llvm::Instruction& instruction : block) {
      if (IsInstruction(instruction)) ++facts.instructions;
      if (IsCall(instruction)) facts.makes_calls = true;
    }
  }
  return facts;
}

OwnedRegion RegionOf(const llvm::Function& function) {
  llvm::StringRef name = function.getName();
  if (!name.empty() && name.front() == '\1') name = name.substr(1);  // given by an asm label
  OwnedRegion region{std::string(WithoutCloneSuffix({name.data(), name.size()})),
                     function.getParent()->getSourceFileName(), 0};
  if (const llvm::DISubprogram* source = function.getSubprogram()) {
    region.file = source->getFilename().str();
    region.line = source->getLine();
  }
  return region;
}

}  // namespace stipple::plugin
