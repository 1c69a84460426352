// SPDX-License-Identifier: MIT
// Where LLVM meets us: the options, the two positions, the object block.
#include <optional>

#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/Module.h"
#include "llvm/Passes/PassBuilder.h"
#include "llvm/Passes/PassPlugin.h"
#include "llvm/Support/CommandLine.h"
#include "plugin/llvm/llvm.h"

namespace stipple::plugin {
namespace {

// One prefix takes them all, so that unknown names come to us and get the same answer as from GCC.
// -mllvm needs to know it before the pass plugin is loaded: give -fplugin= as well.
llvm::cl::list<std::string> given_options("stipple-", llvm::cl::Prefix,
                                          llvm::cl::desc("NAME=VALUE, an option of stipple"),
                                          llvm::cl::value_desc("NAME=VALUE"));

// Both positions read the options; what is wrong with them is said once.
void Say(const std::string& problem, llvm::LLVMContext& context) {
  static bool said = false;
  if (!said) context.emitError(problem);
  said = true;
}

bool ReadOptions(Options& options, llvm::LLVMContext& context) {
  for (const std::string& given : given_options) {
    const std::size_t equals = given.find('=');
    const std::string value = equals == std::string::npos ? "" : given.substr(equals + 1);
    if (const auto problem = SetOption(options, given.substr(0, equals), value)) {
      Say(*problem, context);
      return false;
    }
  }
  return true;
}

bool IsUnsplitCoroutine(const llvm::Function& function) {
#if LLVM_VERSION_MAJOR >= 15
  return function.hasFnAttribute(llvm::Attribute::PresplitCoroutine);
#else
  return function.hasFnAttribute("coroutine.presplit");
#endif
}

// A coroutine's body is a function only later, when the optimiser has taken it apart; until then
// this marks it, and the parts inherit the mark.
constexpr char kLater[] = "stipple-later";

bool CanHoldEvents(const llvm::Function& function) {
  // An available_externally body is only there to be inlined; the real one is elsewhere.
  return !function.isDeclaration() && !function.hasAvailableExternallyLinkage() &&
         !function.hasFnAttribute(llvm::Attribute::Naked) && !IsUnsplitCoroutine(function);
}

/// How the function's events are written; none: it gets none.
std::optional<Form> FormOf(llvm::Function& function, Selection& selection) {
  if (!CanHoldEvents(function)) return std::nullopt;
  const FunctionFacts facts = FactsOf(function);
  if (!selection.Select(facts).instrument) return std::nullopt;
  return facts.makes_calls ? Form::kCall : Form::kInline;
}

// -masm=intel, which newer versions apply to file-scope assembly as well. The option is LLVM's own;
// its type is local to a source file there, so the value is looked at as what an enumeration is.
bool IsIntelSyntax() {
  const auto& known = llvm::cl::getRegisteredOptions();
  const auto syntax = known.find("x86-asm-syntax");
  if (syntax == known.end() || syntax->second->getNumOccurrences() == 0) return false;
  return static_cast<const llvm::cl::opt<int>*>(syntax->second)->getValue() == 1;
}

void AddObjectCode(llvm::Module& module) {
  const bool intel = IsIntelSyntax();
  if (intel) module.appendModuleInlineAsm(".att_syntax prefix");
  module.appendModuleInlineAsm(ObjectCode());
  if (intel) module.appendModuleInlineAsm(".intel_syntax noprefix");
}

// Both positions come here; as written (`instrument=source`) the early one inserts and the late one
// finishes. -O0 makes no call a jump.
class EventPass : public llvm::PassInfoMixin<EventPass> {
 public:
  EventPass(Position position, llvm::OptimizationLevel level)
      : position_(position), optimises_(level != llvm::OptimizationLevel::O0) {}

  static bool isRequired() { return true; }  // at -O0 too

  llvm::PreservedAnalyses run(llvm::Module& module, llvm::ModuleAnalysisManager&) {
    Options options;
    const bool late = position_ == Position::kAfterInlining;
    if (!ReadOptions(options, module.getContext()) || (!late && options.position != position_))
      return llvm::PreservedAnalyses::all();
    const bool inserts = options.position == position_;
    Selection selection(options);
    if (const auto problem = selection.ReadFilterFile()) {
      Say(*problem, module.getContext());
      return llvm::PreservedAnalyses::all();
    }
    const bool preserve_tail_calls = optimises_ && options.tail_calls_preserved;
    bool changed = false;
    for (llvm::Function& function : module) {
      TailCalls tail_calls;
      if (!late && IsUnsplitCoroutine(function)) function.addFnAttr(kLater);
      if (!inserts && !function.hasFnAttribute(kLater)) {
        if (preserve_tail_calls) LeaveBeforeTailCalls(function);
      } else if (const std::optional<Form> form = FormOf(function, selection)) {
        llvm::Value* token = InsertEvents(function, *form);
        if (late && preserve_tail_calls) tail_calls = LeaveBeforeTailCalls(function);
        if (options.exceptions) InsertLeaveForExceptions(function, token, tail_calls);
        changed = true;
      }
      if (late) GuardEvents(function);
    }
    if (const std::string note = selection.Note(); inserts && !note.empty())
      llvm::errs() << note << '\n';
    if (!selection.Account().empty())
      module.appendModuleInlineAsm(AccountCode(selection.Account()));
    if (changed) AddObjectCode(module);
    return llvm::PreservedAnalyses::none();
  }

 private:
  Position position_;
  bool optimises_;
};

void AddPasses(llvm::PassBuilder& builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager& manager, llvm::OptimizationLevel level) {
        manager.addPass(EventPass(Position::kSource, level));
      });
  builder.registerOptimizerLastEPCallback(
      [](llvm::ModulePassManager& manager, llvm::OptimizationLevel level, auto...) {
        manager.addPass(EventPass(Position::kAfterInlining, level));
      });
}

}  // namespace
}  // namespace stipple::plugin

extern "C" LLVM_ATTRIBUTE_WEAK __attribute__((visibility("default"))) llvm::PassPluginLibraryInfo
llvmGetPassPluginInfo() {
  return {LLVM_PLUGIN_API_VERSION, "stipple", "1", stipple::plugin::AddPasses};
}
