module;
#include <fmt/format.h>

module aabblab.measuring;

import aabb.base;
import aabblab.archive;
import aabblab.claims;
import aabblab.conditions;
import aabblab.files;
import aabblab.output;
import aabblab.record;
import aabblab.results;
import aabblab.sha256;

namespace aabblab {

namespace {

std::filesystem::path folder_of(const reproduce_request& request) {
    if (request.out) return *request.out;
    if (!request.sources.empty()) return "results/reproduce-judged";
    return request.quick ? "results/reproduce-quick" : "results/reproduce";
}

void require_sense(const reproduce_request& request) {
    if (!request.sources.empty() && !request.judge)
        throw aabb::input_error(request.sources.front() + " is named, but only --judge takes results that are there");
    if (request.archive && request.sources.size() > 1)
        throw aabb::input_error("--archive takes the results of one run, and several are named");
}

/// The results of one run, read and verified.
/// @param name as the user knows it
measurements verified_measurements(const std::filesystem::path& folder, const std::string& name) {
    const std::vector<std::string> experiments = recorded_experiments(folder);
    if (experiments.empty()) throw aabb::input_error("there are no results of a reproduction in " + name);
    verify_record(folder);
    if (!is_sealed_record(folder)) note(name + ": " + unsealed_note);
    measurements results(folder, name);
    for (const std::string& experiment : experiments) (void)results.of(experiment);
    return results;
}

/// The verdicts as a terminal shows them.
std::string verdict_text(const reproduction& all) {
    std::string text;
    if (!all.disturbance.empty()) text += all.disturbance + "\n\n";
    for (const std::string& sentence : all.headline) text += sentence + "\n";
    text += "\n";
    for (const claim_result& c : all.claims)
        text += fmt::format("{:<4} {}\n     {}. {}\n", c.id, c.claim, text_of(c), c.sentence);
    return text;
}

/// Which size of the paper's experiments a run has.
bool is_quick(const std::filesystem::path& folder) {
    return read_manifest(folder / recorded_experiments(folder).front()).quick;
}

/// A run and its copy are no two machines that agree.
void require_different(std::span<const measurements> runs) {
    std::map<std::string, std::string> names;  // by what seals them
    for (const measurements& run : runs) {
        if (!is_sealed_record(run.folder())) continue;
        const auto [known, is_new] = names.emplace(seal_of_record(run.folder()), run.name());
        if (!is_new) throw aabb::input_error(known->second + " and " + run.name() + " are the same run");
    }
}

/// How verdicts compare with those of the published run of the same size; empty where it is not there, or damaged.
std::string agreement_with_published(std::span<const measurements> runs, const reproduction& all) {
    const std::string name = is_quick(runs.front().folder()) ? "quick_run.tar.xz" : "full_run.tar.xz";
    const std::filesystem::path archive = std::filesystem::path(AABBLAB_ARCHIVES) / name;
    if (!std::filesystem::exists(archive)) return {};
    const std::string published = "the published run, paper/archive/" + name;
    try {
        const std::string file = archive.string();
        const source_list sources({&file, 1});
        const results_source& source = sources.all().front();
        const measurements results = verified_measurements(source.folder, source.name);
        const auto is_published = [&](const measurements& run) {
            return is_sealed_record(run.folder()) && seal_of_record(run.folder()) == seal_of_record(source.folder);
        };
        if (std::ranges::all_of(runs, is_published)) return "These results are " + published + ".";
        return agreement_of(all.claims, judged(results).claims, published);
    } catch (const aabb::input_error& error) {
        note("verdicts are not compared with the published ones: " + std::string(error.what()));
        return {};
    }
}

/// Judges what was measured and writes the report.
/// @returns the exit status
int judge(const std::filesystem::path& out, std::span<const measurements> runs) {
    std::vector<std::string> failures;
    for (const measurements& run : runs) std::ranges::copy(kept_failures(run.folder()), std::back_inserter(failures));
    const measurements& first = runs.front();
    for (const measurements& run : runs)
        if (is_quick(run.folder()) != is_quick(first.folder()))
            throw aabb::input_error(first.name() + " and " + run.name() +
                                    " are of different sizes, quick and full, and cannot be judged together");
    require_different(runs);
    const reproduction all = judged(runs);
    const std::string agreement = agreement_with_published(runs, all);
    write_reproduction(out, runs, all, sections_of_reproduction(first.folder(), is_quick(first.folder())), failures,
                       agreement);
    print(verdict_text(all));
    if (!failures.empty())
        print(fmt::format("\n{} answers were wrong; compositions among them have no times:\n", failures.size()));
    for (const std::string& failure : failures) print("  " + failure + "\n");
    print("\nThe report is " + visible((out / "report.html").string()) + "\n");
    if (!agreement.empty()) print_paragraph(agreement);
    return failures.empty() ? 0 : 1;
}

/// Packs what a judgement reads, and says how large it is and what its checksum is.
void archive_reproduction(const std::filesystem::path& folder, const std::filesystem::path& file) {
    write_archive(file, record_top, folder, archived_files(folder));
    const std::string bytes = bytes_of_file(file);
    print(fmt::format("The archive is {} ({:.1f} MiB), SHA-256 {}\n", visible(file.string()),
                      static_cast<double>(bytes.size()) / (1 << 20), sha256_of(bytes)));
}

}  // namespace

int reproduce(const reproduce_request& request) {
    outlive_reader();
    require_sense(request);
    const std::filesystem::path out = folder_of(request);
    if (request.judge && request.sources.empty() && recorded_experiments(out).empty())
        throw aabb::input_error("there are no results of a reproduction in " + out.string());
    source_list sources(request.sources);
    const folder_lock alone(out);
    if (!request.judge) measure_reproduction(out, request.quick);
    if (request.sources.empty()) sources.add(out);
    return sources.with_names_of_user([&] {
        std::vector<measurements> runs;
        for (const results_source& source : sources.all())
            runs.push_back(verified_measurements(source.folder, source.name));
        const int status = judge(out, runs);
        if (request.archive) archive_reproduction(runs.front().folder(), *request.archive);
        return status;
    });
}

}  // namespace aabblab
