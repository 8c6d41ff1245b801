module aabblab.results;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

void for_each_column_of_name(auto& name, auto field) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) field(std::string(name_of(kind)), name[kind]);
    field("engine", name.engine);
}

/// The part of a scene without columns of its own: all but kind and seed.
template <class Scene>
struct parameters_of {
    Scene& scene;
};

template <class Scene, class Field>
void for_each_column_of_scene(Scene& scene, Field field) {
    field("scene", scene.kind);
    field("scene_parameters", parameters_of<Scene>{scene});
    field("seed", scene.seed);
}

constexpr auto key_columns = [](auto& r, auto field) {
    field("experiment", r.experiment);
    for_each_column_of_scene(r.scene, field);
    field("objects", r.objects);
    field("frames", r.frames);
    for_each_column_of_name(r.name, field);
    field("repeat", r.repeat);
};

constexpr auto columns_of_row = [](auto& r, auto field) {
    key_columns(r, field);
    field("process", r.process);
    field("triangles", r.triangles);
    field("build_ms", r.build_ms);
    field("first_ms", r.first_ms);
    field("update_ms", r.update_ms);
    field("search_ms", r.search_ms);
    field("detect_ms", r.detect_ms);
    field("build_cpu_ms", r.build_cpu_ms);
    field("first_cpu_ms", r.first_cpu_ms);
    field("update_cpu_ms", r.update_cpu_ms);
    field("search_cpu_ms", r.search_cpu_ms);
    field("detect_cpu_ms", r.detect_cpu_ms);
    field("candidates", r.candidates);
    field("contacts", r.contacts);
    field("digest", r.digest);
    for (std::size_t i = 0; i < r.counts.size(); ++i) field(std::string(aabb::work_names[i]), r.counts[i]);
    for (std::size_t i = 0; i < r.bytes.size(); ++i) field("bytes_" + std::string(byte_columns[i]), r.bytes[i]);
    field("missing", r.false_negatives);
    field("invented", r.false_positives);
    field("box_inflation", r.box_inflation);
    field("status", r.status);
};

constexpr auto columns_of_difference = [](auto& d, auto field) {
    for_each_column_of_scene(d.scene, field);
    for_each_column_of_name(d.name, field);
    field("what", d.what);
    field("class", d.kind);
    field("count", d.count);
};

template <class Scene>
std::string field_text(const parameters_of<Scene>& parameters) {
    return parameters_json(parameters.scene);
}
bool parse_field(const parameters_of<scene_choice>& parameters, const std::string& text) {
    return set_parameters(parameters.scene, text);
}
std::string expected_of(const parameters_of<scene_choice>&) {
    return "a JSON object of settings";
}

/// Messages quote at most this many characters of a field.
constexpr std::size_t longest_quote = 60;

/// Columns that results of earlier versions lack.
constexpr std::array<std::string_view, 1> later_columns{"restarts"};

/// Says where a header differs from the expected one: "column 3 is 'x'; expected 'seed'".
std::string first_difference(const std::vector<std::string>& names, const std::vector<std::string>& expected) {
    const auto [name, wanted] = std::ranges::mismatch(names, expected);
    return "column " + std::to_string(name - names.begin() + 1) +
           (name == names.end() ? " is missing" : " is '" + name->substr(0, longest_quote) + "'") + "; expected " +
           (wanted == expected.end() ? "no more" : "'" + *wanted + "'");
}

}  // namespace

void require_header(const std::string& file, const csv_record& header, const std::vector<std::string>& expected) {
    if (csv_line(header.fields) != csv_line(expected))
        throw aabb::input_error(file + ":1: these are not the columns of this version; " +
                                first_difference(header.fields, expected));
}

std::string row::key() const {
    return csv_line(fields_of(*this, key_columns));
}

std::string csv_header_of_rows() {
    return csv_line(names_of<row>(columns_of_row));
}
std::string csv_of(const row& r) {
    return csv_line(fields_of(r, columns_of_row));
}
std::string csv_of(std::span<const difference> differences) {
    return csv_of(differences, columns_of_difference);
}

/// Reads a results.csv, and rejects rows whose status is unknown and measurements that occur twice.
/// @param on_row is called with each row and its line
std::vector<row> read_rows(const std::filesystem::path& file,
                           const std::function<void(const row&, std::size_t)>& on_row) {
    std::map<std::string, std::size_t> lines;  // by key: scene, candidate and repeat
    const auto checked = [&](const row& r, std::size_t line) {
        const std::string place = file.string() + ":" + std::to_string(line) + ": ";
        if (r.status != "exact" && r.status != "inexact")
            throw aabb::input_error(place + "the status is '" + r.status + "'; expected exact or inexact");
        if (const auto [first, is_new] = lines.emplace(r.key(), line); !is_new)
            throw aabb::input_error(place + "the measurement of line " + std::to_string(first->second) +
                                    " is repeated here, so two runs have written to one folder");
        if (on_row) on_row(r, line);
    };
    const csv_text table = read_csv(text_of_file(file), file.string());
    return rows_in<row>(table.records, file.string(), columns_of_row, later_columns, checked);
}
std::vector<difference> read_differences(const std::filesystem::path& file) {
    const csv_text table = read_csv(text_of_file(file), file.string());
    return rows_in<difference>(table.records, file.string(), columns_of_difference, later_columns,
                               [](const difference&, std::size_t) {});
}

}  // namespace aabblab
