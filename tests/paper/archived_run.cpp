#include <catch2/generators/catch_generators.hpp>
#include <csignal>

#include "../experiments/program.hpp"

namespace {

const std::filesystem::path root = AABBLAB_CONFIGS "/../..";
const std::string full_run = "paper/archive/full_run.tar.xz";

/// Judges an archive, which must be intact, into a folder.
void judge_published(const std::string& archive, const temporary_folder& folder) {
    const program_result judged =
        run_well({"reproduce", "--judge", (root / archive).string(), "--out", folder.path().string()});
    CHECK_FALSE(holds(judged.err, "not sealed"));
    CHECK(judged.out.ends_with("The results are those of the published run, " + archive + ".\n"));
}

/// What the independent program says of the report of an archive.
std::string recomputed(const std::string& archive, const temporary_folder& report) {
    const program_result result = run_command(
        {"python3", (root / "tests/paper/recompute.py").string(), report.path(), (root / archive).string()});
    INFO(result.out + result.err);
    CHECK(result.status == 0);
    return result.out;
}

const std::string without_differences = " claims recomputed, 0 differences\n";

}  // namespace

TEST_CASE_METHOD(in_folder, "Unpacked files of an archive are removed when the program ends, even by a signal") {
    const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP, SIGKILL);
    CAPTURE(signal);
    const std::filesystem::path unpacked = folder / "tmp";
    std::filesystem::create_directory(unpacked);
    const pid_t program = started({"env", "TMPDIR=" + unpacked.string(), AABBLAB_UNDER_TEST, "reproduce", "--judge",
                                   (root / full_run).string(), "--out", (folder / "out").string()});
    // The signal comes while files are unpacked.
    const bool began = comes_true([&] { return !std::filesystem::is_empty(unpacked); });
    usleep(200'000);
    const bool was_there = !std::filesystem::is_empty(unpacked);
    kill(program, signal);
    waitpid(program, nullptr, 0);
    CHECK(began);
    CHECK(was_there);
    CHECK(comes_true([&] { return std::filesystem::is_empty(unpacked); }));
}

TEST_CASE("The archived run is intact, and README and an independent program agree with it", "[long]") {
    const temporary_folder folder;
    judge_published(full_run, folder);
    const std::string report = bytes_of_file(folder / "report.md");
    const std::size_t from = report.find("\n|") + 1;
    const std::string table = report.substr(from, report.find("\n\n", from) + 1 - from);
    INFO(table);
    REQUIRE(holds(table, "| C12 |"));
    CHECK(holds(bytes_of_file(root / "README.md"), table));

    const auto claims = std::ranges::count(table, '\n') - 2 + 1;  // without the table's head, and with SMB's claim
    const std::string output = recomputed(full_run, folder);
    CHECK(output.ends_with(" of " + std::to_string(claims) + without_differences));
    // It has no measures of the scenes of its atlas.
    CHECK(holds(output, "51 figures with "));
    CHECK(holds(output, "recomputed; not recomputed: map_classic_inversions, map_inversions (there are no measures"));
}

TEST_CASE("The earlier run on another processor is intact, and an independent program agrees with its verdicts",
          "[long]") {
    const temporary_folder folder;
    const std::string archive = "paper/archive/full_run_zen5.tar.xz";
    const program_result judged =
        run_well({"reproduce", "--judge", (root / archive).string(), "--out", folder.path().string()});
    CHECK_FALSE(holds(judged.err, "not sealed"));
    CHECK(holds(judged.out, " of 20 verdicts agree with the published run, " + full_run + ":\n"));
    CHECK(recomputed(archive, folder).ends_with(without_differences));
}

TEST_CASE("The archived quick run is intact and is what quick runs are compared with") {
    judge_published("paper/archive/quick_run.tar.xz", temporary_folder());
}

TEST_CASE("Published regrets of the atlas follow from its published times, by an independent program") {
    const std::filesystem::path results = root / "experiments/configs/atlas/results";
    const program_result result =
        run_command({"python3", (root / "tests/paper/recompute_regrets.py").string(), results.string()});
    INFO(result.out + result.err);
    CHECK(result.status == 0);
    for (const char* table : {"regrets.csv", "regrets_whole.csv", "regrets_unseen.csv"})
        CHECK(holds(result.out, std::string(table) + ": 35 candidates in "));
}
