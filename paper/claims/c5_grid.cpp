module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

const selection cut{{kind::sort, "insertion"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}};

selection grid(const std::string& cell) {
    return {{kind::sort, "insertion"}, {kind::partition, "uniform_grid:cell_size=" + cell}, {kind::sweep, "one_axis"}};
}

/// The cell sizes of the config. Not those of the rows, which lack a size that was wrong everywhere.
const std::vector<std::string> cell_sizes{"4", "8", "16", "32", "64"};

row_value all_bytes() {
    return bytes_of({"projections", "partition", "sweep"});
}

/// Whether the grid has more than one cell.
bool is_grid(const condition& c, const std::string& size) {
    return median_of(c, grid(size), measured("subsets")).value_or(2) > 1;
}

/// Times of grids of all cell sizes over that of the axial cut, in scenes with the same number of objects.
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

/// The side of a world in edges of its cubes, which fill the share `density` of it.
double side_of(const condition& c) {
    return std::cbrt(objects_of(c) / number_of(c.scene(), "density"));
}

/// Adds to claim C5 how a grid's cost grows from the smallest world to the largest, with the same number of boxes: its
/// bytes, and its time over that of the axial cut (times alone fall in a sparse world, with its fewer pairs). Claims
/// favour ratios below 1, so growth is expressed as the cost in the small world over that in the large one.
/// @param worlds from the densest, and so smallest, to the sparsest
void add_growth(const std::vector<condition>& worlds, draft& c5) {
    if (worlds.size() < 2) return;
    const condition& small = worlds.front();
    const condition& large = worlds.back();
    const std::string cubes = number_text(value_of(small.scene(), "objects")) + " cubes";
    const auto add = [&](const std::string& what, const std::string& subject, const cells& above, const cells& below,
                         quantity compared, expectation expected) {
        c5.add({.where = {{"scene", "brownian"}, {"comparison", what}},
                .log_ratios = {difference_of_means(above, below)},
                .expected = expected,
                .compared = compared,
                .subject = subject,
                .source = "c5_world: growth"});
    };
    const row_value bytes = all_bytes();
    for (const auto& [label, size, text] : {std::tuple{"cells of 2", "2", "cells of two box edges"},
                                            {"cells chosen anew", "auto", "the automatic cell size"}}) {
        const selection tested = grid(size);
        const std::string subject = fmt::format("a grid with {} for {}, in a world {:.0f} edges wide instead of {:.0f}",
                                                text, cubes, side_of(small), side_of(large));
        add(std::string("time of a grid over that of axial_cut, ") + label + ", small world over large", subject,
            small.log_ratios(tested, cut, measured("frame_cpu_ms")),
            large.log_ratios(tested, cut, measured("frame_cpu_ms")), quantity::relative_time, expectation::less);
        add(std::string("bytes of a grid, ") + label + ", small world over large", subject, small.logs(tested, bytes),
            large.logs(tested, bytes), quantity::bytes, expectation::less);
    }
    add("bytes of axial_cut, large world over small",
        "the cut for " + cubes + ", in the wider world instead of the other", large.logs(cut, bytes),
        small.logs(cut, bytes), quantity::bytes, expectation::not_more);
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

/// A figure of the time or memory of two grids and of the axial cut against the side of the world.
figure world_figure(const std::string& name, const std::string& quantity_name, const std::string& y_label,
                    const std::vector<condition>& worlds, const row_value& value) {
    const method methods[] = {{"grid, cells of 2", grid("2")}, {"grid, auto", grid("auto")}, {"axial cut", cut}};
    return log_log(name,
                   quantity_name +
                       " of the broad phase against the side of the world, for the same 2,000 cubes: a grid with "
                       "a fixed cell size, one with an automatic cell size, and the axial cut; medians and "
                       "quartiles.",
                   "side of the world (edges)", y_label, series_of(methods, matching(worlds, {}), side_of, value));
}

}  // namespace

/// Drafts C5. A slowdown (regret) in a scene is the time over that of its best cell size. The ratio that decides is the
/// worst slowdown of the axial cut over that of the single cell size for which this is least. Further ratios are those
/// of growth with the world.
draft c5_claim(const measurements& m) {
    const std::string over_best_single = "axial_cut over the best single cell size";
    draft c5{
        .claim = {.claim = "No grid cell size suits all scenes, the axial cut does; a grid's memory and time grow with "
                           "the world",
                  .measured =
                      "the worst slowdown of axial_cut over that of the best single cell size; a slowdown is relative "
                      "to the best cell size of a scene, the worst is that over four scenes with the same number "
                      "of objects, and grids with a single cell are left out",
                  .experiments = {"c5", "c5_world"}},
        .primary = {{{"objects", "1000"}, {"comparison", over_best_single}},
                    {{"objects", "10000"}, {"comparison", over_best_single}}}};
    std::map<double, std::vector<const condition*>> by_objects;
    for (const condition& c : m.conditions_of("c5")) by_objects[objects_of(c)].push_back(&c);
    for (const auto& [number, conditions] : by_objects) {
        const std::string objects = value_of(conditions.front()->scene(), "objects");
        const scenes_and_cells scenes(conditions);
        if (scenes.sizes().empty()) continue;
        const sample_size size =
            conditions.front()->log_ratios(grid(scenes.sizes().front()), cut, measured("frame_cpu_ms")).size();
        // Bootstrapped: `log_ratio` recomputes the logarithm of a ratio from each resample of the measurements.
        const auto add = [&](const std::string& comparison, const std::string& subject, auto log_ratio,
                             quantity compared, expectation expected) {
            c5.add({.where = {{"scene", "the worst of all"}, {"objects", objects}, {"comparison", comparison}},
                    .log_ratios = {bootstrap(size, log_ratio)},
                    .expected = expected,
                    .compared = compared,
                    .subject = subject,
                    .along = "objects",
                    .source = "c5: regret"});
        };
        add(
            over_best_single,
            "slowdown of the cut (its time over that of a scene's fastest cell size) in the worst of four scenes, "
            "compared with that of the best single cell size",
            [&](const resample& d) { return scenes.worst_regret_of_cut(d) - scenes.least_worst_regret(d); },
            quantity::slowdown, expectation::less);
        add(
            "axial_cut over each scene's best cell size",
            "time of the cut in its worst scene, compared with the fastest cell size there",
            [&](const resample& d) { return scenes.worst_regret_of_cut(d); }, quantity::time, expectation::not_more);
        const resample as_measured(size.processes, size.seeds, level::none, /*random=*/0);  // every cell once
        c5.claim.remark = fmt::format(
            "With {} objects the greatest slowdown is {:.2f} with the cut, and {:.2f} with the best single cell size.",
            number_text(objects), std::exp(scenes.worst_regret_of_cut(as_measured)),
            std::exp(scenes.least_worst_regret(as_measured)));
    }
    const std::vector<condition>& worlds = m.conditions_of("c5_world");
    add_growth(worlds, c5);
    c5.claim.tables.push_back(
        {"c5_cells", "Time per frame (ms, medians) with every cell size.", times_table(m.conditions_of("c5"))});
    c5.claim.figures = {cell_figure(by_objects), world_figure("c5_world", "Memory", "bytes", worlds, all_bytes()),
                        world_figure("c5_world_time", "Time", "time per frame (ms)", worlds, measured("frame_cpu_ms"))};
    return c5;
}

}  // namespace aabblab
