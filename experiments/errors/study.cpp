module aabblab.errors;

import aabb.registry;
import aabblab.files;
import aabblab.fmt;
import aabblab.trials;

namespace aabblab {

namespace {

constexpr const char* curves_name = "curves.csv";
constexpr const char* plots_name = "plots.csv";

constexpr auto columns_of_curve_point = [](auto& p, auto field) {
    field("curve", p.curve);
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) field(std::string(name_of(kind)), p.name[kind]);
    field("scenes", p.scenes);
};

constexpr auto columns_of_plot = [](auto& p, auto field) {
    field("x", p.x);
    field("y", p.y);
};

std::string title_of(const scene_choice& scene) {
    const std::string parameters = parameters_text(scene);
    return scene.kind + (parameters.empty() ? "" : " " + parameters);
}

/// The scenes, each over all its seeds, with their compositions, in the order of the rows.
std::map<scene_choice, std::set<candidate_name>> names_by_scene(std::span<const row> rows) {
    std::map<scene_choice, std::set<candidate_name>> names;
    for (const row& r : rows) names[without_seed(r.scene)].insert(r.name);
    return names;
}

}  // namespace

/// An empty kind matches any strategy: of a point if its config did not name the kind, of a row if it is of the narrow
/// phase, in a scene of boxes.
bool curve_point::matches(const candidate_name& row_name) const {
    return row_name.engine.empty() && std::ranges::all_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
               return name[kind].empty() || row_name[kind].empty() || name[kind] == row_name[kind];
           });
}

/// "exact list (neighbour_list:margin=0.1 + bucket + columns + simd)"
std::string curve_point::text() const {
    return curve + " (" + label_of(name.choices) + ")";
}

/// Every kind of every composition is in the record, those that the config leaves out too.
study_record record_of(const error_study& study, std::span<const row> rows) {
    const auto names = names_by_scene(rows);
    study_record record{study.name, {}, study.plots};
    for (const error_curve& curve : study.curves)
        for (const aabb::composition& c : curve.compositions) {
            curve_point& point = record.points.emplace_back(curve_point{curve.label, {}, 0});
            for (const aabb::strategy_kind kind : aabb::strategy_kinds) point.name[kind] = to_text(c[kind]);
            for (const auto& [scene, in_scene] : names)
                if (std::ranges::any_of(in_scene, [&](const auto& name) { return point.matches(name); }))
                    ++*point.scenes;
        }
    return record;
}

void write_record(const std::filesystem::path& folder, const study_record& record) {
    write_file(folder / curves_name, csv_of(std::span<const curve_point>(record.points), columns_of_curve_point));
    write_file(folder / plots_name, csv_of(std::span<const metric_plot>(record.plots), columns_of_plot));
}

void remove_record(const std::filesystem::path& folder) {
    for (const char* name : {curves_name, plots_name}) std::filesystem::remove(folder / name);
}

/// Results of earlier versions have their config instead. Only what it names is taken from it, so that rows with other
/// defaults than today's match.
study_record read_record(const std::filesystem::path& folder) {
    study_record record{folder.filename().string(), {}, {}};
    if (std::filesystem::exists(folder / curves_name)) {
        record.points = rows_of_file<curve_point>(folder / curves_name, columns_of_curve_point);
        record.plots = rows_of_file<metric_plot>(folder / plots_name, columns_of_plot);
        return record;
    }
    const study_curves written = read_curves(folder / "config.toml");
    record.plots = written.plots;
    for (const error_curve& curve : written.curves)
        for (const aabb::named_strategies& named : curve.named) {
            curve_point& point = record.points.emplace_back(curve_point{curve.label, {}, std::nullopt});
            for (const aabb::strategy_kind kind : aabb::strategy_kinds)
                if (named[kind]) point.name[kind] = to_text(*named[kind]);
        }
    return record;
}

/// Compares the points of the curves with the compositions of the rows in both directions.
void require_rows(const study_record& record, std::span<const row> rows, const std::filesystem::path& folder) {
    const auto fail = [&](const std::string& sentence) {
        throw aabb::input_error((folder / "results.csv").string() + " " + sentence);
    };
    const auto names = names_by_scene(rows);
    std::set<candidate_name> unmatched;
    for (const auto& [scene, in_scene] : names) unmatched.insert(in_scene.begin(), in_scene.end());
    for (const curve_point& point : record.points) {
        std::vector<std::string> without;  // scenes
        for (const auto& [scene, in_scene] : names) {
            std::size_t matching = 0;
            for (const candidate_name& name : in_scene)
                if (point.matches(name)) {
                    ++matching;
                    unmatched.erase(name);
                }
            if (matching == 0) without.push_back(title_of(scene));
            if (matching > 1)
                fail(fmt::format("has {} compositions in {} that may be the point {}", matching, title_of(scene),
                                 point.text()));
        }
        const std::uint64_t present = names.size() - without.size();
        if (point.scenes && present > *point.scenes)
            fail(fmt::format("has rows of {} in {} scenes; curves.csv says that there are {}", point.text(), present,
                             *point.scenes));
        if (point.scenes ? present < *point.scenes : present == 0)
            fail(fmt::format(
                "has no row for {}{}", point.text(),
                without.empty()
                    ? ""
                    : " in " + without.front() +
                          (without.size() > 1 ? fmt::format(" and {} more scenes", without.size() - 1) : "")));
    }
    if (!unmatched.empty()) fail("has rows of " + text_of(*unmatched.begin()) + ", which is on no curve of the study");
}

}  // namespace aabblab
