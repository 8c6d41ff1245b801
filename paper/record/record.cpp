module aabblab.record;

namespace aabblab {

namespace {

/// The names of what is in a folder, in order; none where there is no such folder.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    if (!std::filesystem::is_directory(folder)) return names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

class listing {
public:
    explicit listing(const std::filesystem::path& folder) : folder_(folder) {}

    /// Those that are there.
    void add(const std::filesystem::path& place, std::initializer_list<const char*> names) {
        for (const char* name : names)
            if (std::filesystem::is_regular_file(folder_ / place / name)) files_.push_back(place / name);
    }

    [[nodiscard]] std::vector<std::filesystem::path> sorted() {
        std::ranges::sort(files_);
        return files_;
    }

private:
    std::filesystem::path folder_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace

std::vector<std::string> recorded_experiments(const std::filesystem::path& folder) {
    std::vector<std::string> experiments;
    for (const std::string& name : names_in(folder))
        if (std::filesystem::is_regular_file(folder / name / "manifest.json") ||
            std::filesystem::is_regular_file(folder / name / "results.csv"))
            experiments.push_back(name);
    return experiments;
}

std::vector<std::filesystem::path> recorded_files(const std::filesystem::path& folder) {
    listing all(folder);
    for (const std::string& name : recorded_experiments(folder))
        all.add(name, {"manifest.json", "results.csv", "differences.csv"});
    for (const std::string& name : names_in(folder / "errors"))
        all.add(std::filesystem::path("errors") / name,
                {"config.toml", "errors.csv", "manifest.json", "results.csv", "differences.csv"});
    for (const std::string& name : names_in(folder / "c6"))
        if (name.ends_with(".json") || name == "made_by.txt") all.add("c6", {name.c_str()});
    for (const std::string& name : names_in(folder / "atlas"))
        all.add(std::filesystem::path("atlas") / name, {"manifest.json", "results.csv", "differences.csv"});
    for (const char* suite : {"extreme", "stiff"}) all.add(suite, {"report.json"});
    all.add("", {"failures.txt"});
    return all.sorted();
}

std::vector<std::filesystem::path> archived_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files = recorded_files(folder);
    if (is_sealed_record(folder)) files.insert(files.begin(), sums_name);
    return files;
}

}  // namespace aabblab
