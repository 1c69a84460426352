// SPDX-License-Identifier: MIT
// Events in the IR. LLVM's own EscapeEnumerator finds the exits, and for exceptions turns calls
// that may throw into invokes with a cleanup pad. It leaves alone the landing pads that are there:
// one without `cleanup` is never entered for an exception that does not match, so that exit would
// be missed.
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InlineAsm.h"
#include "llvm/IR/Instructions.h"
#include "llvm/Transforms/Utils/EscapeEnumerator.h"
#include "plugin/llvm/llvm.h"

namespace stipple::plugin {
namespace {

constexpr TemplateSyntax kSyntax = {
    .begin = "",
    .end = "",
    .percent = "%",
    .dollar = "$$",
    .token32 = "${0:k}",
    .token64 = "${0:q}",
    .unique = "${:uid}",
};
constexpr char kClobbers[] = "~{rax},~{rdx},~{r11},~{dirflag},~{fpsr},~{flags}";

llvm::CallInst* InsertEvent(llvm::IRBuilder<>& builder, const std::string& code,
                            llvm::Value* token) {
  llvm::Type* word = builder.getInt64Ty();
  const bool enter = token == nullptr;
  auto* type = enter ? llvm::FunctionType::get(word, false)
                     : llvm::FunctionType::get(builder.getVoidTy(), {word}, false);
  auto* assembly = llvm::InlineAsm::get(
      type, code, (enter ? "=&r," : "r,") + std::string(kClobbers),
      /*hasSideEffects=*/true, /*isAlignStack=*/false, llvm::InlineAsm::AD_ATT);
  llvm::CallInst* call =
      enter ? builder.CreateCall(type, assembly) : builder.CreateCall(type, assembly, {token});
  call->setDoesNotThrow();
  call->setOnlyAccessesInaccessibleMemory();
  return call;
}

// A function with events writes memory, whatever was known of it.
void ForgetPurity(llvm::Function& function) {
#if LLVM_VERSION_MAJOR >= 16
  function.removeFnAttr(llvm::Attribute::Memory);
#else
  for (const auto attribute :
       {llvm::Attribute::ReadNone, llvm::Attribute::ReadOnly, llvm::Attribute::WriteOnly,
        llvm::Attribute::ArgMemOnly, llvm::Attribute::InaccessibleMemOnly,
        llvm::Attribute::InaccessibleMemOrArgMemOnly})
    function.removeFnAttr(attribute);
#endif
  function.removeFnAttr(llvm::Attribute::Speculatable);
  function.removeFnAttr(llvm::Attribute::NoSync);
}

void EnterPadsForEveryException(llvm::Function& function) {
  for (llvm::BasicBlock& block : function) {
    if (llvm::LandingPadInst* pad = block.getLandingPadInst()) pad->setCleanup(true);
  }
}

bool GivesExceptionsBack(const llvm::Function& function) {
  for (const llvm::BasicBlock& block : function)
    if (llvm::isa<llvm::ResumeInst>(block.getTerminator())) return true;
  return false;
}

}  // namespace

void Instrument(llvm::Function& function) {
  ForgetPurity(function);
  if (GivesExceptionsBack(function)) EnterPadsForEveryException(function);

  llvm::IRBuilder<> at_entry(&*function.getEntryBlock().getFirstInsertionPt());
  llvm::Value* token =
      InsertEvent(at_entry, EnterCode(RegionOf(function).text(), kSyntax), nullptr);

  const std::string leave = LeaveCode(kSyntax);
  llvm::EscapeEnumerator exits(function, "stipple_leave", /*HandleExceptions=*/true);
  while (llvm::IRBuilder<>* at_exit = exits.Next()) InsertEvent(*at_exit, leave, token);
}

}  // namespace stipple::plugin
