// Nothing is timed with a clock that is too coarse.

#include "program.hpp"

TEST_CASE_METHOD(in_folder, "Commands that time reject a clock of 15 ms resolution and write nothing") {
    const std::string config = folder.write("a.toml",
                                            "name = \"a\"\n[[scene]]\nkind = \"still\"\nobjects = 5\nframes = 1\n"
                                            "[[compose]]\nauto = true\n[measure]\nrepeats = 2\n");
    const std::string scene = folder / "a.aabbs";
    run_well({"scene", "still", "--n", "5", "--frames", "1", "--out", scene});
    const std::size_t files = folder.files();
    const std::string out = folder / "out";
    const auto on_coarse_clock = [](const std::vector<std::string>& arguments) {
        // The address sanitizer is preloaded second.
        return run_command(joined({"env", "ASAN_OPTIONS=verify_asan_link_order=0",
                                   std::string("LD_PRELOAD=") + AABBLAB_COARSE_CLOCK, AABBLAB_UNDER_TEST},
                                  arguments));
    };
    for (const std::vector<std::string>& command : {std::vector<std::string>{"calibrate", "--quick", "--out", out},
                                                    {"recommend", scene, "--report", out},
                                                    {"run", config, "--out", out},
                                                    {"explain", scene},
                                                    {"explain", config},
                                                    {"errors", "--quick", "--out", out},
                                                    {"atlas", "--quick", "--out", out}}) {
        CAPTURE(command);
        const program_result result = on_coarse_clock(command);
        CHECK(result.status == 2);
        CHECK(result.out.empty());
        CHECK(
            result.err.ends_with("aabblab: the clock of this machine has a resolution of 15.0 ms, too coarse for "
                                 "these times; at most 0.0100 ms is required\n"));
        CHECK(folder.files() == files);
    }
    // These commands do not need times.
    CHECK(on_coarse_clock({"pairs", scene}).status == 0);
    CHECK(on_coarse_clock({"validate", config}).status == 0);
}
