module aabblab.results;

import aabb.base;
import aabblab.files;
import aabblab.sha256;

namespace aabblab {

namespace {

/// Rejects a table whose number of rows or checksum is not that which the manifest stated when the run was finished.
void require_seal(const std::filesystem::path& table, const table_seal& stated) {
    const table_seal actual = std::filesystem::exists(table) ? seal_of(table) : table_seal{};
    if (actual.rows != stated.rows)
        throw aabb::input_error(table.string() + " has " + std::to_string(actual.rows) + " rows; when the run was " +
                                "finished it had " + std::to_string(stated.rows) + ", as manifest.json says");
    if (actual != stated)
        throw aabb::input_error(table.string() +
                                " was altered after the run: its rows do not have the checksum that manifest.json "
                                "states");
}

struct known_scene {
    std::size_t position;  ///< in the manifest, which lists scenes in the order of the run
    std::string digest;    ///< of the ground truth; may be empty
};
using known_scenes = std::map<scene_choice, known_scene>;

/// Rejects a row whose scene is not in the manifest, or that is exact and has another digest than the scene.
/// @param place for messages: "results.csv:17: "
void require_known(const known_scenes& known, const row& r, const std::string& place) {
    const auto entry = known.find(r.scene);
    if (entry == known.end())
        throw aabb::input_error(place + "manifest.json has no scene " + r.scene.kind + " with these parameters");
    if (const std::string& digest = entry->second.digest; r.status == "exact" && !digest.empty() && r.digest != digest)
        throw aabb::input_error(place + "the row is exact, but its digest is '" + r.digest +
                                "'; that of the scene is " + digest + ", as manifest.json says");
}

/// Restores the order of the run, since a file may have any: by scene, repeat and candidate.
/// @param candidates in the order of the run
void sort_as_run(std::vector<row>& rows, const known_scenes& scenes, const std::vector<candidate_name>& candidates) {
    std::map<candidate_name, std::size_t> positions;
    for (const candidate_name& name : candidates) positions.emplace(name, positions.size());
    // Position of the scene, repeat, position of the candidate, index of the row.
    std::vector<std::tuple<std::size_t, std::uint64_t, std::size_t, std::size_t>> order;
    for (std::size_t i = 0; i < rows.size(); ++i)
        order.emplace_back(scenes.at(rows[i].scene).position, rows[i].repeat, positions[rows[i].name], i);
    std::ranges::sort(order);
    std::vector<row> sorted;
    for (const auto& [scene, repeat, candidate, index] : order) sorted.push_back(std::move(rows[index]));
    rows = std::move(sorted);
}

}  // namespace

/// The checksum of a table's sorted lines, by which alterations are found later, whatever the order of the rows.
table_seal seal_of(const std::filesystem::path& table) {
    std::vector<std::string> lines;
    for (const csv_record& record : read_csv(text_of_file(table), table.string()).records)
        lines.push_back(csv_line(record.fields));
    std::ranges::sort(lines);
    std::string text;
    for (const std::string& line : lines) text += line;
    // The header is not a row.
    return {lines.empty() ? 0 : lines.size() - 1, sha256_of(text)};
}

/// Reads the rows of a folder of results, and rejects those that its manifest or its seal contradicts.
std::vector<row> verified_rows(const std::filesystem::path& folder) {
    const sealed_manifest manifest = read_sealed_manifest(folder / "manifest.json");
    const std::filesystem::path table = folder / "results.csv";
    known_scenes scenes;
    for (const auto& [scene, digest] : manifest.scenes) scenes.emplace(scene, known_scene{scenes.size(), digest});
    std::vector<row> rows = read_rows(table, [&](const row& r, std::size_t line) {
        const std::string place = table.string() + ":" + std::to_string(line) + ": ";
        if (r.experiment != manifest.experiment)
            throw aabb::input_error(place + "the row is of the experiment '" + r.experiment +
                                    "', and manifest.json of '" + manifest.experiment + "'");
        require_known(scenes, r, place);
    });
    if (!manifest.seal) return rows;
    require_seal(table, manifest.seal->results);
    if (manifest.seal->differences) require_seal(folder / "differences.csv", *manifest.seal->differences);
    sort_as_run(rows, scenes, manifest.seal->candidates);
    return rows;
}

}  // namespace aabblab
