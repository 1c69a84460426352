// SPDX-License-Identifier: MIT
// Events in the IR. LLVM's own EscapeEnumerator finds the exits, and for exceptions turns calls
// that may throw into invokes with a cleanup pad. It leaves alone the landing pads that are there:
// one without `cleanup` is never entered for an exception that does not match, so that exit would
// be missed.
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InlineAsm.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/MDBuilder.h"
#include "llvm/Transforms/Utils/BasicBlockUtils.h"
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
constexpr char kClobbers[] = "~{rax},~{rdx},~{r10},~{r11},~{dirflag},~{fpsr},~{flags}";

/// One asm statement. `token`: null if the code only gives one, `gives_token`: it gives one.
llvm::CallInst* InsertCode(llvm::IRBuilder<>& builder, const std::string& code, llvm::Value* token,
                           bool gives_token, const std::string& constraints) {
  llvm::Type* word = builder.getInt64Ty();
  llvm::SmallVector<llvm::Value*, 1> inputs;
  if (token != nullptr) inputs.push_back(token);
  llvm::SmallVector<llvm::Type*, 1> types(inputs.size(), word);
  auto* type =
      llvm::FunctionType::get(gives_token ? word : builder.getVoidTy(), types, /*isVarArg=*/false);
  auto* assembly = llvm::InlineAsm::get(type, code, constraints, /*hasSideEffects=*/true,
                                        /*isAlignStack=*/false, llvm::InlineAsm::AD_ATT);
  llvm::CallInst* call = builder.CreateCall(type, assembly, inputs);
  call->setDoesNotThrow();
  call->setOnlyAccessesInaccessibleMemory();
  return call;
}

/// Splits the block before `place` and gives a place that is passed, rarely, if `token` is not 0.
llvm::Instruction* Guarded(llvm::Instruction* place, llvm::Value* token) {
  llvm::IRBuilder<> builder(place);
  llvm::Value* on = builder.CreateICmpNE(token, builder.getInt64(0));
  llvm::MDNode* rarely = llvm::MDBuilder(place->getContext()).createBranchWeights(1, 2000);
  return llvm::SplitBlockAndInsertIfThen(on, place, /*Unreachable=*/false, rarely);
}

// Where the entry block can be split: behind its fixed-size variables, which would else be taken
// for variable-size ones.
llvm::Instruction* EntryPlace(llvm::Function& function) {
  llvm::BasicBlock& entry = function.getEntryBlock();
  llvm::SmallVector<llvm::AllocaInst*, 16> variables;
  for (llvm::Instruction& instruction : entry) {
    auto* variable = llvm::dyn_cast<llvm::AllocaInst>(&instruction);
    if (variable != nullptr && variable->isStaticAlloca()) variables.push_back(variable);
  }
  llvm::Instruction* place = &*entry.getFirstInsertionPt();
  for (llvm::AllocaInst* variable : variables) {
    if (variable == place)
      place = place->getNextNode();
    else
      variable->moveBefore(place);
  }
  return place;
}

llvm::Value* InsertEnter(llvm::Function& function, Form form) {
  llvm::Instruction* place = EntryPlace(function);
  llvm::IRBuilder<> builder(place);
  llvm::CallInst* slot =
      InsertCode(builder, SlotCode(RegionOf(function).text(), kSyntax), nullptr, true, "=&r");
  llvm::Instruction* guarded = Guarded(place, slot);
  builder.SetInsertPoint(guarded);
  llvm::CallInst* entered =
      InsertCode(builder, EnterCode(kSyntax, form), slot, true, std::string("=&r,0,") + kClobbers);
  builder.SetInsertPoint(place);
  llvm::PHINode* token = builder.CreatePHI(builder.getInt64Ty(), 2);
  token->addIncoming(slot, slot->getParent());
  token->addIncoming(entered, entered->getParent());
  return token;
}

void InsertLeave(llvm::Instruction* exit, llvm::Value* token, Form form) {
  llvm::IRBuilder<> builder(Guarded(exit, token));
  InsertCode(builder, LeaveCode(kSyntax, form), token, false, std::string("r,") + kClobbers);
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

void Instrument(llvm::Function& function, Form form) {
  ForgetPurity(function);
  if (GivesExceptionsBack(function)) EnterPadsForEveryException(function);

  llvm::Value* token = InsertEnter(function, form);

  llvm::SmallVector<llvm::Instruction*, 4> exits;
  llvm::EscapeEnumerator enumerator(function, "stipple_leave", /*HandleExceptions=*/true);
  while (llvm::IRBuilder<>* exit = enumerator.Next()) exits.push_back(&*exit->GetInsertPoint());
  for (llvm::Instruction* exit : exits) InsertLeave(exit, token, form);
}

}  // namespace stipple::plugin
