// clang-tidy as a plugin of the compiler: a file is checked while it is compiled, and not parsed again for that. Checks
// see what the file itself declares. What it imports has a turn of its own, and would take four fifths of the time.
#include <clang-tidy/ClangTidy.h>
#include <clang-tidy/ClangTidyDiagnosticConsumer.h>
#include <clang-tidy/ClangTidyModule.h>
#include <clang/AST/ASTContext.h>
#include <clang/Frontend/CompilerInstance.h>
#include <clang/Frontend/FrontendPluginRegistry.h>

using namespace clang;

namespace {

class checks final : public ASTConsumer {
public:
    checks(CompilerInstance& compiler, StringRef file) : compiler_(compiler) {
        context_.setDiagnosticsEngine(&engine_);
        consumer_ = tidy::ClangTidyASTConsumerFactory(context_).createASTConsumer(compiler, file);
    }

    void HandleTranslationUnit(ASTContext& context) override {
        std::vector<Decl*> own;
        for (Decl* declaration : context.getTranslationUnitDecl()->noload_decls())
            if (!declaration->isFromASTFile() &&
                !context.getSourceManager().isInSystemHeader(declaration->getLocation()))
                own.push_back(declaration);
        context.setTraversalScope(own);
        consumer_->HandleTranslationUnit(context);
        unsigned errors = 0;
        tidy::handleErrors(findings_.take(), context_, tidy::FB_NoFix, errors, files_);
        DiagnosticsEngine& engine = compiler_.getDiagnostics();
        if (errors > 0) engine.Report(engine.getCustomDiagID(DiagnosticsEngine::Error, "clang-tidy finds mistakes"));
    }

private:
    CompilerInstance& compiler_;
    IntrusiveRefCntPtr<llvm::vfs::FileSystem> files_ = llvm::vfs::getRealFileSystem();
    tidy::ClangTidyContext context_{std::make_unique<tidy::FileOptionsProvider>(
        tidy::ClangTidyGlobalOptions(), tidy::ClangTidyOptions::getDefaults(), tidy::ClangTidyOptions(), files_)};
    tidy::ClangTidyDiagnosticConsumer findings_{context_};
    DiagnosticsEngine engine_{new DiagnosticIDs, new DiagnosticOptions, &findings_, false};
    std::unique_ptr<ASTConsumer> consumer_;
};

class clang_tidy final : public PluginASTAction {
    std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance& compiler, StringRef file) override {
        if (file.ends_with(".pcm")) return std::make_unique<ASTConsumer>();  // checked when it was compiled to that
        return std::make_unique<checks>(compiler, file);
    }
    bool ParseArgs(const CompilerInstance&, const std::vector<std::string>&) override { return true; }
    ActionType getActionType() override { return AddAfterMainAction; }
};

const FrontendPluginRegistry::Add<clang_tidy> added("clang-tidy", "Checks what a file declares.");

}  // namespace
