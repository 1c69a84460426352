// SPDX-License-Identifier: MIT
// Leaves before tail calls. Code generation makes a call a jump if nothing but the return follows
// it, so a leave behind it would cost the stack what mutual recursion of any depth does without.
//
// The return is mostly shared: calls come to it over a phi. Code generation would give each call a
// return of its own; we have to do it first, since it gives up at a leave. Whether it will make the
// jump is asked of no one (the target's answer is not to be had here) but judged by the rules of
// x86-64, and where in doubt the leave stays behind the call. A mistake costs no balance: a call
// taken for a jump is shown beside its caller instead of below.
//
// As written (`instrument=source`) the leaves went in before anything was known of tail calls, and
// calls that may throw became invokes of our pad; if the pad does no more than leave, the invoke
// becomes a call again.
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "llvm/Transforms/Utils/BasicBlockUtils.h"
#include "llvm/Transforms/Utils/Cloning.h"
#include "llvm/Transforms/Utils/Local.h"
#include "llvm/Transforms/Utils/ValueMapper.h"
#include "plugin/llvm/llvm.h"

namespace stipple::plugin {
namespace {

constexpr unsigned kIntegerRegisters = 6, kVectorRegisters = 8, kRegisterBits = 128;

// Nothing is generated for it, or nothing that stands in the way of a jump.
bool IsSilent(const llvm::Instruction& instruction) {
  const auto* intrinsic = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction);
  return intrinsic != nullptr &&
         (llvm::isa<llvm::DbgInfoIntrinsic>(intrinsic) || intrinsic->isLifetimeStartOrEnd() ||
          intrinsic->getIntrinsicID() == llvm::Intrinsic::assume);
}

bool IsConvention(llvm::CallingConv::ID convention) {
  return convention == llvm::CallingConv::C || convention == llvm::CallingConv::Fast;
}

// Registers that a value takes; false if it goes or may go by the stack.
bool CountRegisters(llvm::Type* type, unsigned& integers, unsigned& vectors) {
  if (type->isIntegerTy() && type->getIntegerBitWidth() <= kRegisterBits) {
    integers += type->getIntegerBitWidth() > 64 ? 2 : 1;
  } else if (type->isPointerTy()) {
    ++integers;
  } else if (type->isHalfTy() || type->isFloatTy() || type->isDoubleTy() || type->isFP128Ty()) {
    ++vectors;
  } else if (auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(type)) {
    if (vector->getPrimitiveSizeInBits().getFixedValue() > kRegisterBits) return false;
    ++vectors;
  } else if (auto* members = llvm::dyn_cast<llvm::StructType>(type)) {
    for (llvm::Type* member : members->elements())
      if (!CountRegisters(member, integers, vectors)) return false;
  } else {
    return false;
  }
  return true;
}

bool PassesOnlyRegisters(const llvm::CallBase& call) {
  unsigned integers = 0, vectors = 0;
  for (unsigned i = 0; i < call.arg_size(); ++i) {
    for (const auto attribute :
         {llvm::Attribute::ByVal, llvm::Attribute::InAlloca, llvm::Attribute::Preallocated,
          llvm::Attribute::StructRet, llvm::Attribute::Nest, llvm::Attribute::SwiftSelf,
          llvm::Attribute::SwiftError})
      if (call.paramHasAttr(i, attribute)) return false;
    if (!CountRegisters(call.getArgOperand(i)->getType(), integers, vectors)) return false;
  }
  return integers <= kIntegerRegisters && vectors <= kVectorRegisters;
}

bool ReturnsInRegisters(llvm::Type* type) {
  unsigned integers = 0, vectors = 0;
  return type->isVoidTy() ||
         (CountRegisters(type, integers, vectors) && integers <= 2 && vectors <= 2);
}

bool SameExtension(const llvm::CallBase& call, const llvm::Function& caller) {
  for (const auto attribute :
       {llvm::Attribute::ZExt, llvm::Attribute::SExt, llvm::Attribute::InReg}) {
    if (call.hasRetAttr(attribute) != caller.getAttributes().hasRetAttr(attribute)) return false;
  }
  return true;
}

/// No call of the function is made a jump; of those that come after us, the sanitizers put calls of
/// their own in front of every return.
bool MakesNoJumps(const llvm::Function& function) {
  for (const auto attribute : {llvm::Attribute::OptimizeNone, llvm::Attribute::SanitizeAddress,
                               llvm::Attribute::SanitizeHWAddress, llvm::Attribute::SanitizeMemory,
                               llvm::Attribute::SanitizeThread, llvm::Attribute::StackAlignment})
    if (function.hasFnAttribute(attribute)) return true;
  for (const char* attribute :
       {"instrument-function-exit", "instrument-function-exit-inlined", "stackrealign"})
    if (function.hasFnAttribute(attribute)) return true;
  if (function.getFnAttribute("disable-tail-calls").getValueAsString() == "true" ||
      function.hasStructRetAttr() || function.callsFunctionThatReturnsTwice() ||
      !IsConvention(function.getCallingConv()) || !ReturnsInRegisters(function.getReturnType()))
    return true;
  for (const llvm::BasicBlock& block : function)
    for (const llvm::Instruction& instruction : block) {
      const auto* variable = llvm::dyn_cast<llvm::AllocaInst>(&instruction);
      if (variable != nullptr &&
          (!variable->isStaticAlloca() || variable->getAlign().value() > kRegisterBits / 8))
        return true;
    }
  return false;
}

bool HasVariables(const llvm::Function& function) {
  for (const llvm::Argument& argument : function.args())
    if (argument.hasByValAttr()) return true;
  for (const llvm::BasicBlock& block : function)
    for (const llvm::Instruction& instruction : block)
      if (llvm::isa<llvm::AllocaInst>(instruction)) return true;
  return false;
}

// Whether an exception from the invoke does nothing on its way out but leave.
bool OnlyLeaves(const llvm::InvokeInst& invoke) {
  const llvm::BasicBlock* block = invoke.getUnwindDest();
  const llvm::LandingPadInst* pad = block->getLandingPadInst();
  if (pad->getNumClauses() != 0) return false;
  for (unsigned passed = 0; passed < 8; ++passed) {
    for (const llvm::Instruction& instruction : *block) {
      if (&instruction == block->getTerminator() || IsSilent(instruction) || IsLeave(instruction))
        continue;
      if (!llvm::isa<llvm::LandingPadInst, llvm::PHINode, llvm::ExtractValueInst,
                     llvm::InsertValueInst>(instruction))
        return false;
    }
    if (llvm::isa<llvm::ResumeInst>(block->getTerminator())) return true;
    block = block->getSingleSuccessor();
    if (block == nullptr) return false;
  }
  return false;
}

/// `marked`: a call that the optimiser has found not to use the caller's variables.
bool CanBeJump(const llvm::CallBase& call) {
  if (call.isInlineAsm() || llvm::isa<llvm::IntrinsicInst>(call) || call.hasOperandBundles() ||
      call.doesNotReturn() || !IsConvention(call.getCallingConv()) ||
      !ReturnsInRegisters(call.getType()) || !PassesOnlyRegisters(call) ||
      !SameExtension(call, *call.getFunction()))
    return false;
  if (const auto* plain = llvm::dyn_cast<llvm::CallInst>(&call))
    return plain->isTailCall() && !plain->isMustTailCall();
  const auto* invoke = llvm::dyn_cast<llvm::InvokeInst>(&call);
  return invoke != nullptr && OnlyLeaves(*invoke) && !HasVariables(*call.getFunction());
}

/// What happens between a call and the return.
class WayOut {
 public:
  explicit WayOut(llvm::CallBase& call) : call_(call), block_(call.getParent()) {}

  /// Whether that is only leaves, at least one, and nothing that a jump could not do.
  bool IsFree() {
    llvm::Instruction* next = llvm::isa<llvm::InvokeInst>(call_)
                                  ? Follow(llvm::cast<llvm::InvokeInst>(call_).getNormalDest())
                                  : call_.getNextNode();
    while (true) {
      if (IsLeave(*next)) {
        leaves_.push_back(next);
      } else if (auto* exit = llvm::dyn_cast<llvm::ReturnInst>(next)) {
        const llvm::Value* value = exit->getReturnValue();
        return !leaves_.empty() && (value == nullptr || Known(value) == &call_);
      } else if (auto* branch = llvm::dyn_cast<llvm::BranchInst>(next)) {
        if (branch->isConditional() || blocks_.size() > 8) return false;
        next = Follow(branch->getSuccessor(0));
        continue;
      } else if (llvm::isa<llvm::BitCastInst>(next)) {
        known_[next] = Known(next->getOperand(0));
      } else if (!IsSilent(*next)) {
        return false;
      }
      next = next->getNextNode();
    }
  }

  /// Leaves before the call, and returns from its own block.
  llvm::CallInst* Take() {
    auto* call = llvm::dyn_cast<llvm::CallInst>(&call_);
    if (call == nullptr) {
      call = llvm::changeToCall(llvm::cast<llvm::InvokeInst>(&call_));
      call->setTailCall();
    }
    llvm::SmallVector<llvm::Value*, 4> tokens;
    for (llvm::Instruction* leave : leaves_)
      tokens.push_back(const_cast<llvm::Value*>(Known(leave->getOperand(0))));
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      llvm::Instruction* leave = leaves_[i]->clone();
      leave->setOperand(0, tokens[i]);
      leave->insertBefore(call);
      if (leaves_[i]->getParent() == block_) leaves_[i]->eraseFromParent();
    }
    if (!blocks_.empty()) ReturnAt(*block_->getTerminator(), call);
    return call;
  }

 private:
  // What a value is for who comes by this way.
  const llvm::Value* Known(const llvm::Value* value) const {
    const auto found = known_.find(value);
    return found == known_.end() ? value : found->second;
  }

  llvm::Instruction* Follow(llvm::BasicBlock* block) {
    const llvm::BasicBlock* from = blocks_.empty() ? block_ : blocks_.back();
    llvm::SmallVector<std::pair<const llvm::Value*, const llvm::Value*>, 4> values;
    for (const llvm::PHINode& phi : block->phis())
      values.emplace_back(&phi, Known(phi.getIncomingValueForBlock(from)));
    for (const auto& [phi, value] : values) known_[phi] = value;
    blocks_.push_back(block);
    return &*block->getFirstNonPHIOrDbg(/*SkipPseudoOp=*/false);
  }

  void ReturnAt(llvm::Instruction& branch, llvm::CallInst* call) {
    auto* shared = llvm::cast<llvm::ReturnInst>(blocks_.back()->getTerminator());
    llvm::Value* value = shared->getReturnValue();
    if (value != nullptr) {
      value = call;
      if (call->getType() != shared->getReturnValue()->getType())
        value = llvm::CastInst::Create(llvm::Instruction::BitCast, call,
                                       shared->getReturnValue()->getType(), "", &branch);
    }
    auto* exit = llvm::ReturnInst::Create(branch.getContext(), value, &branch);
    exit->setDebugLoc(shared->getDebugLoc());
    blocks_.front()->removePredecessor(block_);
    branch.eraseFromParent();
  }

  llvm::CallBase& call_;
  llvm::BasicBlock* block_;
  llvm::SmallVector<llvm::BasicBlock*, 4> blocks_;  // behind the call's own
  llvm::SmallVector<llvm::Instruction*, 4> leaves_;
  llvm::DenseMap<const llvm::Value*, const llvm::Value*> known_;
};

}  // namespace

TailCalls LeaveBeforeTailCalls(llvm::Function& function) {
  TailCalls left;
  if (MakesNoJumps(function)) return left;
  llvm::SmallVector<llvm::CallBase*, 16> calls;
  for (llvm::BasicBlock& block : function)
    for (llvm::Instruction& instruction : block) {
      auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
      if (call != nullptr && CanBeJump(*call)) calls.push_back(call);
    }
  for (llvm::CallBase* call : calls) {
    WayOut way(*call);
    if (way.IsFree()) left.insert(way.Take());
  }
  if (!left.empty()) llvm::EliminateUnreachableBlocks(function);
  return left;
}

}  // namespace stipple::plugin
