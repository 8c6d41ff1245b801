module aabblab.suites;

import aabblab.fmt;
import aabblab.output;

namespace aabblab {

namespace {

/// An experiment of the atlas; they run in this order.
struct part {
    std::string_view name;
    bool is_held_out;  ///< left out when a model is fitted, to test it
};
constexpr std::array<part, 3> parts{{{"atlas", false}, {"atlas_large", false}, {"atlas_unseen", true}}};

}  // namespace

/// Runs the experiments of the atlas. All configs are read first, so that an invalid one is reported early.
/// @param quick applies the settings of the configs for a short trial run
/// @returns a sentence for each candidate with wrong results
std::vector<std::string> measure_atlas(const std::filesystem::path& folder, bool quick) {
    std::vector<experiment> experiments;
    for (const part& p : parts)
        experiments.push_back(open_experiment(fmt::format("{}/{}.toml", AABBLAB_ATLAS_CONFIGS, p.name), quick));
    std::vector<std::string> failures;
    for (const experiment& e : experiments) {
        note(fmt::format("part {} of {} of the atlas: {}, {} scenes", &e - experiments.data() + 1, experiments.size(),
                         e.name, e.scenes.size()));
        std::vector<std::string> wrong =
            run_experiment(e, folder / e.name, existing_results::replace, "the same command", printed::nothing);
        std::ranges::move(wrong, std::back_inserter(failures));
    }
    return failures;
}

/// A sentence for each experiment of the atlas whose results are missing or incomplete.
std::vector<std::string> unfinished_parts(const std::filesystem::path& folder) {
    std::vector<std::string> sentences;
    for (const part& p : parts) {
        if (!std::filesystem::exists(folder / p.name / "manifest.json"))
            sentences.push_back(fmt::format("{} has not been run yet", p.name));
        else if (!read_manifest(folder / p.name).finished)
            sentences.push_back(fmt::format("{} is not finished, so some of its scenes are missing", p.name));
    }
    return sentences;
}

std::vector<atlas_scene> measured_atlas(const std::filesystem::path& folder) {
    std::vector<atlas_scene> atlas;
    for (const part& p : parts)
        if (std::filesystem::exists(folder / p.name / "results.csv"))
            std::ranges::move(read_atlas(folder / p.name, p.is_held_out), std::back_inserter(atlas));
    return atlas;
}

}  // namespace aabblab
