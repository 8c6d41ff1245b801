#include <fcntl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <csignal>

#include "commands/command_parser.hpp"

import aabb.base;
import aabb.std;
import aabblab.configs;
import aabblab.output;
import aabblab.pair_output;

namespace aabblab {

namespace {

constexpr int check_failed = 1, bad_input = 2;

/// Parses the command line, which sets the command to run; prints the version or help, for which the parser throws.
void parse(CLI::App& program, int argc, char** argv) {
    try {
        program.parse(argc, argv);
        require_command(program);
    } catch (const CLI::CallForVersion& version) {
        print(std::string(version.what()) + "\n");
    } catch (const CLI::CallForHelp&) {
        print(program.help());
    } catch (const CLI::ParseError& error) {
        throw aabb::input_error(rejection_of(program, error));
    }
}

/// Opens closed standard streams as /dev/null; else a file opened later would take their number and get their output.
/// @throws aabb::input_error if standard output is closed.
void open_standard_streams() {
    bool is_closed = false;
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) >= 0) continue;
        is_closed |= stream == STDOUT_FILENO;
        // open() returns the lowest free number, which is that of this stream.
        if (open("/dev/null", O_RDWR) != stream) throw aabb::input_error("/dev/null cannot be opened");
    }
    if (is_closed) throw aabb::input_error("standard output is closed, so nothing can be printed");
}

/// Prints the error after all earlier output, and returns the exit status for it.
int report_error(int status, const std::string& sentence) {
    try {
        flush_output();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
        // Of two errors the first is reported.
    }
    note(sentence);
    return status;
}

/// Runs the program, reports an exception in one sentence, and returns the exit status.
int run_program(int argc, char** argv) {
    std::signal(SIGCHLD, SIG_DFL);  // if inherited as ignored, waitpid could not report a status
    std::signal(SIGPIPE, SIG_IGN);  // print() handles a closed pipe by its error EPIPE
    int status = 0;
    try {
        open_standard_streams();
        CLI::App program("AABB Lab composes, validates and times collision detection with axis-aligned bounding boxes",
                         "aabblab");
        program.set_version_flag("--version", "aabblab " AABBLAB_VERSION, "Print the version");
        program.set_help_flag("-h,--help", "Print this help");
        program.require_subcommand(0, 1);
        wrap_help(program);
        std::function<int()> run_command;  // empty if the command line asks for help or the version
        add_commands({program, run_command});
        // Set last, so that commands do not inherit it.
        program.footer(
            "Further commands of the script aabblab at the root of the source tree:\n"
            "  test                        Build and run every test\n"
            "  data                        Download the mesh files of the experiments\n"
            "  benchmark                   Time each stage, elementary test and build separately\n"
            "  paper                       Write the report of a reproduction as a PDF\n"
            "Except for these four, aabblab COMMAND --help lists the options of a command.\n"
            "Exit status: 0 on success; 1 if a check fails or --exit-code finds an intersection; 2 on invalid input.");
        // Costs are loaded before every command except calibrate, which must run even if the file is malformed.
        program.parse_complete_callback([&] {
            if (!program.got_subcommand("calibrate")) use_calibrated_costs();
        });
        parse(program, argc, argv);
        if (run_command) status = run_command();
        flush_output();
        return status;
    } catch (const output_closed&) {
        return status;
    } catch (const aabb::input_error& error) {
        return report_error(bad_input, error.what());
    } catch (const defect& error) {
        return report_error(check_failed, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        const std::string path = error.path1().string();
        return report_error(bad_input, (path.empty() ? "" : path + ": ") + error.code().message());
    } catch (const std::bad_alloc&) {
        return report_error(bad_input, "the input or its result does not fit into memory");
    } catch (const std::length_error&) {
        return report_error(bad_input, "the input or its result does not fit into memory");
    } catch (const std::exception& error) {
        return report_error(check_failed, std::string("internal error: ") + error.what());
    }
}

}  // namespace

}  // namespace aabblab

int main(int argc, char** argv) {
    return aabblab::run_program(argc, argv);
}
