module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

selection grid(const std::string& cell) {
    return traditional.with(kind::partition, "uniform_grid:cell_size=" + cell);
}

/// The cell sizes of the config. Not those of the rows, which lack a size that was wrong everywhere.
const std::vector<std::string> cell_sizes{"4", "8", "16", "32", "64"};

/// The cell size that was the fastest in each scene of 10,000 boxes in an archive of earlier seeds. New seeds decide,
/// so that a size is not the fastest because it was chosen for it.
const std::map<std::string, std::string> fastest_before{
    {"brownian", "8"}, {"clustered", "32"}, {"one_huge", "8"}, {"mixed_sizes", "64"}};

/// The scene, for each cell size, in which the same archive had it slowest, compared with the fastest one.
const std::pair<std::string, std::string> slowest_before[] = {
    {"4", "mixed_sizes"}, {"8", "mixed_sizes"}, {"16", "mixed_sizes"}, {"32", "one_huge"}, {"64", "one_huge"}};

/// The name of a scene in sentences.
std::string scene_text(const std::string& scene) {
    return scene == "brownian"    ? "drifting cubes"
           : scene == "clustered" ? "cubes in clusters"
           : scene == "one_huge"  ? "boxes, one of them huge"
                                  : "boxes of mixed sizes";
}

/// Whether the grid has more than one cell.
bool is_grid(const condition& c, const std::string& size) {
    return median_of(c, grid(size), measured("subsets")).value_or(2) > 1;
}

/// Times of grids of all cell sizes over that of the axial cut, in scenes with the same number of objects. They give
/// the ratio that decided claim C5b in earlier archives.
class scenes_and_cells {
public:
    /// Reads, per scene and cell size, the times with a grid over those with the axial cut, except for a single cell.
    explicit scenes_and_cells(const std::vector<const condition*>& scenes) {
        for (const std::string& size : cell_sizes)
            if (std::ranges::all_of(scenes, [&](const condition* c) { return is_grid(*c, size); }))
                sizes_in_all_scenes_.push_back(size);
        for (const condition* c : scenes) {
            std::map<std::string, cells>& scene = ratios_to_cut_.emplace_back();
            for (const std::string& size : cell_sizes)
                if (is_grid(*c, size)) scene.emplace(size, c->log_ratios(grid(size), cut, measured("frame_cpu_ms")));
        }
    }

    /// The sizes that give a grid in all scenes. The best single size is one of these.
    [[nodiscard]] const std::vector<std::string>& sizes() const { return sizes_in_all_scenes_; }

    /// The regret in a scene is log(time over the best cell size's). Ratios are to the cut, so its own logarithm is 0.
    [[nodiscard]] double worst_regret_of_cut(const resample& d) const {
        return worst([&](const auto& scene) { return -best(scene, d); });
    }
    /// The worst regret of the best single cell size.
    [[nodiscard]] double least_worst_regret(const resample& d) const {
        return least_of(sizes_in_all_scenes_, [&](const std::string& size) {
            return worst([&](const auto& scene) { return d.mean_of(scene.at(size)) - best(scene, d); });
        });
    }

private:
    /// The least value of the elements; NaN if any is NaN, since an element that was not measured might be the least.
    template <class Range, class Value>
    [[nodiscard]] static double least_of(const Range& range, Value value) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& element : range) {
            const double current = value(element);
            if (std::isnan(current)) return current;
            least = std::min(least, current);
        }
        return least;
    }
    /// The best of the cell sizes that give a grid in the scene.
    [[nodiscard]] static double best(const std::map<std::string, cells>& scene, const resample& d) {
        return least_of(scene, [&](const auto& ratios) { return d.mean_of(ratios.second); });
    }
    template <class Regret>
    [[nodiscard]] double worst(Regret regret) const {
        return -least_of(ratios_to_cut_, [&](const auto& scene) { return -regret(scene); });
    }

    std::vector<std::string> sizes_in_all_scenes_;
    std::vector<std::map<std::string, cells>> ratios_to_cut_;  // logarithms, by scene, then cell size
};

/// One row per scene: the median times of the axial cut and of grids of every cell size, also an automatic one.
table times_table(const std::vector<condition>& conditions) {
    table t = factors_table(factors_of(conditions));
    t.columns.push_back({"axial_cut"});
    for (const std::string& size : cell_sizes) t.columns.push_back({"cells of " + size});
    t.columns.push_back({"grid, auto"});
    for (std::size_t i = 0; i < conditions.size(); ++i) {
        const auto add = [&](const selection& tested) {
            t.rows[i].push_back(digits_cell(median_of(conditions[i], tested, measured("frame_cpu_ms"))));
        };
        add(cut);
        for (const std::string& size : cell_sizes) add(grid(size));
        add(grid("auto"));
    }
    return t;
}

/// Times of grids over that of the axial cut against the cell size: one panel per number of objects.
figure cell_figure(const std::map<double, std::vector<const condition*>>& by_objects) {
    figure f = log_log(
        "c5",
        "Time of the broad phase with a grid over that with the axial cut in the same repeat (the line at 1), against "
        "the cell size, for each scene; 95 % intervals. Grids with a single cell are left out.",
        "cell size (edges of the smallest box)", "time over that of axial cut");
    for (const auto& [objects, conditions] : by_objects) {
        figure_panel& panel = f.panels.emplace_back();
        panel.title = grouped(static_cast<std::uint64_t>(objects)) + " objects";
        for (const condition* c : conditions) {
            series s{value_of(c->scene(), "scene")};
            for (const std::string& size : cell_sizes) {
                const endpoint ratio = endpoint_of(*c, grid(size), cut, "frame_cpu_ms");
                if (!ratio.is_known() || !is_grid(*c, size)) continue;
                s.points.push_back(point_of(std::stod(size), ratio));
            }
            panel.lines.push_back(s);
        }
    }
    f.lines.push_back(level_of("axial cut"));
    return f;
}

/// Groups conditions by the number of objects.
std::map<double, std::vector<const condition*>> by_objects(const std::vector<condition>& conditions) {
    std::map<double, std::vector<const condition*>> groups;
    for (const condition& c : conditions) groups[objects_of(c)].push_back(&c);
    return groups;
}

/// The number of scenes in which a grid of some fixed cell size takes less time than the cut by more than the band, and
/// which size is the fastest most often.
std::string grids_faster_text(const std::vector<condition>& conditions) {
    std::size_t scenes = 0, faster = 0;
    double least = 1, greatest = 0;
    std::map<std::string, std::size_t> wins;
    for (const condition& c : conditions) {
        std::optional<std::pair<double, std::string>> best;
        for (const std::string& size : cell_sizes) {
            const endpoint ratio = endpoint_of(c, grid(size), cut, "frame_cpu_ms");
            if (!ratio.is_known() || !is_grid(c, size)) continue;
            const std::pair current(std::exp(ratio.log_ratio().value), size);
            best = best ? std::min(*best, current) : current;
        }
        if (!best) continue;
        ++scenes;
        ++wins[best->second];
        if (best->first >= 1 / (1 + equivalence_band)) continue;
        ++faster;
        least = std::min(least, best->first);
        greatest = std::max(greatest, best->first);
    }
    if (faster == 0) return "";
    const auto most = std::ranges::max_element(wins, {}, &std::pair<const std::string, std::size_t>::second);
    return fmt::format(
        "In {} of {} scenes a grid of some fixed cell size takes less time than the cut, {:.2f} to {:.2f} of it; of "
        "all "
        "sizes, cells of {} are the fastest in {}.",
        faster, scenes, least, greatest, most->first, most->second);
}

/// "1,000, 2,000 and 4,000"
std::string listed(const std::set<std::uint64_t>& numbers) {
    std::string text;
    for (const std::uint64_t n : numbers)
        text += (text.empty() ? "" : n == *numbers.rbegin() ? " and " : ", ") + grouped(n);
    return text;
}

/// A sentence for each compared cell size that holds a whole scene, as one cell: it is no grid there.
std::string single_cells_text(const std::vector<condition>& conditions) {
    std::string text;
    for (const auto& [size, scene] : slowest_before) {
        std::set<std::uint64_t> objects;
        for (const condition* c : matching(conditions, {{"scene", scene}}))
            if (!is_grid(*c, size)) objects.insert(static_cast<std::uint64_t>(objects_of(*c)));
        if (!objects.empty())
            text += fmt::format("{}On {}, with {} objects, cells of {} edges are a single one, which is no grid.",
                                text.empty() ? "" : " ", scene_text(scene), listed(objects), size);
    }
    return text;
}

}  // namespace

/// Drafts C5a: for each cell size, the time with a better one over that with it, in a scene where it was slow in an
/// earlier archive. The same pairs of sizes are compared with other numbers of objects, where they may differ less.
draft c5a_claim(const measurements& m) {
    draft c5a{.claim = {.lead = "A grid", .experiments = {"c5"}}};
    const std::vector<condition>& conditions = m.conditions_of("c5");
    for (const auto& [size, scene] : slowest_before) {
        const std::string& better = fastest_before.at(scene);
        for (const condition* c : matching(conditions, {{"scene", scene}}))
            c5a.add(endpoint_of(*c, grid(better), grid(size), "frame_cpu_ms",
                                {{"cell_size", better}, {"over_cell_size", size}}),
                    "with cells of " + better + " edges, compared with " + size + " edges, on " + scene_text(scene),
                    "objects");
    }
    c5a.claim.tables.push_back(
        {"c5_cells", "Time per frame (ms, medians) with every cell size.", times_table(conditions)});
    c5a.claim.figures = {cell_figure(by_objects(conditions))};
    c5a.claim.remark = single_cells_text(conditions);
    return c5a;
}

/// Drafts C5b: the time of the cut over that of a grid, with the cell size that was the fastest in the scene in an
/// earlier archive, and with automatic cells. Also the worst slowdown of the cut over that of the best single cell
/// size, where a slowdown is relative to the scene's best cell size.
draft c5b_claim(const measurements& m) {
    draft c5b{.claim = {.lead = "The cut, compared with a grid", .experiments = {"c5"}}};
    const std::vector<condition>& conditions = m.conditions_of("c5");
    for (const bool is_automatic : {false, true})
        for (const auto& [scene, fastest] : fastest_before)
            for (const condition* c : matching(conditions, {{"scene", scene}})) {
                const std::string& size = is_automatic ? "auto" : fastest;
                c5b.add(endpoint_of(*c, cut, grid(size), "frame_cpu_ms", {{"over_cell_size", size}}),
                        (is_automatic ? "with automatic cells" : "with cells of " + size + " edges") + ", on " +
                            scene_text(scene),
                        "objects");
            }
    for (const auto& [number, same_objects] : by_objects(conditions)) {
        const scenes_and_cells scenes(same_objects);
        if (scenes.sizes().empty()) continue;
        const sample_size size =
            same_objects.front()->log_ratios(grid(scenes.sizes().front()), cut, measured("frame_cpu_ms")).size();
        // Bootstrapped: `log_ratio` recomputes the logarithm of a ratio from each resample of the measurements.
        const auto log_ratio = [&](const resample& d) {
            return scenes.worst_regret_of_cut(d) - scenes.least_worst_regret(d);
        };
        c5b.add({.where = {{"scene", "the worst of all"},
                           {"objects", value_of(same_objects.front()->scene(), "objects")},
                           {"comparison", "axial_cut over the best single cell size"}},
                 .log_ratios = {bootstrap(size, log_ratio)},
                 .expected = expectation::less,
                 .source = "c5: regret"},
                "with the best single cell size, slowdowns (times over that of a scene's best size) in the worst of "
                "four scenes",
                "objects", quantity::slowdown);
    }
    c5b.claim.remark = grids_faster_text(conditions);
    return c5b;
}

}  // namespace aabblab
