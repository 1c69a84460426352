// SPDX-License-Identifier: MIT
// What the source says by attribute, made visible to the pass. clang keeps no_instrument_function
// and xray_always_instrument to itself, but passes on xray_never_instrument and annotations: so a
// function with one of the former is given one of the latter before code is generated for it.
//
// Own shared object: it needs clang's symbols, which opt and the linker do not have (attach.cpp).
// Files that never mention such an attribute, nearly all, cost a look at the table of identifiers
// for each declaration at file scope.
#include "clang/AST/ASTConsumer.h"
#include "clang/AST/ASTContext.h"
#include "clang/AST/Attr.h"
#include "clang/AST/RecursiveASTVisitor.h"
#include "clang/Basic/IdentifierTable.h"
#include "clang/Frontend/FrontendPluginRegistry.h"
#include "llvm/Config/llvm-config.h"

namespace stipple::plugin {
namespace {

// The two kinds of argument lists that releases want for a made-up attribute.
#if LLVM_VERSION_MAJOR >= 17
#define STIPPLE_MADE_UP clang::SourceRange()
#else
#define STIPPLE_MADE_UP clang::SourceRange(), clang::AttributeCommonInfo::AS_GNU
#endif

constexpr char kAlways[] = "xray_always_instrument";

bool IsAnnotatedAlways(const clang::FunctionDecl& function) {
  for (const auto* note : function.specific_attrs<clang::AnnotateAttr>())
    if (note->getAnnotation() == kAlways) return true;
  return false;
}

class Marker : public clang::RecursiveASTVisitor<Marker> {
 public:
  static bool shouldVisitTemplateInstantiations() { return true; }
  static bool shouldVisitLambdaBody() { return true; }
  static bool shouldVisitImplicitCode() { return true; }

  bool VisitFunctionDecl(clang::FunctionDecl* function) {
    clang::ASTContext& context = function->getASTContext();
    const auto* xray = function->getAttr<clang::XRayInstrumentAttr>();
    if (function->hasAttr<clang::NoInstrumentFunctionAttr>() && xray == nullptr) {
      function->addAttr(clang::XRayInstrumentAttr::CreateImplicit(
          context, STIPPLE_MADE_UP, clang::XRayInstrumentAttr::GNU_xray_never_instrument));
    } else if (xray != nullptr && xray->alwaysXRayInstrument() && !IsAnnotatedAlways(*function)) {
      function->addAttr(
          clang::AnnotateAttr::CreateImplicit(context, kAlways, nullptr, 0, STIPPLE_MADE_UP));
    }
    return true;
  }
};

class Consumer : public clang::ASTConsumer {
 public:
  void Initialize(clang::ASTContext& context) override { context_ = &context; }

  // Non-inline functions are generated right after this call.
  bool HandleTopLevelDecl(clang::DeclGroupRef group) override {
    if (IsAttributeMentioned())
      for (clang::Decl* declaration : group) Marker().TraverseDecl(declaration);
    return true;
  }

  // All others, among them instances of templates, after this one.
  void HandleTranslationUnit(clang::ASTContext& context) override {
    if (IsAttributeMentioned()) Marker().TraverseDecl(context.getTranslationUnitDecl());
  }

 private:
  bool IsAttributeMentioned() {
    if (mentioned_) return true;
    const clang::IdentifierTable& words = context_->Idents;
    if (words.size() == words_) return false;
    words_ = words.size();
    // A precompiled header's words are not in the table.
    mentioned_ = words.getExternalIdentifierLookup() != nullptr;
    for (const char* word : {"no_instrument_function", "__no_instrument_function__",
                             "xray_always_instrument", "xray_never_instrument"})
      mentioned_ = mentioned_ || words.find(word) != words.end();
    return mentioned_;
  }

  clang::ASTContext* context_ = nullptr;
  bool mentioned_ = false;
  unsigned words_ = 0;  // in the table when it was last looked at
};

class Action : public clang::PluginASTAction {
 protected:
  std::unique_ptr<clang::ASTConsumer> CreateASTConsumer(clang::CompilerInstance&,
                                                        llvm::StringRef) override {
    return std::make_unique<Consumer>();
  }
  bool ParseArgs(const clang::CompilerInstance&, const std::vector<std::string>&) override {
    return true;
  }
  ActionType getActionType() override { return AddBeforeMainAction; }
};

const clang::FrontendPluginRegistry::Add<Action> kAction("stipple", "tells attributes to the pass");

}  // namespace
}  // namespace stipple::plugin
