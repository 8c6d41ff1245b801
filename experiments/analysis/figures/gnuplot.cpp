module;
#include <sys/wait.h>

#include <cctype>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

module aabblab.figures;

import aabb.base;
import aabblab.files;
import aabblab.processes;

namespace aabblab {

namespace {

[[nodiscard]] std::string last_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);  // npos + 1 is 0
}

/// The date in a PDF is the only thing that changes when nothing else has. Blanks take its place, because a PDF says
/// where in the file its parts begin.
void remove_date(const std::filesystem::path& pdf) {
    std::string bytes = bytes_of_file(pdf);
    const std::size_t begin = bytes.find("/CreationDate (");
    const std::size_t end = bytes.find(')', begin);
    if (begin == std::string::npos || end == std::string::npos) return;
    bytes.replace(begin, end + 1 - begin, end + 1 - begin, ' ');
    write_file(pdf, bytes);
}

/// It has written both pictures when this returns.
void run_gnuplot(const std::filesystem::path& folder, const std::string& name) {
    // In the script's folder, without whatever its user has made gnuplot begin with.
    const child_result result = run_child("gnuplot", {"--default-settings", name + ".gp"},
                                          {.folder = folder, .input = "/dev/null", .errors = "/dev/stdout"});
    if (result.refused == ENOENT)
        throw aabb::input_error("figures are drawn by gnuplot, which is not there: the package gnuplot-nox has it");
    const std::string script = (folder / (name + ".gp")).string();
    if (result.refused != 0)
        throw aabb::input_error(script + ": gnuplot cannot be run: " + std::generic_category().message(result.refused));
    if (WIFEXITED(result.status) && WEXITSTATUS(result.status) == 0) return remove_date(folder / (name + ".pdf"));
    // Half a picture is none.
    std::error_code ignored;
    for (const char* const ending : {".svg", ".pdf"}) std::filesystem::remove(folder / (name + ending), ignored);
    if (WIFSIGNALED(result.status))
        throw aabb::input_error(script + ": gnuplot was ended by signal " + std::to_string(WTERMSIG(result.status)));
    throw aabb::input_error(script + ": gnuplot fails: " + last_line(result.printed));
}

}  // namespace

void draw(const std::filesystem::path& folder, std::span<const figure> figures) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error(folder.string() + ": cannot be made: " + error.message());
    for (const figure& f : figures) {
        write_file(folder / (f.name + ".csv"), csv_of(f));
        write_file(folder / (f.name + ".gp"), script_of(f));
    }
    for (const figure& f : figures) run_gnuplot(folder, f.name);
}

}  // namespace aabblab
