module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import :measurements;
import aabblab.figures;
import aabblab.report;
import aabblab.statistics;

namespace aabblab {

namespace {

const selection cut{"insertion", "axial_cut", "one_axis", "", ""};

selection grid(const std::string& cell) {
    return {"insertion", "uniform_grid:cell_size=" + cell, "one_axis", "", ""};
}

const std::vector<std::string>& cell_sizes() {
    static const std::vector<std::string> all{"2", "4", "8", "16", "32", "64"};
    return all;
}

/// Times of every cell size over that of the axial cut, scene by scene.
class scenes_and_cells {
public:
    explicit scenes_and_cells(const std::vector<condition>& conditions) {
        for (const condition& c : conditions) {
            std::vector<cells>& ratios = over_cut_.emplace_back();
            for (const std::string& size : cell_sizes()) ratios.push_back(c.log_ratios(grid(size), cut, frame_ms()));
        }
    }

    /// Over the scene's best cell size.
    [[nodiscard]] double regret(std::size_t scene, double log_ratio, const resample& d) const {
        double best = std::numeric_limits<double>::infinity();
        for (const cells& one : over_cut_[scene]) best = std::min(best, d.mean_of(one));
        return log_ratio - best;
    }
    [[nodiscard]] double worst_regret(std::size_t size, const resample& d) const {
        double worst = -std::numeric_limits<double>::infinity();
        for (std::size_t scene = 0; scene < over_cut_.size(); ++scene)
            worst = std::max(worst, regret(scene, d.mean_of(over_cut_[scene][size]), d));
        return worst;
    }
    [[nodiscard]] double worst_regret_of_cut(const resample& d) const {
        double worst = -std::numeric_limits<double>::infinity();
        for (std::size_t scene = 0; scene < over_cut_.size(); ++scene) worst = std::max(worst, regret(scene, 0, d));
        return worst;
    }
    /// The cell size whose worst scene is the least bad.
    [[nodiscard]] std::size_t safest(const resample& d) const {
        std::size_t best = 0;
        for (std::size_t size = 1; size < cell_sizes().size(); ++size)
            if (worst_regret(size, d) < worst_regret(best, d)) best = size;
        return best;
    }

private:
    std::vector<std::vector<cells>> over_cut_;
};

table regrets(const std::vector<condition>& conditions) {
    table t{{{"scene", false}, {"axial_cut"}}, {}};
    for (const std::string& size : cell_sizes()) t.columns.push_back({"cells of " + size});
    t.columns.push_back({"grid, auto"});
    for (const condition& c : conditions) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{text_of(c.of())});
        const auto add = [&](const selection& who) {
            const auto time = c.spread(who, frame_ms());
            cells.push_back(time ? digits_of(time->median) : "-");
        };
        add(cut);
        for (const std::string& size : cell_sizes()) add(grid(size));
        add({"insertion", "uniform_grid:cell_size=auto", "one_axis", "", ""});
    }
    return t;
}

/// How time and bytes of a grid of one cell size grow with the world, against those of the cut.
void add_growth(const std::vector<condition>& worlds, std::vector<candidate>& candidates) {
    if (worlds.size() < 2) return;
    const condition& small = worlds.front();
    const condition& large = worlds.back();
    const auto add = [&](const std::string& what, const metric& of) {
        const cells near = small.log_ratios(cut, grid("2"), of);
        const cells far = large.log_ratios(cut, grid("2"), of);
        if (near.empty() || far.empty()) return;
        candidates.push_back({{{"scene", "brownian, a world " + value_of(small.of(), "density") + " over " +
                                             value_of(large.of(), "density") + " as dense"},
                               {"growth of", what}},
                              bootstrap(near.processes(), near.seeds(),
                                        [&](const resample& d) { return d.mean_of(far) - d.mean_of(near); })});
    };
    add("time", frame_ms());
    add("bytes", bytes_of({"projections", "partition", "sweep"}));
}

figure cell_figure(const std::vector<condition>& conditions) {
    figure f{"c5",
             "Time of global search against the size of a grid's cells, over that of the axial cut in the same repeat "
             "(the level 1), in four scenes: each has another best size.",
             {"cell size (edges of the smallest box)", true, {}},
             {"time over that of axial cut", true, {}},
             {},
             {}};
    for (const condition& c : conditions) {
        series s{value_of(c.of(), "scene"), series_style::line, {}};
        for (const std::string& size : cell_sizes()) {
            const candidate ratio = candidate_of(c, grid(size), cut, frame_ms());
            if (ratio.log_ratio.draws.empty()) continue;
            const endpoint e = endpoint_of(ratio, expectation::less);
            s.points.push_back({std::stod(size), e.ratio, e.range.low, e.range.high});
        }
        f.lines.push_back(s);
    }
    f.lines.push_back({"axial cut", series_style::level, {{1, 1, 1, 1}}});
    return f;
}

figure world_figure(const std::vector<condition>& worlds) {
    figure f{"c5_world",
             "Memory of global search against the side of the world, for the same 2,000 cubes: a grid of one cell "
             "size, one that chooses it anew, and the axial cut.",
             {"side of the world (edges)", true, {}},
             {"bytes", true, {}},
             {},
             {}};
    const metric bytes = bytes_of({"projections", "partition", "sweep"});
    const std::pair<const char*, selection> all[] = {
        {"grid, cells of 2", grid("2")}, {"grid, auto", grid("auto")}, {"axial cut", cut}};
    for (const auto& [label, who] : all) {
        series s{label, series_style::line, {}};
        for (const condition& c : worlds) {
            const double side = std::cbrt(number_of(c.of(), "objects") / number_of(c.of(), "density"));
            if (const auto point = c.point(side, who, bytes)) s.points.push_back(*point);
        }
        f.lines.push_back(s);
    }
    return f;
}

}  // namespace

claim_result cut_against_grid(const measurements& m) {
    claim_result claim;
    claim.id = "C5";
    claim.claim = "No grid size suits every scene, the axial cut does; a grid's memory and time grow with the space";
    claim.measured =
        "time a frame of axial_cut over uniform_grid with the one cell size that is safest over all scenes";
    claim.experiments = {"c5", "c5_world"};
    const std::vector<condition>& conditions = m.of("c5");
    std::vector<candidate> candidates;
    if (!conditions.empty()) {
        const std::size_t processes = conditions.front().processes();
        const std::size_t seeds = conditions.front().seeds();
        const scenes_and_cells all(conditions);
        const std::size_t safest = all.safest(resample(processes, seeds));
        candidates.push_back(
            {{{"scene", "the worst of all, each over its best cell size"}, {"growth of", ""}},
             bootstrap(processes, seeds,
                       [&](const resample& d) { return all.worst_regret_of_cut(d) - all.worst_regret(safest, d); }),
             true});
        for (const condition& c : conditions)
            candidates.push_back(candidate_of(c, cut, grid(cell_sizes()[safest]), frame_ms()));
    }
    add_growth(m.of("c5_world"), candidates);
    judge(claim, std::move(candidates));
    claim.tables.push_back({"c5_cells", "Time a frame (ms, medians) with every cell size.", regrets(conditions)});
    claim.figures = {cell_figure(conditions), world_figure(m.of("c5_world"))};
    return claim;
}

}  // namespace aabblab
