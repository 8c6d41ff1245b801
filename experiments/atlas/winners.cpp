module aabblab.atlas;

import :labels;
import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// The second fastest line; null if there is none.
const atlas_line* second_of(const atlas_scene& scene) {
    const atlas_line& best = scene.fastest(per_frame);
    return scene.fastest_if(per_frame, [&](const atlas_line& line) { return &line != &best; });
}

/// True if the interval of the ratio to the fastest lies above 1.
bool is_slower(const atlas_line& line, const atlas_line& best) {
    return log_ratio(line, best, per_frame).range().low > 0;
}

}  // namespace

table winners_table(const std::vector<atlas_scene>& atlas) {
    table t{{{row_number}, {"candidate", false}, {"scenes"}, {"fastest in"}, {"shown in"}, {"as fast in"}}, {}};
    struct standing {
        std::string label;
        std::size_t scenes = 0, fastest = 0, shown = 0, as_fast = 0;
    };
    std::vector<standing> standings;
    for (const std::string& label : labels_of(atlas)) {
        standing& entry = standings.emplace_back();
        entry.label = label;
        for (const atlas_scene& scene : atlas) {
            const atlas_line* line = scene.find(label);
            if (!line) continue;
            ++entry.scenes;
            const atlas_line& best = scene.fastest(per_frame);
            if (line != &best) {
                if (!is_slower(*line, best)) ++entry.as_fast;
                continue;
            }
            ++entry.fastest;
            const atlas_line* second = second_of(scene);
            if (!second || is_slower(*second, best)) ++entry.shown;
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

table cells_table(const std::vector<atlas_scene>& atlas) {
    table t = empty_table({"scene", "parameters"},
                          {"pairs_an_object", "inversions", "at_rest", "clustering", "size_ratio"}, {"fastest"});
    t.columns.insert(
        t.columns.end(),
        {{"frame_ms"}, {"second", false}, {"second_ratio"}, {"second_low"}, {"second_high"}, {"auto_ratio"}});
    for (const atlas_scene& scene : atlas) {
        const atlas_line& best = scene.fastest(per_frame);
        const atlas_line* second = second_of(scene);
        const auto automatic = std::ranges::find_if(scene.lines, &atlas_line::automatic);
        const scene_measures& m = scene.measures;
        const auto text = [](double value) { return fmt::format("{:.4g}", value); };
        std::vector<std::string> cells{scene.scene.kind,
                                       settings_text(scene.scene),
                                       text(m.pairs_per_object),
                                       m.motion ? text(m.motion->inversions) : "",
                                       m.motion ? text(m.motion->at_rest) : "",
                                       text(m.clustering),
                                       m.boxes.size_ratio ? text(*m.boxes.size_ratio) : "",
                                       best.label,
                                       text(best.ms(per_frame)),
                                       second ? second->label : ""};
        if (second) {
            const estimate ratio = log_ratio(*second, best, per_frame);
            for (const double log : {ratio.value, ratio.range().low, ratio.range().high})
                cells.push_back(text(std::exp(log)));
        } else {
            cells.resize(cells.size() + 3);
        }
        cells.push_back(automatic != scene.lines.end() ? text(automatic->ms(per_frame) / best.ms(per_frame)) : "");
        t.rows.push_back(std::move(cells));
    }
    return t;
}

table regrets_table(const std::vector<atlas_scene>& atlas, span_of_time span) {
    struct standing {
        std::string label;
        std::vector<double> regrets;
        double median = 0;
    };
    std::vector<standing> standings;
    for (const std::string& label : labels_of(atlas)) {
        standing& entry = standings.emplace_back(label, regrets_of(atlas, label, span));
        entry.median = quartiles_of(entry.regrets).median;
    }
    std::ranges::stable_sort(standings, {}, &standing::median);
    table t = empty_table({"used everywhere"}, {"scenes", "median", "90th percentile", "worst", "over 1.3"});
    t.columns.insert(t.columns.begin(), {row_number});
    for (const standing& entry : standings) {
        const auto above = std::ranges::count_if(entry.regrets, [](double r) { return r > 1.3; });
        t.rows.push_back({std::to_string(t.rows.size() + 1), entry.label, grouped(entry.regrets.size()),
                          fmt::format("{:.2f}", entry.median),
                          fmt::format("{:.2f}", entry.regrets[entry.regrets.size() * 9 / 10]),
                          fmt::format("{:.2f}", entry.regrets.back()), grouped(static_cast<std::uint64_t>(above))});
    }
    return t;
}

}  // namespace aabblab
