module aabblab.record;

import aabb.base;
import aabblab.files;
import aabblab.fmt;
import aabblab.sha256;

namespace aabblab {

namespace {

/// The sorted names of a folder's entries; none if the folder does not exist.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    if (!std::filesystem::is_directory(folder)) return names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

/// The files of a reproduction's folder that are sealed and archived; relative to the folder, sorted.
std::vector<std::filesystem::path> recorded_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    const auto add = [&](const std::filesystem::path& subfolder, std::initializer_list<const char*> names) {
        for (const char* name : names)
            if (std::filesystem::is_regular_file(folder / subfolder / name)) files.push_back(subfolder / name);
    };
    for (const std::string& name : recorded_experiments(folder))
        add(name, {"manifest.json", "results.csv", "differences.csv"});
    for (const std::string& name : names_in(folder / "errors"))
        add("errors/" + name, {"config.toml", "curves.csv", "plots.csv", "errors.csv", "manifest.json", "results.csv",
                               "differences.csv"});
    for (const std::string& name : names_in(folder / "c6"))
        if (name.ends_with(".json") || name == "made_by.txt") add("c6", {name.c_str()});
    for (const std::string& name : names_in(folder / "atlas"))
        add("atlas/" + name, {"manifest.json", "measures.csv", "results.csv", "differences.csv"});
    for (const std::string suite : {"extreme", "stiff"}) {
        // Earlier versions sealed their report instead of rows.
        const bool has_report = std::filesystem::exists(folder / suite / "report.json");
        for (const std::string& name : names_in(folder / suite))
            if (has_report ? name == "report.json" : name.ends_with(".csv")) add(suite, {name.c_str()});
    }
    add("", {"failures.txt", stated_name});
    std::ranges::sort(files);
    return files;
}

using checksums_by_file = std::map<std::string, std::string>;

/// The checksum of a file with normalised line endings, which copying may have changed.
std::string checksum_of(const std::filesystem::path& file) {
    const std::string bytes = bytes_of_file(file);
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        if (bytes[i] != '\r' || i + 1 == bytes.size() || bytes[i + 1] != '\n') text += bytes[i];
    return sha256_of(text);
}

/// The checksums of all files that a judgement reads, except tables of results, whose checksums are in manifests.
checksums_by_file checksums_in(const std::filesystem::path& folder) {
    checksums_by_file checksums;
    for (const std::filesystem::path& file : recorded_files(folder))
        if (const std::string name = file.filename().string(); name != "results.csv" && name != "differences.csv")
            checksums.emplace(file.generic_string(), checksum_of(folder / file));
    return checksums;
}

/// Reads SHA256SUMS: each line has the 64 hexadecimal digits of a checksum, two blanks and a file.
/// @throws aabb::input_error with file and line if a line differs
checksums_by_file stated_checksums(const std::filesystem::path& file) {
    checksums_by_file checksums;
    std::istringstream in(text_of_file(file));
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        while (line.ends_with('\r')) line.pop_back();
        constexpr std::size_t digits = 64, name = digits + 2;
        if (line.size() <= name || line.substr(digits, 2) != "  ")
            throw aabb::input_error(
                fmt::format("{}:{}: expected a checksum of 64 digits, two blanks and a file", file.string(), number));
        checksums[line.substr(name)] = line.substr(0, digits);
    }
    return checksums;
}

}  // namespace

/// The names of the experiments with results, finished or not, in the folder of a reproduction.
std::vector<std::string> recorded_experiments(const std::filesystem::path& folder) {
    std::vector<std::string> experiments;
    for (const std::string& name : names_in(folder))
        if (std::filesystem::is_regular_file(folder / name / "manifest.json") ||
            std::filesystem::is_regular_file(folder / name / "results.csv"))
            experiments.push_back(name);
    return experiments;
}

std::vector<std::string> recorded_studies(const std::filesystem::path& folder) {
    return names_in(folder / "errors");
}

std::vector<std::filesystem::path> archived_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files = recorded_files(folder);
    if (is_sealed_record(folder)) files.insert(files.begin(), sums_name);
    return files;
}

/// Collects the sources of results to judge: folders are taken as they are, archives are unpacked to temporary folders.
results_sources::results_sources(std::span<const std::string> names) {
    for (const std::string& name : names) {
        if (!std::filesystem::exists(name)) throw aabb::input_error(name + " does not exist");
        sources_.push_back({name, std::filesystem::is_directory(name)
                                      ? std::filesystem::path(name)
                                      : unpacked_.emplace_back(name, archive_folder).folder()});
    }
}

void results_sources::add(const std::filesystem::path& folder) {
    sources_.push_back({folder.string(), folder});
}

/// Runs the work. Error messages get the name of an archive in place of the temporary folder's.
int results_sources::run_with_source_names(const std::function<int()>& work) const {
    try {
        return work();
    } catch (const aabb::input_error& error) {
        std::string sentence = error.what();
        for (const results_source& source : sources_)
            if (const std::size_t position = sentence.find(source.folder.string()); position != std::string::npos)
                sentence.replace(position, source.folder.string().size(), source.name);
        throw aabb::input_error(sentence);
    }
}

void seal_record(const std::filesystem::path& folder) {
    std::string text;
    for (const auto& [file, checksum] : checksums_in(folder)) text += checksum + "  " + file + "\n";
    write_file(folder / sums_name, text);
}

std::string seal_of_record(const std::filesystem::path& folder) {
    return checksum_of(folder / sums_name);
}

/// Compares files with SHA256SUMS in both directions, so that added files are found as well as missing or altered ones.
void verify_record(const std::filesystem::path& folder) {
    if (!is_sealed_record(folder)) return;
    const checksums_by_file actual = checksums_in(folder);
    const checksums_by_file stated = stated_checksums(folder / sums_name);
    for (const auto& [file, checksum] : stated) {
        const auto entry = actual.find(file);
        if (entry == actual.end())
            throw aabb::input_error((folder / file).string() + " is missing, but SHA256SUMS names it");
        if (entry->second != checksum)
            throw aabb::input_error((folder / file).string() +
                                    " was altered after the run: it does not have the checksum that SHA256SUMS states");
    }
    for (const auto& [file, checksum] : actual)
        if (!stated.contains(file))
            throw aabb::input_error((folder / file).string() + " was added after the run: SHA256SUMS does not name it");
    // The tables of results are not in SHA256SUMS, but each has a manifest that is.
    for (const auto& [file, checksum] : stated)
        if (const std::filesystem::path manifest(file); manifest.filename() == "manifest.json")
            if (const auto table = folder / manifest.parent_path() / "results.csv"; !std::filesystem::exists(table))
                throw aabb::input_error(table.string() + " is missing, but its manifest.json exists");
}

}  // namespace aabblab
