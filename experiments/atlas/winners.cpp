module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The second fastest candidate; null if there is none.
const atlas_candidate* second_of(const atlas_scene& scene) {
    const atlas_candidate& best = scene.fastest();
    return scene.fastest_if([&](const atlas_candidate& candidate) { return &candidate != &best; });
}

/// True if the 95 % interval of the ratio to the fastest lies above 1.
bool is_slower(const atlas_candidate& candidate, const atlas_candidate& best) {
    return log_ratio(candidate, best).range().low > 0;
}

}  // namespace

/// One row per candidate: the scenes that it wins (`fastest`), those in which the second is significantly slower
/// (`shown`), and the others in which it is not significantly slower than the winner (`as_fast`).
table winners_table(const std::vector<atlas_scene>& atlas) {
    table t = empty_table({"candidate"}, {"scenes", "fastest in", "shown in", "as fast in"});
    t.columns.insert(t.columns.begin(), {row_number});
    struct standing {
        std::string label;
        std::size_t scenes = 0, fastest = 0, shown = 0, as_fast = 0;
    };
    std::vector<standing> standings;
    for (const std::string& label : labels_of(atlas)) {
        standing& entry = standings.emplace_back(label);
        for (const atlas_scene& scene : atlas) {
            const atlas_candidate* candidate = scene.find(label);
            if (!candidate) continue;
            ++entry.scenes;
            const atlas_candidate& best = scene.fastest();
            if (candidate == &best) {
                ++entry.fastest;
                const atlas_candidate* second = second_of(scene);
                entry.shown += !second || is_slower(*second, best);
            } else {
                entry.as_fast += !is_slower(*candidate, best);
            }
        }
    }
    std::ranges::stable_sort(standings, [](const standing& a, const standing& b) {
        return a.fastest > b.fastest || (a.fastest == b.fastest && a.as_fast > b.as_fast);
    });
    for (const standing& entry : standings)
        t.rows.push_back({std::to_string(t.rows.size() + 1), entry.label, grouped(entry.scenes), grouped(entry.fastest),
                          grouped(entry.shown), grouped(entry.as_fast)});
    return t;
}

/// One row per scene: its measures, the fastest candidate, the ratio of the second fastest to it, and that of `auto`. A
/// cell is empty if the scene has no second candidate, no `auto` or no motion.
table cells_table(const std::vector<atlas_scene>& atlas) {
    table t = empty_table({"scene", "parameters"},
                          {"pairs_an_object", "inversions", "at_rest", "clustering", "size_ratio"}, {"fastest"});
    const column second_name{.name = "second", .is_number = false};
    t.columns.insert(t.columns.end(),
                     {{"frame_cpu_ms"}, second_name, {"second_ratio"}, {"second_low"}, {"second_high"}});
    t.columns.push_back({"auto_ratio"});
    for (const atlas_scene& scene : atlas) {
        const atlas_candidate& best = scene.fastest();
        const atlas_candidate* second = second_of(scene);
        const auto automatic = std::ranges::find_if(scene.candidates, &atlas_candidate::is_automatic);
        const scene_measures& m = scene.measures;
        const auto text = [](double value) { return fmt::format("{:.4g}", value); };
        std::vector<std::string> cells{scene.scene.kind, settings_text(scene.scene), text(m.pairs_per_object)};
        cells.push_back(m.motion ? text(m.motion->inversions) : "");
        cells.push_back(m.motion ? text(m.motion->at_rest) : "");
        cells.push_back(text(m.clustering));
        cells.push_back(m.boxes.size_ratio ? text(*m.boxes.size_ratio) : "");
        cells.insert(cells.end(), {best.label, text(best.ms()), second ? second->label : ""});
        if (second) {
            const estimate ratio = log_ratio(*second, best);
            for (const double log : {ratio.value, ratio.range().low, ratio.range().high})
                cells.push_back(text(std::exp(log)));
        } else {
            cells.resize(cells.size() + 3);  // no ratio and no interval
        }
        cells.push_back(automatic != scene.candidates.end() ? text(automatic->ms() / best.ms()) : "");
        t.rows.push_back(std::move(cells));
    }
    return t;
}

/// One row per candidate, by median: the distribution over scenes of its time over that of the fastest.
table regrets_table(const std::vector<atlas_scene>& atlas, atlas_time time) {
    struct standing {
        std::string label;
        std::vector<double> regrets;
        double median = 0;
    };
    std::vector<standing> standings;
    for (const std::string& label : labels_of(atlas)) {
        standing& entry = standings.emplace_back(label, regrets_of(atlas, label, time));
        entry.median = quartiles_of(entry.regrets).median;
    }
    std::ranges::stable_sort(standings, {}, &standing::median);
    constexpr double far_behind = 1.3;
    const std::string over = fmt::format("over {}", far_behind);
    table t = empty_table({"used everywhere"}, {"scenes", "median", "90th percentile", "worst", over.c_str()});
    t.columns.insert(t.columns.begin(), {row_number});
    for (const standing& entry : standings) {
        const auto above = std::ranges::count_if(entry.regrets, [](double r) { return r > far_behind; });
        t.rows.push_back({std::to_string(t.rows.size() + 1), entry.label, grouped(entry.regrets.size()),
                          fmt::format("{:.2f}", entry.median),
                          fmt::format("{:.2f}", entry.regrets[entry.regrets.size() * 9 / 10]),
                          fmt::format("{:.2f}", entry.regrets.back()), grouped(static_cast<std::uint64_t>(above))});
    }
    return t;
}

}  // namespace aabblab
