/// measures.csv: what an atlas uses of the measures of its scenes, kept beside their rows, so that a judgement needs no
/// scene and an independent program finds the inversions that place scenes in maps.
module aabblab.atlas;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

constexpr const char* file_of_measures = "measures.csv";

/// A row of measures.csv: what the atlas uses of the measures of a scene.
struct recorded_scene {
    std::string kind, parameters;  ///< as in results.csv
    std::optional<std::uint64_t> seed{};
    std::uint64_t objects = 0;
    double pairs_per_object = 0, clustering = 0;
    std::optional<double> size_ratio{}, at_rest{}, inversions{};  ///< the latter two of scenes in motion
};

/// A column of numbers with all digits, so that a figure from the file is that from the scene.
template <class Number>
struct exactly {
    Number& value;
};
std::string field_text(const exactly<const double>& number) {
    return aabb::shortest(number.value);
}
std::string field_text(const exactly<const std::optional<double>>& number) {
    return number.value ? aabb::shortest(*number.value) : "";
}
template <class Number>
bool parse_field(const exactly<Number>& number, const std::string& text) {
    return aabblab::parse_field(number.value, text);
}

constexpr auto columns_of_measures = [](auto& r, auto field) {
    field("scene", r.kind);
    field("scene_parameters", r.parameters);
    field("seed", r.seed);
    field("objects", r.objects);
    field("pairs_per_object", exactly(r.pairs_per_object));
    field("clustering", exactly(r.clustering));
    field("size_ratio", exactly(r.size_ratio));
    field("at_rest", exactly(r.at_rest));
    field("inversions", exactly(r.inversions));
};

std::string key_of(const std::string& kind, const std::string& parameters, std::optional<std::uint64_t> seed) {
    return csv_line(std::array{kind, parameters, aabblab::field_text(seed)});
}

}  // namespace

/// Measures the scenes and writes a row for each.
void write_measures(const std::filesystem::path& folder, std::span<const scene_choice> scenes) {
    std::vector<recorded_scene> rows;
    for (const scene_choice& scene : scenes) {
        const scene_measures m = measure_scene(scene);
        recorded_scene& r = rows.emplace_back(recorded_scene{scene.kind, parameters_json(scene), scene.seed});
        r.objects = m.objects;
        r.pairs_per_object = m.pairs_per_object;
        r.clustering = m.clustering;
        r.size_ratio = m.boxes.size_ratio;
        if (m.motion) {
            r.at_rest = m.motion->at_rest;
            r.inversions = m.motion->inversions;
        }
    }
    write_file(folder / file_of_measures, csv_of(std::span<const recorded_scene>(rows), columns_of_measures));
}

void remove_measures(const std::filesystem::path& folder) {
    std::filesystem::remove(folder / file_of_measures);
}

std::optional<recorded_measures> read_measures(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / file_of_measures;
    if (!std::filesystem::exists(file)) return std::nullopt;
    recorded_measures measures{file, {}};
    for (const recorded_scene& r : rows_of_file<recorded_scene>(file, columns_of_measures)) {
        scene_measures m;
        m.objects = r.objects;
        m.pairs_per_object = r.pairs_per_object;
        m.clustering = r.clustering;
        m.boxes.size_ratio = r.size_ratio;
        if (r.inversions) m.motion = motion_measures{.at_rest = r.at_rest.value_or(0), .inversions = *r.inversions};
        measures.by_scene.emplace(key_of(r.kind, r.parameters, r.seed), m);
    }
    return measures;
}

const scene_measures& recorded_measures::of(const scene_choice& scene) const {
    const auto entry = by_scene.find(key_of(scene.kind, parameters_json(scene), scene.seed));
    if (entry == by_scene.end())
        throw aabb::input_error(file.string() + " has no row for " + scene.kind + " " + settings_text(scene));
    return entry->second;
}

}  // namespace aabblab
