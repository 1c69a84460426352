// SPDX-License-Identifier: MIT
// Events in the IR. First they are plain asm statements, which the optimiser may copy and inline
// and LeaveBeforeTailCalls may move; at last GuardEvents puts a test around each.
//
// Exceptions: calls that may throw become invokes of one cleanup pad, and it and whatever else
// gives the exception back share one leave. Landing pads that are there need one thing: one without
// `cleanup` is never entered for an exception that does not match, so that exit would be missed.
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InlineAsm.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/MDBuilder.h"
#include "llvm/IR/Module.h"
#include "llvm/Transforms/Utils/BasicBlockUtils.h"
#include "llvm/Transforms/Utils/Local.h"
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
constexpr char kEnterConstraints[] = "=&r,0,~{rax},~{rdx},~{r11},~{dirflag},~{fpsr},~{flags}";
constexpr char kLeaveConstraints[] = "r,~{rax},~{rdx},~{r11},~{dirflag},~{fpsr},~{flags}";

/// An asm statement that takes a token, gives one, or both.
llvm::InlineAsm* Code(llvm::LLVMContext& context, const std::string& text, bool takes_token,
                      bool gives_token, const char* constraints) {
  llvm::Type* word = llvm::Type::getInt64Ty(context);
  llvm::SmallVector<llvm::Type*, 1> types(takes_token ? 1 : 0, word);
  auto* type = llvm::FunctionType::get(gives_token ? word : llvm::Type::getVoidTy(context), types,
                                       /*isVarArg=*/false);
  return llvm::InlineAsm::get(type, text, constraints, /*hasSideEffects=*/true,
                              /*isAlignStack=*/false, llvm::InlineAsm::AD_ATT);
}

// LLVM keeps one object per text, so that an event is known by it.
llvm::InlineAsm* Enter(llvm::LLVMContext& context) {
  return Code(context, EnterCode(kSyntax), true, true, kEnterConstraints);
}

llvm::InlineAsm* Leave(llvm::LLVMContext& context) {
  return Code(context, LeaveCode(kSyntax), true, false, kLeaveConstraints);
}

llvm::CallInst* InsertCode(llvm::Instruction* place, llvm::InlineAsm* code,
                           llvm::ArrayRef<llvm::Value*> token) {
  llvm::CallInst* call = llvm::IRBuilder<>(place).CreateCall(code, token);
  call->setDoesNotThrow();
  call->setOnlyAccessesInaccessibleMemory();
  return call;
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

bool MayThrow(const llvm::CallInst& call) {
  return !call.doesNotThrow() && !call.isMustTailCall() && !call.isInlineAsm() &&
         !llvm::isa<llvm::IntrinsicInst>(call);
}

llvm::StructType* ExceptionType(llvm::LLVMContext& context) {
  return llvm::StructType::get(llvm::PointerType::getUnqual(llvm::Type::getInt8Ty(context)),
                               llvm::Type::getInt32Ty(context));
}

// The personality of C++ where the file uses it: LLVM does not inline a function of another one.
void GivePersonality(llvm::Function& function) {
  if (function.hasPersonalityFn()) return;
  llvm::Module& module = *function.getParent();
  llvm::Constant* personality = module.getFunction("__gxx_personality_v0");
  if (personality == nullptr) {
    auto* type = llvm::FunctionType::get(llvm::Type::getInt32Ty(module.getContext()), true);
    auto callee = module.getOrInsertFunction("__gcc_personality_v0", type);
    personality = llvm::cast<llvm::Constant>(callee.getCallee());
  }
  function.setPersonalityFn(personality);
}

/// A landing pad for `calls`; the answer is the exception, in a block that has no end yet.
llvm::LandingPadInst* CatchAll(llvm::Function& function, llvm::ArrayRef<llvm::CallInst*> calls) {
  GivePersonality(function);
  auto* block = llvm::BasicBlock::Create(function.getContext(), "stipple_leave", &function);
  llvm::IRBuilder<> builder(block);
  llvm::LandingPadInst* pad = builder.CreateLandingPad(ExceptionType(function.getContext()), 0);
  pad->setCleanup(true);
  for (llvm::CallInst* call : calls) llvm::changeToInvokeAndSplitBasicBlock(call, block);
  return pad;
}

/// Splits the block before `place` and gives a place that is passed, rarely, if `token` is not 0.
llvm::Instruction* Guarded(llvm::Instruction* place, llvm::Value* token) {
  llvm::IRBuilder<> builder(place);
  llvm::Value* on = builder.CreateICmpNE(token, builder.getInt64(0));
  llvm::MDNode* rarely = llvm::MDBuilder(place->getContext()).createBranchWeights(1, 2000);
  return llvm::SplitBlockAndInsertIfThen(on, place, /*Unreachable=*/false, rarely);
}

void Guard(llvm::CallInst& event) {
  llvm::Value* token = event.getArgOperand(0);
  llvm::Instruction* place = event.getNextNode();
  llvm::Instruction* guarded = Guarded(place, token);
  llvm::BasicBlock* before = event.getParent();
  event.moveBefore(guarded);
  if (event.getType()->isVoidTy()) return;
  llvm::PHINode* result = llvm::IRBuilder<>(place).CreatePHI(event.getType(), 2);
  event.replaceAllUsesWith(result);
  result->addIncoming(token, before);
  result->addIncoming(&event, event.getParent());
}

}  // namespace

bool IsLeave(const llvm::Instruction& instruction) {
  const auto* call = llvm::dyn_cast<llvm::CallInst>(&instruction);
  return call != nullptr && call->isInlineAsm() &&
         call->getCalledOperand() == Leave(instruction.getContext());
}

llvm::Value* InsertEvents(llvm::Function& function) {
  ForgetPurity(function);
  llvm::LLVMContext& context = function.getContext();
  llvm::Instruction* place = EntryPlace(function);
  const std::string slot_code = SlotCode(RegionOf(function).text(), kSyntax);
  llvm::Value* slot = InsertCode(place, Code(context, slot_code, false, true, "=&r"), {});
  llvm::Value* token = InsertCode(place, Enter(context), slot);
  for (llvm::BasicBlock& block : function) {
    llvm::Instruction* exit = block.getTerminator();
    if (!llvm::isa<llvm::ReturnInst>(exit)) continue;
    if (llvm::CallInst* call = block.getTerminatingMustTailCall()) exit = call;
    InsertCode(exit, Leave(context), token);
  }
  return token;
}

void InsertLeaveForExceptions(llvm::Function& function, llvm::Value* token,
                              const TailCalls& tail_calls) {
  if (function.doesNotThrow()) return;
  llvm::LLVMContext& context = function.getContext();
  llvm::SmallVector<llvm::ResumeInst*, 4> exits;
  llvm::SmallVector<llvm::LandingPadInst*, 8> pads;
  llvm::SmallVector<llvm::CallInst*, 16> calls;
  for (llvm::BasicBlock& block : function) {
    if (llvm::LandingPadInst* pad = block.getLandingPadInst()) pads.push_back(pad);
    if (auto* exit = llvm::dyn_cast<llvm::ResumeInst>(block.getTerminator())) exits.push_back(exit);
    for (llvm::Instruction& instruction : block) {
      auto* call = llvm::dyn_cast<llvm::CallInst>(&instruction);
      if (call != nullptr && MayThrow(*call) && !tail_calls.count(call)) calls.push_back(call);
    }
  }
  if (exits.empty() && calls.empty()) return;
  if (!exits.empty())
    for (llvm::LandingPadInst* pad : pads) pad->setCleanup(true);

  auto* last = llvm::BasicBlock::Create(context, "stipple_resume", &function);
  llvm::IRBuilder<> builder(last);
  llvm::PHINode* exception =
      builder.CreatePHI(ExceptionType(context), static_cast<unsigned>(exits.size() + 1));
  llvm::Instruction* resume = builder.CreateResume(exception);
  InsertCode(resume, Leave(context), token);
  for (llvm::ResumeInst* exit : exits) {
    exception->addIncoming(exit->getValue(), exit->getParent());
    llvm::BranchInst::Create(last, exit);
    exit->eraseFromParent();
  }
  if (calls.empty()) return;
  llvm::LandingPadInst* caught = CatchAll(function, calls);
  exception->addIncoming(caught, caught->getParent());
  llvm::BranchInst::Create(last, caught->getParent());
}

void GuardEvents(llvm::Function& function) {
  const llvm::Value* enter = Enter(function.getContext());
  const llvm::Value* leave = Leave(function.getContext());
  llvm::SmallVector<llvm::CallInst*, 16> events;
  for (llvm::BasicBlock& block : function)
    for (llvm::Instruction& instruction : block) {
      auto* call = llvm::dyn_cast<llvm::CallInst>(&instruction);
      if (call == nullptr || !call->isInlineAsm()) continue;
      if (call->getCalledOperand() == enter || call->getCalledOperand() == leave)
        events.push_back(call);
    }
  if (events.empty()) return;
  EntryPlace(function);
  for (llvm::CallInst* event : events) Guard(*event);
}

}  // namespace stipple::plugin
