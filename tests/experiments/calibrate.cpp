// Operation costs of a machine: fitted, saved, read and reported.

#include <nlohmann/json.hpp>

#include "program.hpp"

import aabblab.calibrate;
import aabblab.configs;
import aabblab.machine;
import aabblab.statistics;

namespace {

using aabblab::timed_work;

/// Observations whose times are these costs times the work, with some noise.
std::vector<timed_work> synthetic(const std::vector<double>& costs, double noise) {
    std::vector<timed_work> observations;
    std::uint64_t random = 1;
    const auto next = [&] {
        random = random * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(random >> 11U) / static_cast<double>(std::uint64_t{1} << 53U);
    };
    for (int scene = 0; scene < 12; ++scene)
        for (int piece = 0; piece < 2; ++piece) {
            timed_work observation{"scene " + std::to_string(scene), {}, {}};
            double ns = 0;
            for (const double cost : costs) {
                observation.work.push_back(std::pow(10.0, 2 + 3 * next()) / cost);  // no cost is negligible
                ns += cost * observation.work.back();
            }
            for (int repeat = 0; repeat < 5; ++repeat) observation.ns.push_back(ns * (1 + noise * (2 * next() - 1)));
            observations.push_back(observation);
        }
    return observations;
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

std::string costs_text() {
    return text_of(aabblab::label_costs(odd_costs()));
}

std::string rejection_of(const std::string& text) {
    return refusal_in<aabb::input_error>([&] { return aabblab::parse_costs(text, "costs.toml"); });
}

/// A user's config folder, optionally with a costs file.
struct user_config {
    temporary_folder folder;

    user_config() = default;
    explicit user_config(const std::string& costs) { folder.write("config/aabblab/costs.toml", costs); }
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

TEST_CASE("A fit recovers the costs behind synthetic times") {
    const std::vector<double> costs{8, 0.75, 250};
    const std::vector<aabblab::estimate> exact = aabblab::fit_costs(synthetic(costs, 0));
    REQUIRE(exact.size() == costs.size());
    for (std::size_t k = 0; k < costs.size(); ++k) CHECK(is_near(exact[k].value, costs[k], 1e-6));
    const std::vector<timed_work> noisy = synthetic(costs, 0.1);
    const std::vector<aabblab::estimate> fitted = aabblab::fit_costs(noisy);
    for (std::size_t k = 0; k < costs.size(); ++k) {
        CHECK(is_near(fitted[k].value, costs[k], 0.1));
        CHECK(fitted[k].error > 0);
        const auto [low, high] = fitted[k].range(0.0005);
        CHECK((low <= costs[k] && costs[k] <= high));
    }
    CHECK(aabblab::accuracy_of(noisy, exact).worst < 1.1);
}

TEST_CASE("A fit is robust to outliers and never negative") {
    const std::vector<double> costs{8, 0.75, 250};
    std::vector<timed_work> observed = synthetic(costs, 0.01);
    for (const std::size_t outlier : {3U, 10U})
        for (double& ns : observed[outlier].ns) ns *= 5;
    const std::vector<aabblab::estimate> fitted = aabblab::fit_costs(observed);
    for (std::size_t k = 0; k < costs.size(); ++k) CHECK(is_near(fitted[k].value, costs[k], 0.05));
    const aabblab::accuracy fit = aabblab::accuracy_of(observed, fitted);
    CHECK(fit.observations == 24);
    CHECK(fit.median < 1.02);
    CHECK(is_near(fit.worst, 5, 0.05));
    // Times fall as the second kind of work grows.
    const std::vector<timed_work> decreasing{{"a", {10, 1}, {100}}, {"b", {10, 5}, {90}}, {"c", {10, 9}, {80}}};
    const std::vector<aabblab::estimate> clamped = aabblab::fit_costs(decreasing);
    CHECK(clamped[1].value == 0);
    CHECK(is_near(clamped[0].value, 9, 0.1));
}

TEST_CASE("calibrate measures every cost and checks it on held-out scenes") {
    const aabblab::calibration measured = aabblab::calibrate(aabblab::calibration_size::quick, 0);
    for (const aabb::cost_info& cost : aabb::cost_infos) {
        INFO(cost.name);
        CHECK(measured.costs.*cost.value > 0);
        CHECK(std::isfinite(measured.costs.*cost.value));
    }
    CHECK(measured.checks.size() == 8);
    for (const aabblab::group_check& check : measured.checks) CHECK(check.held_out.observations > 0);
    CHECK(aabb::machine_costs() == aabb::cost_model{});
}

TEST_CASE("A costs file round-trips") {
    aabblab::calibrated_costs saved = aabblab::label_costs(odd_costs());
    saved.processor = "a \"processor\" \\ of old";
    const aabblab::calibrated_costs read = aabblab::parse_costs(text_of(saved), "costs.toml");
    CHECK(read.costs == saved.costs);
    CHECK(read.date == saved.date);
    CHECK(read.applies_to(saved));
    for (std::string aabblab::calibrated_costs::* const field :
         {&aabblab::calibrated_costs::version, &aabblab::calibrated_costs::processor,
          &aabblab::calibrated_costs::instructions}) {
        aabblab::calibrated_costs other = saved;
        other.*field += " 2";
        CHECK_FALSE(read.applies_to(other));
    }
}

TEST_CASE("Errors in a costs file are reported with their line") {
    const std::string valid = costs_text();
    CHECK(rejection_of(valid) == "accepted");
    CHECK(rejection_of(replaced(valid, "cut_test", "cut_tets")) ==
          "costs.toml:17: unknown key of [costs] 'cut_tets'; did you mean 'cut_test'?");
    CHECK(rejection_of(replaced(valid, "\ncut_test", "\n# cut_test")) ==
          "costs.toml:8: [costs] has no cut_test; aabblab calibrate writes all");
    for (const char* value : {"-1", "0", "inf", "nan", "true"})
        CHECK(rejection_of(replaced(valid, "search_box = ", "search_box = " + std::string(value) + " # ")) ==
              "costs.toml:9: search_box must be a number above 0, not " + std::string(value));
    CHECK(rejection_of(replaced(valid, "search_box = ", "search_box = [] # ")) ==
          "costs.toml:9: search_box must be a number above 0");
    CHECK(rejection_of(replaced(valid, "\nprocessor", "\nprocessors")) ==
          "costs.toml:1: there is no processor; aabblab calibrate writes it");
    CHECK(rejection_of(replaced(valid, "\n[costs]", "\nmore=1\n[costs]"))
              .starts_with("costs.toml:8: unknown key 'more'"));
    CHECK(rejection_of(valid + "[").starts_with("costs.toml:"));
    // Costs of another version are not checked further.
    CHECK(rejection_of("version = \"0.0.1\"\nprocessor = \"p\"\ninstructions = \"i\"\n[costs]\na = 1\n") == "accepted");
}

TEST_CASE("The program plans with the saved costs and reports it") {
    const user_config shipped;
    CHECK(shipped.run({"explain", "icosphere", "icosphere"})
              .out.starts_with("costs of elementary operations: as shipped (aabblab calibrate measures yours)\n"));
    REQUIRE(shipped.run_experiment().status == 0);
    CHECK(shipped.costs_of_run()["source"] == "shipped");
    CHECK(shipped.costs_of_run()["ns"]["search_pair"] == aabb::cost_model{}.search_pair);

    const user_config saved(costs_text());
    const program_result explained = saved.run({"explain", "icosphere", "icosphere"});
    CHECK(explained.status == 0);
    CHECK(explained.err.empty());
    CHECK(explained.out.starts_with("costs of elementary operations: calibrated 20"));
    CHECK(holds(explained.out, saved.file().string()));
    REQUIRE(saved.run_experiment().status == 0);
    const nlohmann::json costs = saved.costs_of_run();
    CHECK(costs["source"] == "calibrated");
    CHECK(costs["ns"].size() == aabb::cost_infos.size());
    for (const auto& cost : aabb::cost_infos) CHECK(costs["ns"][std::string(cost.name)] == odd_costs().*cost.value);
}

TEST_CASE("A run is not resumed with other costs") {
    const user_config saved(costs_text());
    REQUIRE(saved.run_experiment().status == 0);
    CHECK(saved.run_experiment({"--resume"}).status == 0);
    REQUIRE(saved.run({"calibrate", "--reset"}).status == 0);
    CHECK(holds(as_refused(saved.run_experiment({"--resume"})).err, "were made with other costs (aabblab calibrate)"));
}

TEST_CASE("Costs of another processor, instruction set or version are ignored with a note") {
    for (const char* field : {"processor = \"", "instructions = \"", "version = \""}) {
        const user_config other(replaced(costs_text(), field, std::string(field) + "9"));
        const program_result explained = other.run({"explain", "icosphere", "icosphere"});
        INFO(explained.err);
        CHECK(explained.status == 0);
        CHECK(is_one_sentence(explained.err));
        CHECK(holds(explained.err,
                    "so the shipped costs are used until aabblab calibrate measures those of this machine"));
        CHECK(explained.out.starts_with(
            "costs of elementary operations: as shipped (aabblab calibrate measures yours)\n"));
    }
}

TEST_CASE("A malformed costs file stops every command but calibrate, which removes it") {
    const user_config wrong(replaced(costs_text(), "cut_test", "cut_tets"));
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

TEST_CASE("calibrate saves its measurements and prints them as a table") {
    const user_config user;
    const program_result calibrated = user.run({"calibrate", "--quick"});
    INFO(calibrated.err);
    REQUIRE(calibrated.status == 0);
    for (const char* part : {"cost ", "shipped", "95 %", "cut_subset ", "ns/visit", "Verlet lists",
                             "indices of a filter", "worst", "aabblab calibrate --reset removes it"})
        CHECK(holds(calibrated.out, part));
    check_narrow(calibrated.out.substr(0, calibrated.out.find("wrote ")));
    const aabblab::calibrated_costs saved = aabblab::read_costs(user.file());
    CHECK(saved.processor == aabblab::this_machine().processor);
    CHECK(saved.costs != aabb::cost_model{});
    CHECK(holds(user.run({"explain", "icosphere", "icosphere"}).out, saved.date));
}

TEST_CASE_METHOD(in_folder, "calibrate overwrites only costs files") {
    const std::string text = folder.write("notes.md", "# Notes\n");
    run_refused({"calibrate", "--quick", "--out", text});
    CHECK(bytes_of_file(text) == "# Notes\n");
}

TEST_CASE("calibrate rejects an unwritable destination before it measures") {
    const user_config user;
    user.folder.write("file", "");
    as_refused(user.run({"calibrate", "--quick", "--out", (user.folder / "file/costs.toml").string()}));
    CHECK(holds(run_command({"env", "-u", "HOME", "-u", "XDG_CONFIG_HOME", AABBLAB_UNDER_TEST, "calibrate"}).err,
                "give --out FILE for the costs"));
    CHECK(user.run({"calibrate", "--reset", "--quick"}).status == 2);
}
