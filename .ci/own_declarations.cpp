// A plugin that keeps clang-tidy to what a file itself declares. Without it every check walks through all that the file
// imports, each module with the headers in it, which takes four fifths of the time: those have a turn of their own.
#include <clang-tidy/ClangTidyCheck.h>
#include <clang-tidy/ClangTidyModule.h>
#include <clang-tidy/ClangTidyModuleRegistry.h>
#include <clang/AST/ASTContext.h>
#include <clang/ASTMatchers/ASTMatchers.h>
#include <clang/Lex/Preprocessor.h>
#include <clang/Serialization/ASTReader.h>

#include <vector>

namespace {

using namespace clang;

class own_declarations final : public tidy::ClangTidyCheck {
public:
    using ClangTidyCheck::ClangTidyCheck;

    void registerPPCallbacks(const SourceManager&, Preprocessor* preprocessor, Preprocessor*) override {
        preprocessor_ = preprocessor;
    }

    // It is told of the start of the walk only if it waits for something.
    void registerMatchers(ast_matchers::MatchFinder* finder) override {
        finder->addMatcher(ast_matchers::translationUnitDecl(), this);
    }

    void onStartOfTranslationUnit() override {
        auto* reader = static_cast<ASTReader*>(preprocessor_->getExternalSource());
        if (!reader) return;  // it imports nothing
        ASTContext& context = reader->getContext();
        const SourceManager& sources = context.getSourceManager();
        std::vector<Decl*> own;
        for (Decl* declaration : context.getTranslationUnitDecl()->noload_decls())
            if (!declaration->isFromASTFile() && !sources.isInSystemHeader(declaration->getLocation()))
                own.push_back(declaration);
        context.setTraversalScope(own);
    }

private:
    Preprocessor* preprocessor_ = nullptr;
};

class own_declarations_module final : public tidy::ClangTidyModule {
public:
    void addCheckFactories(tidy::ClangTidyCheckFactories& factories) override {
        factories.registerCheck<own_declarations>("aabblab-own-declarations");
    }
};

const tidy::ClangTidyModuleRegistry::Add<own_declarations_module> added("aabblab",
                                                                        "Looks at a file's own declarations.");

}  // namespace
