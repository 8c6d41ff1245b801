// Costs of a machine: how they are fitted, kept, read and told.

#include <nlohmann/json.hpp>

#include "program.hpp"

import aabblab.calibrate;
import aabblab.configs;
import aabblab.machine;
import aabblab.statistics;

namespace {

using aabblab::timed_work;

/// Observations whose times are these costs of the work, and a little noise.
std::vector<timed_work> made_of(const std::vector<double>& costs, double noise) {
    std::vector<timed_work> all;
    std::uint64_t random = 1;
    const auto next = [&] {
        random = random * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(random >> 11U) / static_cast<double>(std::uint64_t{1} << 53U);
    };
    for (int scene = 0; scene < 12; ++scene)
        for (int piece = 0; piece < 2; ++piece) {
            timed_work one{"scene " + std::to_string(scene), {}, {}};
            double ns = 0;
            for (const double cost : costs) {
                one.work.push_back(std::pow(10.0, 2 + 3 * next()) / cost);  // none is lost in the others
                ns += cost * one.work.back();
            }
            for (int repeat = 0; repeat < 5; ++repeat) one.ns.push_back(ns * (1 + noise * (2 * next() - 1)));
            all.push_back(one);
        }
    return all;
}

bool is_near(double a, double b, double share) {
    return std::abs(a - b) <= share * std::abs(b);
}

aabb::cost_model odd_costs() {
    aabb::cost_model costs;
    double value = 0.1;
    for (const aabb::cost_info& cost : aabb::cost_infos) costs.*cost.value = value *= 1.7;
    return costs;
}

std::string text_here() {
    return text_of(aabblab::label_costs(odd_costs()));
}

std::string rejection_of(const std::string& text) {
    return refusal_in<aabb::input_error>([&] { return aabblab::parse_costs(text, "costs.toml"); });
}

/// A user's folder of configurations, perhaps with costs in it.
struct configured {
    temporary_folder folder;

    configured() = default;
    explicit configured(const std::string& costs) { folder.write("config/aabblab/costs.toml", costs); }
    [[nodiscard]] std::filesystem::path file() const { return folder / "config/aabblab/costs.toml"; }
    [[nodiscard]] program_result run(const std::vector<std::string>& arguments) const {
        return run_command(
            joined({"env", "XDG_CONFIG_HOME=" + (folder / "config").string(), AABBLAB_UNDER_TEST}, arguments));
    }
    /// Runs an experiment of two frames.
    [[nodiscard]] program_result run_experiment(const std::vector<std::string>& more = {}) const {
        const auto config =
            folder.write("a.toml", "name = \"a\"\n[[compose]]\n[[scene]]\nkind = \"pile\"\nobjects = 60\nframes = 2\n");
        return run(joined({"run", config, "--out", folder / "r"}, more));
    }
    [[nodiscard]] nlohmann::json costs_of_run() const {
        return nlohmann::json::parse(bytes_of_file(folder / "r/manifest.json"))["costs"];
    }
};

}  // namespace

TEST_CASE("A fit finds the costs that times were made of") {
    const std::vector<double> costs{8, 0.75, 250};
    const std::vector<aabblab::estimate> exact = aabblab::fit_costs(made_of(costs, 0));
    REQUIRE(exact.size() == costs.size());
    for (std::size_t k = 0; k < costs.size(); ++k) CHECK(is_near(exact[k].value, costs[k], 1e-6));
    const std::vector<timed_work> noisy = made_of(costs, 0.1);
    const std::vector<aabblab::estimate> found = aabblab::fit_costs(noisy);
    for (std::size_t k = 0; k < costs.size(); ++k) {
        CHECK(is_near(found[k].value, costs[k], 0.1));
        CHECK(found[k].error > 0);
        const auto [low, high] = found[k].range(0.0005);
        CHECK((low <= costs[k] && costs[k] <= high));
    }
    CHECK(aabblab::accuracy_of(noisy, exact).worst < 1.1);
}

TEST_CASE("A fit is not led astray by a few times that are far off, nor below 0") {
    const std::vector<double> costs{8, 0.75, 250};
    std::vector<timed_work> seen = made_of(costs, 0.01);
    for (const std::size_t off : {3U, 10U})
        for (double& ns : seen[off].ns) ns *= 5;
    const std::vector<aabblab::estimate> found = aabblab::fit_costs(seen);
    for (std::size_t k = 0; k < costs.size(); ++k) CHECK(is_near(found[k].value, costs[k], 0.05));
    const aabblab::accuracy off = aabblab::accuracy_of(seen, found);
    CHECK(off.observations == 24);
    CHECK(off.median < 1.02);
    CHECK(is_near(off.worst, 5, 0.05));
    // More of the second work goes with less time.
    const std::vector<timed_work> contrary{{"a", {10, 1}, {100}}, {"b", {10, 5}, {90}}, {"c", {10, 9}, {80}}};
    const std::vector<aabblab::estimate> none_below = aabblab::fit_costs(contrary);
    CHECK(none_below[1].value == 0);
    CHECK(is_near(none_below[0].value, 9, 0.1));
}

TEST_CASE("Every cost is measured, and checked in scenes that it was not fitted to") {
    const aabblab::calibration found = aabblab::calibrate(aabblab::calibration_size::quick, 0);
    for (const aabb::cost_info& cost : aabb::cost_infos) {
        INFO(cost.name);
        CHECK(found.costs.*cost.value > 0);
        CHECK(std::isfinite(found.costs.*cost.value));
    }
    CHECK(found.checks.size() == 6);
    for (const aabblab::group_check& one : found.checks) CHECK(one.found.observations > 0);
    CHECK(aabb::machine_costs() == aabb::cost_model{});
}

TEST_CASE("A file of costs reads back as it was written") {
    aabblab::calibrated_costs kept = aabblab::label_costs(odd_costs());
    kept.processor = "a \"processor\" \\ of old";
    const aabblab::calibrated_costs read = aabblab::parse_costs(text_of(kept), "costs.toml");
    CHECK(read.costs == kept.costs);
    CHECK(read.date == kept.date);
    CHECK(read.applies_to(kept));
    for (std::string aabblab::calibrated_costs::* const part :
         {&aabblab::calibrated_costs::version, &aabblab::calibrated_costs::processor,
          &aabblab::calibrated_costs::instructions}) {
        aabblab::calibrated_costs other = kept;
        other.*part += " 2";
        CHECK_FALSE(read.applies_to(other));
    }
}

TEST_CASE("What is wrong in a file of costs is said with its line") {
    const std::string good = text_here();
    CHECK(rejection_of(good) == "accepted");
    CHECK(rejection_of(replaced(good, "cut_test", "cut_tets")) ==
          "costs.toml:17: unknown key of [costs] 'cut_tets'; did you mean 'cut_test'?");
    CHECK(rejection_of(replaced(good, "\ncut_test", "\n# cut_test")) ==
          "costs.toml:8: [costs] has no cut_test; aabblab calibrate writes all");
    for (const char* value : {"-1", "0", "inf", "nan", "true"})
        CHECK(rejection_of(replaced(good, "search_box = ", "search_box = " + std::string(value) + " # ")) ==
              "costs.toml:9: search_box must be a number above 0, not " + std::string(value));
    CHECK(rejection_of(replaced(good, "search_box = ", "search_box = [] # ")) ==
          "costs.toml:9: search_box must be a number above 0");
    CHECK(rejection_of(replaced(good, "\nprocessor", "\nprocessors")) ==
          "costs.toml:1: there is no processor; aabblab calibrate writes it");
    CHECK(
        rejection_of(replaced(good, "\n[costs]", "\nmore=1\n[costs]")).starts_with("costs.toml:8: unknown key 'more'"));
    CHECK(rejection_of(good + "[").starts_with("costs.toml:"));
    // Of another version nothing but that is known.
    CHECK(rejection_of("version = \"0.0.1\"\nprocessor = \"p\"\ninstructions = \"i\"\n[costs]\na = 1\n") == "accepted");
}

TEST_CASE("The program plans by the costs that are kept, and says so") {
    const configured shipped;
    CHECK(shipped.run({"explain", "icosphere", "icosphere"})
              .out.starts_with("cost model: the shipped operation costs (aabblab calibrate measures yours)\n"));
    REQUIRE(shipped.run_experiment().status == 0);
    CHECK(shipped.costs_of_run()["source"] == "shipped");
    CHECK(shipped.costs_of_run()["ns"]["search_pair"] == aabb::cost_model{}.search_pair);

    const configured kept(text_here());
    const program_result explained = kept.run({"explain", "icosphere", "icosphere"});
    CHECK(explained.status == 0);
    CHECK(explained.err.empty());
    CHECK(explained.out.starts_with("cost model: operation costs calibrated 20"));
    CHECK(holds(explained.out, kept.file().string()));
    REQUIRE(kept.run_experiment().status == 0);
    const nlohmann::json costs = kept.costs_of_run();
    CHECK(costs["source"] == "calibrated");
    CHECK(costs["ns"].size() == aabb::cost_infos.size());
    for (const auto& cost : aabb::cost_infos) CHECK(costs["ns"][std::string(cost.name)] == odd_costs().*cost.value);
}

TEST_CASE("A run is not resumed with other costs") {
    const configured kept(text_here());
    REQUIRE(kept.run_experiment().status == 0);
    CHECK(kept.run_experiment({"--resume"}).status == 0);
    REQUIRE(kept.run({"calibrate", "--reset"}).status == 0);
    CHECK(holds(as_refused(kept.run_experiment({"--resume"})).err, "were made with other costs (aabblab calibrate)"));
}

TEST_CASE("Costs of another processor, instruction set or version are left alone, with a note") {
    for (const char* of : {"processor = \"", "instructions = \"", "version = \""}) {
        const configured other(replaced(text_here(), of, std::string(of) + "9"));
        const program_result explained = other.run({"explain", "icosphere", "icosphere"});
        INFO(explained.err);
        CHECK(explained.status == 0);
        CHECK(is_one_sentence(explained.err));
        CHECK(holds(explained.err,
                    "so the shipped costs are used until aabblab calibrate measures those of this machine"));
        CHECK(
            explained.out.starts_with("cost model: the shipped operation costs (aabblab calibrate measures yours)\n"));
    }
}

TEST_CASE("A malformed file of costs stops every command but calibrate, which removes it") {
    const configured wrong(replaced(text_here(), "cut_test", "cut_tets"));
    const program_result listed = as_refused(wrong.run({"list"}));
    CHECK(holds(listed.err, "costs.toml:17: unknown key of [costs] 'cut_tets'; did you mean 'cut_test'?"));
    CHECK(holds(listed.err, "; aabblab calibrate --reset removes it"));
    CHECK(wrong.run({"--version"}).status == 0);
    const program_result removed = wrong.run({"calibrate", "--reset"});
    CHECK(removed.status == 0);
    CHECK(removed.out == "removed " + wrong.file().string() + ": the shipped costs are used\n");
    CHECK_FALSE(std::filesystem::exists(wrong.file()));
    CHECK(wrong.run({"list"}).status == 0);
    CHECK(holds(wrong.run({"calibrate", "--reset"}).out, "does not exist: the shipped costs are used"));
}

TEST_CASE("calibrate keeps what it measured, as a table too") {
    const configured user;
    const program_result made = user.run({"calibrate", "--quick"});
    INFO(made.err);
    REQUIRE(made.status == 0);
    for (const char* part : {"cost ", "shipped", "95 %", "cut_subset ", "ns/visit", "Verlet lists", "worst",
                             "aabblab calibrate --reset removes it"})
        CHECK(holds(made.out, part));
    check_narrow(made.out.substr(0, made.out.find("wrote ")));
    const aabblab::calibrated_costs kept = aabblab::read_costs(user.file());
    CHECK(kept.processor == aabblab::this_machine().processor);
    CHECK(kept.costs != aabb::cost_model{});
    CHECK(holds(user.run({"explain", "icosphere", "icosphere"}).out, kept.date));
}

TEST_CASE("calibrate writes over no file but one of costs") {
    const temporary_folder folder;
    const std::string text = folder.write("notes.md", "# Notes\n");
    run_refused({"calibrate", "--quick", "--out", text});
    CHECK(bytes_of_file(text) == "# Notes\n");
}

TEST_CASE("calibrate says where costs cannot be kept, before it measures") {
    const configured user;
    user.folder.write("file", "");
    as_refused(user.run({"calibrate", "--quick", "--out", (user.folder / "file/costs.toml").string()}));
    CHECK(holds(run_command({"env", "-u", "HOME", "-u", "XDG_CONFIG_HOME", AABBLAB_UNDER_TEST, "calibrate"}).err,
                "give --out FILE for the costs"));
    CHECK(user.run({"calibrate", "--reset", "--quick"}).status == 2);
}
