// SPDX-License-Identifier: MIT
// Where LLVM meets us: the options, the two positions, the object block.
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

bool ReadOptions(Options& options, llvm::LLVMContext& context) {
  for (const std::string& given : given_options) {
    const std::size_t equals = given.find('=');
    const std::string value = equals == std::string::npos ? "" : given.substr(equals + 1);
    if (const auto problem = SetOption(options, given.substr(0, equals), value)) {
      context.emitError(*problem);
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

bool CanHoldEvents(const llvm::Function& function) {
  // An available_externally body is only there to be inlined; the real one is elsewhere.
  return !function.isDeclaration() && !function.hasAvailableExternallyLinkage() &&
         !function.hasFnAttribute(llvm::Attribute::Naked) && !IsUnsplitCoroutine(function);
}

class EventPass : public llvm::PassInfoMixin<EventPass> {
 public:
  explicit EventPass(Position position) : position_(position) {}

  static bool isRequired() { return true; }  // at -O0 too

  llvm::PreservedAnalyses run(llvm::Module& module, llvm::ModuleAnalysisManager&) {
    Options options;
    if (!ReadOptions(options, module.getContext()) || options.position != position_)
      return llvm::PreservedAnalyses::all();
    bool changed = false;
    for (llvm::Function& function : module) {
      if (!CanHoldEvents(function)) continue;
      const FunctionFacts facts = FactsOf(function);
      if (!Select(facts, options).instrument) continue;
      Instrument(function, facts.makes_calls ? Form::kCall : Form::kInline);
      changed = true;
    }
    if (!changed) return llvm::PreservedAnalyses::all();
    module.appendModuleInlineAsm(ObjectCode());
    return llvm::PreservedAnalyses::none();
  }

 private:
  Position position_;
};

void AddPasses(llvm::PassBuilder& builder) {
  builder.registerPipelineStartEPCallback(
      [](llvm::ModulePassManager& manager, llvm::OptimizationLevel) {
        manager.addPass(EventPass(Position::kSource));
      });
  builder.registerOptimizerLastEPCallback(
      [](llvm::ModulePassManager& manager, llvm::OptimizationLevel, auto...) {
        manager.addPass(EventPass(Position::kAfterInlining));
      });
}

}  // namespace
}  // namespace stipple::plugin

extern "C" LLVM_ATTRIBUTE_WEAK __attribute__((visibility("default"))) llvm::PassPluginLibraryInfo
llvmGetPassPluginInfo() {
  return {LLVM_PLUGIN_API_VERSION, "stipple", "1", stipple::plugin::AddPasses};
}
