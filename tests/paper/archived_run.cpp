#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <filesystem>
#include <string>

#include "../experiments/program.hpp"
#include "../experiments/temporary_folder.hpp"

namespace {

const std::filesystem::path root = AABBLAB_CONFIGS "/../..";

}  // namespace

TEST_CASE("The archived run is whole, README says what is found in it, and so does a program of another language") {
    const temporary_folder folder;
    const std::string archive = (root / "paper/archive/full_run.tar.xz").string();
    const program_result judged = run_program({"reproduce", "--judge", archive, "--out", folder.path().string()});
    INFO(judged.err);
    REQUIRE(judged.status == 0);
    CHECK(judged.err.find("not sealed") == std::string::npos);

    const std::string report = bytes_of_file(folder / "report.md");
    const std::size_t from = report.find("\n|") + 1;
    const std::string table = report.substr(from, report.find("\n\n", from) + 1 - from);
    INFO(table);
    REQUIRE(table.find("| C13 |") != std::string::npos);
    CHECK(bytes_of_file(root / "README.md").find(table) != std::string::npos);

    const program_result again =
        run_command({"python3", (root / "tests/paper/recompute.py").string(), folder.path().string(), archive});
    INFO(again.out + again.err);
    CHECK(again.status == 0);
    CHECK(again.out.ends_with("of 14 claims recomputed, 0 differences\n"));
}
