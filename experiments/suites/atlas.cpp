module aabblab.suites;

import aabblab.fmt;
import aabblab.output;

namespace aabblab {

namespace {

/// An experiment of the map, or of scenes outside of it.
struct part {
    std::string_view name;
    bool is_held_out;  ///< outside the map
};
constexpr std::array<part, 3> parts_of_map{{{"atlas", false}, {"atlas_large", false}, {"atlas_unseen", true}}};

/// The experiments that a kind of border is read from: its law is fitted to the first, and tested on the unseen second.
std::array<std::string, 2> parts_of(const border_kind& kind) {
    return {kind.name, kind.name + "_unseen"};
}

/// The names of all experiments of the atlas, in the order in which they run.
std::vector<std::string> names_of_parts() {
    std::vector<std::string> names;
    for (const part& p : parts_of_map) names.emplace_back(p.name);
    for (const border_kind& kind : border_kinds()) std::ranges::copy(parts_of(kind), std::back_inserter(names));
    return names;
}

}  // namespace

std::vector<std::string> measure_part_of_atlas(const experiment& e, const std::filesystem::path& folder) {
    remove_measures(folder);
    std::vector<std::string> failures =
        run_experiment(e, folder, existing_results::replace, "the same command", printed::nothing);
    write_measures(folder, e.scenes);
    return failures;
}

/// Runs the experiments of the atlas. All configs are read first, so that an invalid one is reported early.
/// @param quick applies the settings of the configs for a short trial run
/// @returns a sentence for each candidate with wrong results
std::vector<std::string> measure_atlas(const std::filesystem::path& folder, bool quick) {
    std::vector<experiment> experiments;
    for (const std::string& name : names_of_parts())
        experiments.push_back(open_experiment(fmt::format("{}/{}.toml", AABBLAB_ATLAS_CONFIGS, name), quick));
    std::vector<std::string> failures;
    for (const experiment& e : experiments) {
        note(fmt::format("part {} of {} of the atlas: {}, {} scenes", &e - experiments.data() + 1, experiments.size(),
                         e.name, e.scenes.size()));
        std::ranges::move(measure_part_of_atlas(e, folder / e.name), std::back_inserter(failures));
    }
    return failures;
}

void write_times_of_atlas(const std::filesystem::path& out, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> parts;
    for (const std::string& name : names_of_parts())
        if (std::filesystem::exists(folder / name / "results.csv")) parts.push_back(folder / name);
    write_times(out / "times.csv", parts);
}

/// A sentence for each experiment of the atlas whose results are missing or incomplete.
std::vector<std::string> unfinished_parts(const std::filesystem::path& folder) {
    std::vector<std::string> sentences;
    for (const std::string& name : names_of_parts()) {
        if (!std::filesystem::exists(folder / name / "manifest.json"))
            sentences.push_back(fmt::format("{} has not been run yet", name));
        else if (!read_manifest(folder / name).finished)
            sentences.push_back(fmt::format("{} is not finished, so some of its scenes are missing", name));
    }
    return sentences;
}

std::vector<atlas_scene> measured_atlas(const std::filesystem::path& folder) {
    std::vector<atlas_scene> atlas;
    for (const part& p : parts_of_map)
        if (std::filesystem::exists(folder / p.name / "results.csv"))
            std::ranges::move(read_atlas(folder / p.name, p.is_held_out), std::back_inserter(atlas));
    return atlas;
}

std::vector<border_law> measured_laws(const std::filesystem::path& folder) {
    std::vector<border_law> laws;
    for (const border_kind& kind : border_kinds()) {
        std::vector<atlas_scene> scenes;
        for (const std::string& name : parts_of(kind))
            if (std::filesystem::exists(folder / name / "results.csv"))
                std::ranges::move(read_atlas(folder / name, /*is_held_out=*/name != kind.name),
                                  std::back_inserter(scenes));
        if (std::optional<border_law> law = law_of(kind, borders_of(kind, scenes))) laws.push_back(*std::move(law));
    }
    return laws;
}

}  // namespace aabblab
