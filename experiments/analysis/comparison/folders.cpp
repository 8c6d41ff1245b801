module aabblab.comparison;

import aabb.base;
import aabblab.fmt;

namespace aabblab {

namespace {

bool has_results(const std::filesystem::path& folder) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(folder / "results.csv", ignored);
}

/// The folder itself if it holds a results.csv, otherwise its sub-folders that do.
std::vector<std::filesystem::path> folders_in(const std::filesystem::path& folder) {
    if (has_results(folder)) return {folder};
    std::error_code error;
    std::vector<std::filesystem::path> paths;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
        if (has_results(entry->path())) paths.push_back(entry->path());
    if (error) throw aabb::input_error(folder.string() + " cannot be read: " + error.message());
    std::ranges::sort(paths);
    return paths;
}

std::string maker_of(const manifest_summary& m) {
    return fmt::format("commit {}, {}, {}", m.commit, m.compiler, m.cpu);
}

}  // namespace

run_results read_results(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder))
        throw aabb::input_error(folder.string() +
                                (std::filesystem::exists(folder) ? " is not a folder" : " does not exist") +
                                "; expected a folder of results");
    run_results run{folder, {}, {}};
    std::map<std::string, std::filesystem::path> folder_of;  // by experiment
    for (const std::filesystem::path& subfolder : folders_in(folder)) {
        std::vector<row> rows = verified_rows(subfolder);
        if (rows.empty()) continue;
        for (const row& r : rows)
            if (const auto& before = folder_of.emplace(r.experiment, subfolder).first->second; before != subfolder)
                throw aabb::input_error(
                    fmt::format("{} and {} both hold results of the experiment {}; compare one of them",
                                before.string(), subfolder.string(), r.experiment));
        run.manifests.push_back(read_manifest(subfolder));
        run.rows.insert(run.rows.end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
    }
    if (run.rows.empty())
        throw aabb::input_error("there are no results in " + folder.string() +
                                ": neither it nor a sub-folder has a results.csv with rows");
    return run;
}

std::string makers_of(const run_results& run) {
    std::vector<std::string> makers;
    for (const manifest_summary& m : run.manifests)
        if (std::ranges::find(makers, maker_of(m)) == makers.end()) makers.push_back(maker_of(m));
    return fmt::format("{}", fmt::join(makers, "; "));
}

void require_one_machine(const run_results& a, const run_results& b) {
    for (const manifest_summary& of_a : a.manifests)
        for (const manifest_summary& of_b : b.manifests)
            if (of_a.cpu != of_b.cpu)
                throw aabb::input_error(fmt::format(
                    "--times compares runs of one machine only: {} is from {}, {} from {}; without --times, ratios are "
                    "compared",
                    a.folder.string(), maker_of(of_a), b.folder.string(), maker_of(of_b)));
}

}  // namespace aabblab
