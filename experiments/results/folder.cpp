module;
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

module aabblab.results;

import aabb.base;
import aabblab.files;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Prepares the file for appending: drops a truncated last row, and line endings of other programs.
void drop_torn_row(const std::filesystem::path& file) {
    const std::string text = text_of_file(file);
    const std::string complete = text.substr(0, read_csv(text, file.string()).bytes);
    if (complete != bytes_of_file(file)) write_file(file, complete);
}

void make_folder(const std::filesystem::path& folder) {
    if (folder.empty()) throw aabb::input_error("the folder of the results has no name");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error("the folder " + folder.string() + " cannot be created: " + error.message());
}

/// Renames results that cannot be resumed. They are not deleted, as they may have taken hours.
/// @returns why they cannot be resumed; empty if they can, or if there are none
std::string set_aside_outdated(const std::filesystem::path& folder, const experiment_record& e) {
    const std::filesystem::path manifest = folder / "manifest.json";
    if (!std::filesystem::exists(folder / "results.csv") || !std::filesystem::exists(manifest)) return {};
    std::string reason = rejection_to_resume(manifest, e);
    if (reason.empty()) return reason;
    // results.csv is last: as long as it exists, an interrupted renaming is repeated by the next run.
    for (const char* name : {"differences.csv", "results.csv"})
        if (std::filesystem::exists(folder / name))
            std::filesystem::rename(folder / name, folder / (std::string(name) + ".old"));
    return reason;
}

/// Rejects rows of scenes that the manifest, from which `known` was read, does not list.
void require_known_scenes(std::span<const row> rows, const scene_digests& known, const std::filesystem::path& table) {
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!known.contains(rows[i].scene))  // lines are counted from 1, and the first is the header
            throw aabb::input_error(table.string() + ":" + std::to_string(i + 2) + ": manifest.json has no scene " +
                                    rows[i].scene.kind + " with these parameters; was the row altered?");
}

}  // namespace

/// Locks the folder of results, so that no two runs write to it at once.
folder_lock::folder_lock(const std::filesystem::path& folder) {
    make_folder(folder);
    // Child processes inherit the lock (no O_CLOEXEC), so that it lasts until they have finished their work.
    descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY);
    // Retry, because children of a process that was killed may still be about to end.
    for (int attempt = 0; attempt < 20; ++attempt) {
        // Some file systems cannot lock folders; then run without a lock.
        if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
        usleep(50'000);
    }
    close(descriptor_);
    throw aabb::input_error("another aabblab is writing to " + folder.string() +
                            "; wait until it ends, or name another folder with --out");
}

folder_lock::~folder_lock() {
    if (descriptor_ >= 0) close(descriptor_);
}

/// Continues the results in the folder, whose rows are not measured again, or begins new ones.
/// @param existing whether existing results are rejected, resumed, or resumed if config, build and machine are the same
/// and otherwise replaced
results_folder::results_folder(std::filesystem::path folder, experiment_record e, existing_results existing)
    : folder_(std::move(folder)), experiment_(std::move(e)), date_(date_now()) {
    make_folder(folder_);
    const std::filesystem::path table = folder_ / "results.csv";
    if (existing == existing_results::replace) replaced_ = set_aside_outdated(folder_, experiment_);
    if (std::filesystem::exists(table)) {
        rows_ = read_rows(table);
        for (const row& r : rows_) keys_.insert(r.key());
        if (!rows_.empty() && existing == existing_results::reject)
            throw aabb::input_error(
                "results are already in " + folder_.string() +
                "; --resume continues them; --out DIR, or another name in the config, puts new ones elsewhere");
        drop_torn_row(table);  // a row that was only partly written
    }
    if (!rows_.empty()) {
        std::tie(date_, digests_) = resume_manifest(folder_ / "manifest.json", experiment_);
        require_known_scenes(rows_, digests_, table);
        if (std::filesystem::exists(folder_ / "differences.csv"))
            differences_ = read_differences(folder_ / "differences.csv");
    }
    write_manifest();
    if (!std::filesystem::exists(table) || std::filesystem::file_size(table) == 0)
        write_file(table, csv_header_of_rows());
    open_table();
}

results_folder::~results_folder() {
    if (file_) std::fclose(file_);
}

void results_folder::add(const row& finished) {
    if (std::fputs(csv_of(finished).c_str(), file_) < 0 || std::fflush(file_) != 0) fail_table();
    rows_.push_back(finished);
    keys_.insert(finished.key());
}

/// Deletes matching rows, of wrong or interrupted runs, in memory and in the file, which is rewritten.
void results_folder::drop(const std::function<bool(const row&)>& is_dropped) {
    if (std::erase_if(rows_, is_dropped) == 0) return;
    keys_.clear();
    std::string text = csv_header_of_rows();
    for (const row& r : rows_) {
        keys_.insert(r.key());
        text += csv_of(r);
    }
    write_file(folder_ / "results.csv", text);
    open_table();
}

void results_folder::set_digest(const scene_choice& scene, const std::string& digest) {
    digests_[scene] = digest;
    write_manifest();
}

void results_folder::set_differences(const scene_choice& scene, std::span<const candidate_name> names,
                                     std::span<const difference> differences) {
    std::erase_if(differences_,
                  [&](const difference& d) { return d.scene == scene && std::ranges::count(names, d.name) > 0; });
    differences_.insert(differences_.end(), differences.begin(), differences.end());
    write_file(folder_ / "differences.csv", csv_of(differences_));
}

/// Adds checksums of the tables to the manifest of a finished run, by which missing or altered rows are found later,
/// and the candidates in the order of the run, by which rows are sorted later.
void results_folder::seal() {
    results_seal checksums{seal_of(folder_ / "results.csv"), /*differences=*/std::nullopt, /*candidates=*/{}};
    if (const std::filesystem::path table = folder_ / "differences.csv"; std::filesystem::exists(table))
        checksums.differences = seal_of(table);
    for (const row& r : rows_)
        if (std::ranges::count(checksums.candidates, r.name) == 0) checksums.candidates.push_back(r.name);
    write_file(folder_ / "manifest.json", manifest_text(experiment_, date_, digests_, checksums));
}

void results_folder::open_table() {
    if (file_) std::fclose(file_);
    file_ = std::fopen((folder_ / "results.csv").c_str(), "ab");
    if (!file_) fail_table();
}

void results_folder::fail_table() const {
    throw aabb::input_error((folder_ / "results.csv").string() + " cannot be written: " + std::strerror(errno));
}

void results_folder::write_manifest() const {
    write_file(folder_ / "manifest.json", manifest_text(experiment_, date_, digests_, std::nullopt));
}

}  // namespace aabblab
